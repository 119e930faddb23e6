// How large a pane of a window is and how good its elements are, for a reader: counts, extent, the smallest and the
// largest element, the worst shape.
#pragma once

#include "io/snapshot.hpp"

#include <Eigen/Core>

#include <string>
#include <utility>
#include <vector>

namespace mullion::io {

/// A value of one element, and where that element is.
struct ElementFigure {
  double value = 0.0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero(); ///< mean of its nodes [m]
};

struct MeshFigures {
  std::uint32_t dimension = 0;
  std::int64_t n_nodes = 0;
  std::vector<std::pair<std::string, std::int64_t>> elements;                    ///< "quadrilaterals", how many
  int element_dimension = 0;                                                     ///< the largest
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero(); ///< corners of the box around all [m]
  /// Length, area or volume of the elements of the largest dimension [m, m^2, m^3]; negative where one is turned over,
  /// which a surface in space cannot be. Volumes have their quadrilateral faces split about the middle.
  ElementFigure smallest, largest;
  /// Shape [1]: triangles 4 sqrt(3) A / sum l^2, tetrahedra 72 sqrt(3) V / (sum l^2)^1.5 with the lengths l of the
  /// edges, all others the smallest sine or determinant of the unit vectors along the edges at a corner. 1 for regular
  /// simplices, squares and cubes; 0 for a flat element, below 0 for one that is folded.
  ElementFigure worst;
};

/// @param coordinates  (dimension x n_nodes) where the nodes are [m]
/// @pre                the pane's blocks name nodes that there are, as those of a window do
MeshFigures figures_of(const PaneData& pane, const double* coordinates);

/// Lines, the first without the name of the window that it is about.
std::string describe(const MeshFigures& figures);

} // namespace mullion::io
