#include "mass_matrix.hpp"

#include <algorithm>
#include <utility>

namespace mullion::surface {

namespace {

/// The matrix with ones for the pinned rows.
Operator with_ones(const Operator& matrix, const std::vector<bool>& is_pinned)
{
  OperatorSum sum(matrix.rows(), matrix.cols());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const auto row = static_cast<std::int32_t>(i);
    if (is_pinned[static_cast<std::size_t>(i)]) sum.add(row, row, 1.0);
    else
      for (Operator::InnerIterator it(matrix, i); it; ++it)
        if (!is_pinned[static_cast<std::size_t>(it.col())])
          sum.add(row, static_cast<std::int32_t>(it.col()), it.value());
  }
  return sum.finish();
}

} // namespace

MassMatrix mass_matrix(Operator matrix)
{
  MassMatrix mass;
  const Eigen::Index n = matrix.rows();
  mass.row_sums = Eigen::VectorXd::Zero(n);
  std::vector<double> diagonal(static_cast<std::size_t>(n), 0.0);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Operator::InnerIterator it(matrix, i); it; ++it) {
      mass.row_sums[i] += it.value();
      if (it.col() != i) continue;
      diagonal[static_cast<std::size_t>(i)] = it.value();
      largest = std::max(largest, it.value());
    }
  std::vector<bool> is_pinned(static_cast<std::size_t>(n), false);
  for (Eigen::Index i = 0; i < n; ++i)
    if (!(diagonal[static_cast<std::size_t>(i)] > 1e-14 * largest)) {
      is_pinned[static_cast<std::size_t>(i)] = true;
      mass.pinned.push_back(static_cast<std::int32_t>(i));
    }

  if (n > largest_factorised) {
    mass.scaled = scaled_mass(matrix, is_pinned);
    Eigen::MatrixXd trial(1, n), solution; // of all wave lengths
    for (Eigen::Index i = 0; i < n; ++i) trial(0, i) = diagonal[static_cast<std::size_t>(i)] * ((i * i) % 7 - 3.0);
    mass.is_solvable = conjugate_gradients(mass.scaled, trial, solution);
  }
  if (!mass.is_solvable) {
    mass.scaled = {};
    mass.factors = std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(with_ones(matrix, is_pinned));
    mass.is_solvable = mass.factors->info() == Eigen::Success && (mass.factors->vectorD().array() > 0.0).all();
  }
  mass.matrix = std::move(matrix);
  return mass;
}

Field solve(const MassMatrix& mass, const FieldView& loads)
{
  Field out(loads.rows(), loads.cols());
  if (mass.factors == nullptr) {
    (void)conjugate_gradients(mass.scaled, loads, out); // tried before: what is not finite stays so
    return out;
  }
  for (Eigen::Index c = 0; c < loads.rows(); ++c) {
    Eigen::VectorXd rhs = loads.row(c).transpose();
    for (const auto node : mass.pinned) rhs[node] = 0.0;
    out.row(c) = mass.factors->solve(rhs).transpose();
  }
  return out;
}

Field recover(const MassMatrix& target_mass, const FieldView& loads, Recovery recovery)
{
  if (recovery == Recovery::consistent) return solve(target_mass, loads);
  Field out = Field::Zero(loads.rows(), loads.cols());
  std::size_t next = 0;
  for (Eigen::Index j = 0; j < loads.cols(); ++j) {
    if (next < target_mass.pinned.size() && target_mass.pinned[next] == j) ++next;
    else out.col(j) = loads.col(j) / target_mass.row_sums[j];
  }
  return out;
}

Field adjoint_motion(const Operator& load_operator, const MassMatrix& source_mass, const FieldView& target_motion)
{
  return solve(source_mass, apply_transposed(load_operator, target_motion));
}

Field traction_of_face_forces(const SurfaceMesh& mesh, const FieldView& face_forces)
{
  Field traction = Field::Zero(face_forces.rows(), face_forces.cols());
  for (Eigen::Index f = 0; f < face_forces.cols(); ++f)
    if (const double measure = face_measure(mesh, f); measure > 0.0) traction.col(f) = face_forces.col(f) / measure;
  return traction;
}

} // namespace mullion::surface
