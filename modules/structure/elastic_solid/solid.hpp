// A solid as finite elements: its matrices, stresses and energies, and what is wrong with its mesh. Small strains: all
// is in the reference configuration. No boundary conditions, no time.
//
// Degrees of freedom are numbered node by node: u_x, u_y (u_z) of node 0, of node 1, …, which is the memory layout of
// a (components x nodes) array.
#pragma once

#include "elements.hpp"
#include "material.hpp"

#include "files/mesh_file.hpp"

#include <Eigen/SparseCore>

#include <functional>
#include <string>
#include <vector>

namespace mullion::elastic_solid {

using mesh_files::Index;
using SparseMatrix = Eigen::SparseMatrix<double>;

struct Solid {
  Eigen::MatrixXd nodes;                 ///< (dimension x n_nodes) [m], 2D or 3D
  std::vector<mesh_files::Block> blocks; ///< elements; they count through the blocks in their order
  Material material;
  Formulation formulation = Formulation::standard;
  double thickness = 1.0; ///< [m], 2D only; 1 in 3D

  [[nodiscard]] int dimension() const { return static_cast<int>(nodes.rows()); }
  [[nodiscard]] Eigen::Index n_nodes() const { return nodes.cols(); }
  [[nodiscard]] Eigen::Index n_dofs() const { return nodes.size(); }
};

[[nodiscard]] Eigen::Index n_elements(const Solid& solid);

/// Call f(element, shape, its node numbers) for each element in order.
void for_each_element(const Solid& solid,
                      const std::function<void(Eigen::Index, Shape, const Eigen::VectorX<Index>&)>& f);

/// What is wrong with the mesh, in words that name the place; "" if nothing is. Shapes, inverted or degenerate
/// elements, nodes without an element.
[[nodiscard]] std::string complaint_about(const Solid& solid);

/// K, both triangles [N/m]. Elements are added in their order.
[[nodiscard]] SparseMatrix stiffness_matrix(const Solid& solid);

enum class MassKind {
  consistent, ///< int rho N_a N_b
  lumped      ///< its row sums on the diagonal
};

/// M [kg], of all degrees of freedom.
[[nodiscard]] SparseMatrix mass_matrix(const Solid& solid, MassKind kind);

/// Stresses xx, yy, zz, xy, yz, zx at the centres of the elements from displacements, (6 n_elements x n_dofs) [Pa/m]:
/// those of an element one after the other.
[[nodiscard]] SparseMatrix stress_matrix(const Solid& solid);

/// Which rigid motion the given degrees of freedom leave free, in words that name the part of the body; "" if none.
/// @param held  n_dofs, true where the displacement is given
[[nodiscard]] std::string missing_support(const Solid& solid, const std::vector<bool>& held);

/// "(0.1, 0.2) m", for messages.
[[nodiscard]] std::string place(const Eigen::VectorXd& x);

/// x^T A x / 2: the energy of a matrix [J].
[[nodiscard]] double energy(const SparseMatrix& matrix, const Eigen::VectorXd& x);

} // namespace mullion::elastic_solid
