#include "solid.hpp"

#include "files/file_error.hpp"

#include <Eigen/QR>

#include <cmath>
#include <limits>
#include <numeric>

namespace mullion::elastic_solid {
namespace {

using mesh_files::join;

Eigen::MatrixXd columns(const Eigen::MatrixXd& all, const Eigen::VectorX<Index>& which)
{
  Eigen::MatrixXd out(all.rows(), which.size());
  for (Eigen::Index a = 0; a < which.size(); ++a) out.col(a) = all.col(which[a]);
  return out;
}

SparseMatrix from_triplets(Eigen::Index n_rows, Eigen::Index n_columns,
                           const std::vector<Eigen::Triplet<double>>& triplets)
{
  SparseMatrix matrix(n_rows, n_columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end()); // equal places are summed in the order of the list
  matrix.makeCompressed();
  return matrix;
}

/// Connected parts of the mesh: for each node the smallest node of its part.
std::vector<Index> parts_of(const Solid& solid)
{
  std::vector<Index> part(static_cast<std::size_t>(solid.n_nodes()));
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&](Index i) {
    while (part[static_cast<std::size_t>(i)] != i) i = part[static_cast<std::size_t>(i)];
    return i;
  };
  for_each_element(solid, [&](Eigen::Index, Shape, const Eigen::VectorX<Index>& nodes) {
    for (const Index node : nodes) {
      const Index a = root(nodes[0]), b = root(node);
      part[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      part[static_cast<std::size_t>(node)] = std::min(a, b); // keeps the chains short
    }
  });
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = root(static_cast<Index>(i));
  return part;
}

} // namespace

Eigen::Index n_elements(const Solid& solid)
{
  Eigen::Index n = 0;
  for (const auto& block : solid.blocks) n += block.connectivity.cols();
  return n;
}

void for_each_element(const Solid& solid,
                      const std::function<void(Eigen::Index, Shape, const Eigen::VectorX<Index>&)>& f)
{
  Eigen::Index element = 0;
  for (const auto& block : solid.blocks)
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) f(element++, block.shape, block.connectivity.col(e));
}

std::string place(const Eigen::VectorXd& x)
{
  return x.size() == 2 ? join('(', x[0], ", ", x[1], ") m") : join('(', x[0], ", ", x[1], ", ", x[2], ") m");
}

std::string complaint_about(const Solid& solid)
{
  const int d = solid.dimension();
  if (d != 2 && d != 3) return join("the mesh lies in ", d, " dimension(s); a solid has 2 or 3");
  if (n_elements(solid) == 0) return "the mesh has no elements of its own dimension";
  std::string complaint;
  std::vector<bool> is_used(static_cast<std::size_t>(solid.n_nodes()), false);
  for_each_element(solid, [&](Eigen::Index e, Shape shape, const Eigen::VectorX<Index>& nodes) {
    if (!complaint.empty()) return;
    const auto x = columns(solid.nodes, nodes);
    const auto where = join("element ", e, ", a ", mesh_files::facts(shape).name, " at ", place(x.rowwise().mean()));
    for (const Index node : nodes) is_used[static_cast<std::size_t>(node)] = true;
    if (!is_solid_shape(shape, d)) {
      complaint =
          join(where, ": a solid consists of ", d == 2 ? "triangles and quadrilaterals" : "tetrahedra and hexahedra");
      return;
    }
    const double size = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
    const double jacobian = smallest_jacobian(shape, x);
    if (!(jacobian > 1e-12 * std::pow(size, d))) // round-off of a flat element is above 0 as often as not
      complaint = join(where, ": the smallest Jacobian is ", jacobian, " m^", d, "; it must be positive: the nodes go ",
                       d == 2 ? "counterclockwise around it" : "as the right-hand rule wants it",
                       ", and no corner is flat or turned inward");
  });
  if (!complaint.empty()) return complaint;
  for (Eigen::Index i = 0; i < solid.n_nodes(); ++i)
    if (!is_used[static_cast<std::size_t>(i)])
      return join("node ", i, " at ", place(solid.nodes.col(i)),
                  " belongs to no element of the solid; write the mesh without it");
  return "";
}

SparseMatrix stiffness_matrix(const Solid& solid)
{
  const Eigen::Index d = solid.dimension();
  const auto c = elasticity(solid.material, solid.dimension());
  std::vector<Eigen::Triplet<double>> triplets;
  for_each_element(solid, [&](Eigen::Index, Shape shape, const Eigen::VectorX<Index>& nodes) {
    const Eigen::MatrixXd k =
        solid.thickness * element_stiffness(shape, solid.formulation, columns(solid.nodes, nodes), c);
    const auto dof = [&](Eigen::Index local) { return nodes[local / d] * d + local % d; };
    for (Eigen::Index j = 0; j < k.cols(); ++j)
      for (Eigen::Index i = 0; i < k.rows(); ++i) triplets.emplace_back(dof(i), dof(j), k(i, j));
  });
  return from_triplets(solid.n_dofs(), solid.n_dofs(), triplets);
}

