// Areas, swept volumes, cell volumes, centroids and the weights of the gradients: what the mesh is where its nodes
// are. All of it follows from node positions and velocities; nothing is remembered between steps.
//
// A face of four nodes is four triangles about the mean of its nodes, for its area, for what it sweeps and for the
// volumes of its cells alike: so what the faces of a cell sweep is exactly what its volume changes by.
#pragma once

#include "mesh.hpp"

#include <type_traits>
#include <vector>

namespace mullion::euler {

/// Positions or velocities of nodes. D follows from the mesh beside it, whatever kind of array is handed over.
template <int D> using Nodes = std::type_identity_t<Eigen::Ref<const Eigen::Matrix<double, D, Eigen::Dynamic>>>;

/// A face as the fluxes need it, the normal out of its owner.
template <int D> struct FacePlane {
  std::array<double, D> normal{}; ///< unit
  double area = 0.0;              ///< [m^2; m in the plane]
  double speed = 0.0;             ///< of the face along its normal: what it sweeps, per area and time [m/s]
};

/// Area vector of a face and the volume that it sweeps in a motion of its nodes.
template <int D> struct Sweep {
  Vec<D> area = Vec<D>::Zero();
  double volume = 0.0;
};

/// The area vector of a resting face.
template <int D> Vec<D> area_of(const FaceNodes<D>& face, const Nodes<D>& x);

/// Mean area vector and swept volume while the nodes go straight from x by v dt; exact:
///
///     in the plane: N at dt / 2, dV = dt (v_a + v_b) / 2 . N
///     a triangle in space: N = (N(0) + 4 N(dt/2) + N(dt)) / 6, dV = dt (v_1 + v_2 + v_3) / 3 . N   (Simpson, N
///     quadratic)
template <int D> Sweep<D> sweep_of(const FaceNodes<D>& face, const Nodes<D>& x, const Nodes<D>& v, double dt);

/// The face's middle, weighed by area.
template <int D> Vec<D> middle_of(const FaceNodes<D>& face, const Nodes<D>& x);

struct BadCellShape {
  Index cell = -1; ///< of the mesh's own order
  double volume = 0.0;
};

template <int D> struct CellShape {
  double volume = 0.0;
  Vec<D> centroid = Vec<D>::Zero();
};

/// Volume and centroid of one cell.
template <int D> CellShape<D> cell_shape(const Mesh<D>& mesh, const Nodes<D>& x, std::size_t cell);

/// Where the values of owner and neighbour go: from either centroid to the middle of the face, the owner's first.
template <int D> using FaceOffsets = std::array<std::array<double, D>, 2>;

/// The gradient's weights: grad W_i = sum_j c_j (W_j - W_i), least squares with weights 1/d^2.
///
/// @param d  from cell i to each of its stencil
/// @param c  as many: the weights [1/m]. Directions in which the stencil has no extent get none (pseudo-inverse).
template <int D> void gradient_weights(const Vec<D>* d, std::size_t n, std::array<double, D>* c);

/// From cell `cell` to each of its stencil; `centroid(i)` gives any cell's.
template <int D, class Centroid>
void stencil_distances(const Mesh<D>& mesh, std::size_t cell, Centroid&& centroid, std::vector<Vec<D>>& d)
{
  d.clear();
  const Vec<D> own = centroid(cell);
  for (auto k = mesh.stencil_begin[cell]; k < mesh.stencil_begin[cell + 1]; ++k) {
    const auto e = static_cast<std::size_t>(k);
    Vec<D> away = centroid(static_cast<std::size_t>(mesh.stencil[e])) - own;
    if (mesh.is_periodic()) away += mesh.shifts[mesh.stencil_shift[e]];
    d.push_back(away);
  }
}

/// The geometry that a step works with.
template <int D> struct Geometry {
  std::vector<double> volume;                 ///< of each cell
  std::vector<Vec<D>> centroid;               ///< of each cell
  std::vector<FaceOffsets<D>> offsets;        ///< of each face; second order only
  std::vector<std::array<double, D>> weights; ///< of each entry of the stencil; second order only
  std::vector<FacePlane<D>> planes;           ///< of each face

  void resize(const Mesh<D>& mesh, bool is_second_order);
};

/// Volumes and centroids of the cells [begin, end).
/// @return the first cell whose volume is not positive, or cell = -1
template <int D>
BadCellShape update_cells(const Mesh<D>& mesh, const Nodes<D>& x, std::size_t begin, std::size_t end,
                          Geometry<D>& geometry);

/// Offsets and weights of the cells [begin, end) and the faces that they own; centroids stand already.
template <int D>
void update_reconstruction(const Mesh<D>& mesh, const Nodes<D>& x, std::size_t begin, std::size_t end,
                           Geometry<D>& geometry);

/// Planes of the faces that the cells [begin, end) own, the nodes at rest.
template <int D>
void update_planes(const Mesh<D>& mesh, const Nodes<D>& x, std::size_t begin, std::size_t end, Geometry<D>& geometry);

/// A plane from the sum of sweeps: area vector, and volume swept per time.
template <int D> FacePlane<D> plane_of(const Vec<D>& area, double volume_rate);

} // namespace mullion::euler
