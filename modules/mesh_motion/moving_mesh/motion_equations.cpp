#include "motion_equations.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace mullion::moving_mesh {
namespace {

/// Gradients of the shape functions of a simplex, one a column [1/m].
Eigen::MatrixXd gradients(const Eigen::MatrixXd& nodes, std::span<const Index> element,
                          const std::array<std::uint8_t, 4>& corners)
{
  const auto d = nodes.rows();
  Eigen::MatrixXd edges(d, d);
  for (Eigen::Index k = 0; k < d; ++k)
    edges.col(k) = nodes.col(element[corners[static_cast<std::size_t>(k) + 1]]) - nodes.col(element[corners[0]]);
  Eigen::MatrixXd g(d, d + 1);
  g.rightCols(d) = edges.inverse().transpose();
  g.col(0) = -g.rightCols(d).rowwise().sum();
  return g;
}

/// Go through all parts of all elements. `add` gets the element's number, the nodes of the part, the gradients there,
/// and the part's measure times its weight.
template <class Add> void for_each_part(const MovingMesh& mesh, const Add& add)
{
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    const auto element = mesh.element(e);
    const auto [simplices, weight] = parts_of_element(mesh.dimension, element.size());
    for (const auto& corners : simplices) {
      std::array<Index, 4> nodes{};
      for (std::size_t k = 0; k <= static_cast<std::size_t>(mesh.dimension); ++k) nodes[k] = element[corners[k]];
      add(static_cast<std::size_t>(e), nodes, gradients(mesh.nodes, element, corners),
          weight * simplex_measure(mesh.nodes, element, corners));
    }
  }
}

} // namespace

std::vector<double> masud_hughes_stiffness(const std::vector<double>& measures)
{
  constexpr double largest_tau = 1e4;
  const auto [smallest, largest] = std::minmax_element(measures.begin(), measures.end());
  std::vector<double> stiffness;
  for (const double v : measures)
    stiffness.push_back(1.0 + std::min((1.0 - *smallest / *largest) / (v / *largest), largest_tau));
  return stiffness;
}

std::vector<double> inverse_measure_stiffness(const std::vector<double>& measures, double chi)
{
  const double largest = *std::max_element(measures.begin(), measures.end());
  std::vector<double> stiffness;
  for (const double v : measures) stiffness.push_back(std::pow(largest / v, chi));
  return stiffness;
}

Sparse laplacian_matrix(const MovingMesh& mesh, const std::vector<double>& stiffness)
{
  std::vector<Eigen::Triplet<double>> entries;
  for_each_part(mesh, [&](std::size_t e, const std::array<Index, 4>& nodes, const Eigen::MatrixXd& g, double measure) {
    for (int i = 0; i <= mesh.dimension; ++i)
      for (int j = 0; j <= mesh.dimension; ++j)
        entries.emplace_back(nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)],
                             stiffness[e] * measure * g.col(i).dot(g.col(j)));
  });
  Sparse matrix(mesh.nodes.cols(), mesh.nodes.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Sparse elasticity_matrix(const MovingMesh& mesh, const std::vector<double>& stiffness, double poisson_ratio)
{
  const double nu = poisson_ratio;
  const int d = mesh.dimension;
  const double lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), mu = 0.5 / (1.0 + nu); // for E = 1
  std::vector<Eigen::Triplet<double>> entries;
  for_each_part(mesh, [&](std::size_t e, const std::array<Index, 4>& nodes, const Eigen::MatrixXd& g, double measure) {
    const double scale = stiffness[e] * measure;
    for (int i = 0; i <= d; ++i)
      for (int j = 0; j <= d; ++j) {
        const double same = mu * g.col(i).dot(g.col(j));
        for (int a = 0; a < d; ++a)
          for (int b = 0; b < d; ++b)
            entries.emplace_back(nodes[static_cast<std::size_t>(i)] * d + a, nodes[static_cast<std::size_t>(j)] * d + b,
                                 scale * (lambda * g(a, i) * g(b, j) + mu * g(b, i) * g(a, j) + (a == b ? same : 0.0)));
      }
  });
  Sparse matrix(mesh.dimension * mesh.nodes.cols(), mesh.dimension * mesh.nodes.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

GivenSystem::GivenSystem(const Sparse& matrix, const Eigen::Array<bool, Eigen::Dynamic, 1>& is_given)
{
  std::vector<Eigen::Index> place(static_cast<std::size_t>(is_given.size()));
  for (Eigen::Index i = 0; i < is_given.size(); ++i) {
    auto& kind = is_given[i] ? given_ : free_;
    place[static_cast<std::size_t>(i)] = static_cast<Eigen::Index>(kind.size());
    kind.push_back(i);
  }
  std::vector<Eigen::Triplet<double>> among_free, on_given;
  for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
    for (Sparse::InnerIterator entry(matrix, column); entry; ++entry)
      if (!is_given[entry.row()])
        (is_given[column] ? on_given : among_free)
            .emplace_back(place[static_cast<std::size_t>(entry.row())], place[static_cast<std::size_t>(column)],
                          entry.value());
  const auto n_free = static_cast<Eigen::Index>(free_.size());
  on_given_.resize(n_free, static_cast<Eigen::Index>(given_.size()));
  on_given_.setFromTriplets(on_given.begin(), on_given.end());
  if (n_free == 0) return;
  Sparse inner(n_free, n_free);
  inner.setFromTriplets(among_free.begin(), among_free.end());
  factor_.compute(inner);
  // A pivot that is round-off of the largest one: something floats.
  is_regular_ = factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > 1e-13 * factor_.vectorD().maxCoeff();
}

void GivenSystem::complete(Eigen::Ref<Eigen::VectorXd> values) const
{
  if (free_.empty()) return;
  Eigen::VectorXd given(static_cast<Eigen::Index>(given_.size()));
  for (std::size_t k = 0; k < given_.size(); ++k) given[static_cast<Eigen::Index>(k)] = values[given_[k]];
  const Eigen::VectorXd load = on_given_ * given;
  const Eigen::VectorXd solution = factor_.solve(load);
  for (std::size_t k = 0; k < free_.size(); ++k) values[free_[k]] = -solution[static_cast<Eigen::Index>(k)];
}

bool MotionSolver::is_regular() const
{
  return std::all_of(systems.begin(), systems.end(), [](const auto& system) { return system->is_regular(); });
}

MotionSolver solver_by_component(const Sparse& matrix, const IsGiven& is_given)
{
  MotionSolver solver;
  for (Eigen::Index c = 0; c < is_given.rows(); ++c) {
    Eigen::Index same = 0;
    while (same < c && !(is_given.row(same) == is_given.row(c)).all()) ++same;
    if (same < c) solver.systems.push_back(solver.systems[static_cast<std::size_t>(same)]);
    else solver.systems.push_back(std::make_shared<GivenSystem>(matrix, is_given.row(c).transpose()));
  }
  return solver;
}

MotionSolver coupled_solver(const Sparse& matrix, const IsGiven& is_given)
{
  return {{std::make_shared<GivenSystem>(matrix, is_given.reshaped())}};
}

void complete_motion(const MotionSolver& solver, Eigen::MatrixXd& velocity)
{
  if (solver.systems.size() == 1) {
    solver.systems.front()->complete(velocity.reshaped());
    return;
  }
  for (Eigen::Index c = 0; c < velocity.rows(); ++c) {
    Eigen::VectorXd component = velocity.row(c);
    solver.systems[static_cast<std::size_t>(c)]->complete(component);
    velocity.row(c) = component;
  }
}

} // namespace mullion::moving_mesh