SparseMatrix mass_matrix(const Solid& solid, MassKind kind)
{
  const Eigen::Index d = solid.dimension();
  std::vector<Eigen::Triplet<double>> triplets;
  for_each_element(solid, [&](Eigen::Index, Shape shape, const Eigen::VectorX<Index>& nodes) {
    const Eigen::MatrixXd m =
        solid.thickness * element_mass(shape, columns(solid.nodes, nodes), solid.material.density);
    for (Eigen::Index b = 0; b < m.cols(); ++b)
      for (Eigen::Index a = 0; a < m.rows(); ++a)
        for (Eigen::Index i = 0; i < d; ++i)
          triplets.emplace_back(nodes[a] * d + i, nodes[kind == MassKind::lumped ? a : b] * d + i, m(a, b));
  });
  return from_triplets(solid.n_dofs(), solid.n_dofs(), triplets);
}

SparseMatrix stress_matrix(const Solid& solid)
{
  const Eigen::Index d = solid.dimension();
  const auto c = elasticity(solid.material, solid.dimension());
  const auto all = full_stress_matrix(solid.material, solid.dimension());
  std::vector<Eigen::Triplet<double>> triplets;
  for_each_element(solid, [&](Eigen::Index e, Shape shape, const Eigen::VectorX<Index>& nodes) {
    const Eigen::MatrixXd stress = all * centre_stress_matrix(shape, columns(solid.nodes, nodes), c);
    for (Eigen::Index j = 0; j < stress.cols(); ++j)
      for (Eigen::Index i = 0; i < 6; ++i)
        if (stress(i, j) != 0.0) triplets.emplace_back(6 * e + i, nodes[j / d] * d + j % d, stress(i, j));
  });
  return from_triplets(6 * n_elements(solid), solid.n_dofs(), triplets);
}

std::string missing_support(const Solid& solid, const std::vector<bool>& held)
{
  const Eigen::Index d = solid.dimension(), n_motions = d == 2 ? 3 : 6;
  const auto part = parts_of(solid);
  for (Eigen::Index first = 0; first < solid.n_nodes(); ++first) {
    if (part[static_cast<std::size_t>(first)] != first) continue;
    std::vector<Eigen::Index> nodes;
    for (Eigen::Index i = first; i < solid.n_nodes(); ++i)
      if (part[static_cast<std::size_t>(i)] == first) nodes.push_back(i);
    Eigen::VectorXd centre = Eigen::VectorXd::Zero(d);
    for (const auto i : nodes) centre += solid.nodes.col(i) / static_cast<double>(nodes.size());
    double size = 0.0;
    for (const auto i : nodes) size = std::max(size, (solid.nodes.col(i) - centre).norm());

    // Rigid motions at what is held: translations, and rotations about the centre as long as a translation.
    std::vector<Eigen::RowVectorXd> rows;
    for (const auto i : nodes)
      for (Eigen::Index k = 0; k < d; ++k) {
        if (!held[static_cast<std::size_t>(i * d + k)]) continue;
        const Eigen::VectorXd r = (solid.nodes.col(i) - centre) / size;
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n_motions);
        row[k] = 1.0;
        if (d == 2) row[2] = k == 0 ? -r[1] : r[0];
        else { // omega x r
          row[3 + (k + 1) % 3] = r[(k + 2) % 3];
          row[3 + (k + 2) % 3] = -r[(k + 1) % 3];
        }
        rows.push_back(row);
      }
    Eigen::MatrixXd motions(static_cast<Eigen::Index>(rows.size()), n_motions);
    for (std::size_t i = 0; i < rows.size(); ++i) motions.row(static_cast<Eigen::Index>(i)) = rows[i];
    Eigen::Index rank = 0;
    if (!rows.empty()) {
      Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(motions);
      qr.setThreshold(1e-9); // far above round-off, far below any support that holds
      rank = qr.rank();
    }
    if (rank < n_motions)
      return join("nothing holds the part of the body around ", place(centre), " (", nodes.size(),
                  " nodes): ", n_motions - rank, " of its ", n_motions, " rigid motions are free");
  }
  return "";
}

double energy(const SparseMatrix& matrix, const Eigen::VectorXd& x)
{
  const Eigen::VectorXd image = matrix * x;
  return 0.5 * x.dot(image);
}

} // namespace mullion::elastic_solid
