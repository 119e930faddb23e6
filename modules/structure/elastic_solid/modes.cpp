#include "modes.hpp"

#include "files/file_error.hpp"

#include <Eigen/Eigenvalues>
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/MatOp/SymShiftInvert.h>
#include <Spectra/SymGEigsShiftSolver.h>

#include <algorithm>
#include <cmath>

namespace mullion::elastic_solid {
namespace {

SparseMatrix free_part(const SparseMatrix& matrix, const std::vector<Index>& free)
{
  SparseMatrix choose(matrix.rows(), static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) choose.insert(free[i], static_cast<Eigen::Index>(i)) = 1.0;
  return choose.transpose() * matrix * choose;
}

struct Pairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
  std::string complaint;
};

Pairs all_pairs(const SparseMatrix& stiffness, const SparseMatrix& mass, Eigen::Index n)
{
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(stiffness),
                                                                         Eigen::MatrixXd(mass)};
  if (solver.info() != Eigen::Success) return {{}, {}, "the eigenvalues did not converge"};
  return {solver.eigenvalues().head(n), solver.eigenvectors().leftCols(n), ""};
}

Pairs lowest_pairs(const SparseMatrix& stiffness, const SparseMatrix& mass, Eigen::Index n)
{
  using Operation = Spectra::SymShiftInvert<double, Eigen::Sparse, Eigen::Sparse>;
  using Product = Spectra::SparseSymMatProd<double>;
  // A little below 0, so that a body that nothing holds can be solved as well: by that much its rigid motions, of
  // frequency 0, stand out from the factorisation's round-off, while it is far below all that bends.
  const double shift = -1e-9 * stiffness.diagonal().sum() / mass.diagonal().sum();
  Operation operation(stiffness, mass);
  Product product(mass);
  const auto basis = std::min<Eigen::Index>(stiffness.rows(), std::max<Eigen::Index>(2 * n + 10, 20));
  Spectra::SymGEigsShiftSolver<Operation, Product, Spectra::GEigsMode::ShiftInvert> solver(operation, product, n, basis,
                                                                                           shift);
  solver.init(); // from fixed pseudo-random numbers
  const auto n_found = solver.compute(Spectra::SortRule::LargestMagn, 2000, 1e-13, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful || n_found < n)
    return {{}, {}, mesh_files::join("only ", n_found, " of ", n, " eigenvalues converged")};
  return {solver.eigenvalues(), solver.eigenvectors(), ""};
}

} // namespace

Modes lowest_modes(const System& system, Eigen::Index n_modes)
{
  const auto n_free = static_cast<Eigen::Index>(system.free.size());
  if (n_modes > n_free)
    return {{}, {}, mesh_files::join(n_modes, " modes of ", n_free, " free degrees of freedom; ask for fewer")};
  const auto stiffness = free_part(system.stiffness, system.free), mass = free_part(system.mass, system.free);
  constexpr Eigen::Index small = 60; // here a dense solver takes less than a millisecond, and it needs no luck
  const auto pairs = n_free <= std::max(small, 2 * n_modes + 10) ? all_pairs(stiffness, mass, n_modes)
                                                                 : lowest_pairs(stiffness, mass, n_modes);
  if (!pairs.complaint.empty()) return {{}, {}, pairs.complaint};

  Modes modes{pairs.values.cwiseMax(0.0).cwiseSqrt(), Eigen::MatrixXd::Zero(system.mass.rows(), n_modes), ""};
  for (Eigen::Index k = 0; k < n_modes; ++k) {
    const Eigen::VectorXd shape = pairs.vectors.col(k);
    const Eigen::VectorXd inertia = mass * shape;
    const double largest = shape.cwiseAbs().maxCoeff();
    Eigen::Index first = 0;
    while (std::abs(shape[first]) < (1.0 - 1e-4) * largest) ++first;
    const double scale = (shape[first] < 0.0 ? -1.0 : 1.0) / std::sqrt(shape.dot(inertia));
    for (std::size_t i = 0; i < system.free.size(); ++i)
      modes.shapes(system.free[i], k) = scale * shape[static_cast<Eigen::Index>(i)];
  }
  return modes;
}

Eigen::VectorXd modal_coordinates(const Modes& modes, const SparseMatrix& mass, const Eigen::VectorXd& displacement)
{
  const Eigen::VectorXd inertia = mass * displacement;
  Eigen::VectorXd q(modes.shapes.cols());
  for (Eigen::Index k = 0; k < q.size(); ++k) q[k] = modes.shapes.col(k).dot(inertia);
  return q;
}

} // namespace mullion::elastic_solid
