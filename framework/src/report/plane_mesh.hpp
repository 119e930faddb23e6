// The meshes of a run that lie in a plane and have an area: the windows of dimension 2 with triangles and
// quadrilaterals, as results/mesh.h5 has them. Lines and points in a pane have no area and are passed over.
#pragma once

#include "io/hdf5_image.hpp"
#include "report/picture.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace mullion::report {

/// An element with an area.
struct PlaneElement {
  std::array<std::size_t, 4> nodes{};
  std::size_t n_nodes = 0;
  std::size_t number = 0; ///< among all elements of the pane: where its value stands in an element field
};

struct PlanePane {
  std::string group; ///< in every results file: "/fluid/volume/pane_0"
  std::vector<Point> reference;
  std::vector<PlaneElement> elements;
};

struct PlaneWindow {
  std::string name; ///< "fluid.volume"
  std::vector<PlanePane> panes;
};

/// @param mesh   results/mesh.h5
/// @param source what to call it in messages
/// @throws Error Errc::io: a dataset is missing or of another shape, or an element refers to a node that is not there
[[nodiscard]] std::vector<PlaneWindow> read_plane_windows(const io::ImageReader& mesh, const std::string& source);

/// The longer side of the box around the reference mesh [m].
[[nodiscard]] double extent(const PlaneWindow& window);

/// The edges that belong to one element alone, as pairs of nodes.
[[nodiscard]] std::vector<std::array<std::size_t, 2>> boundary_edges(const PlanePane& pane);

} // namespace mullion::report
