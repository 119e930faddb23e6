// Quadrature of first states over triangles and quadrilaterals.
#include "initial.hpp"

#include <cmath>
#include <utility>

namespace mullion::euler {

namespace {

/// Mean of the conserved values over a cell of the plane.
Values<2> mean_over(const MeshSource<2>& source, const Connectivity& connectivity, Eigen::Index column, const Gas& gas,
                    const StateFunction<2>& state)
{
  Values<2> sum{};
  double area = 0.0;
  const auto add = [&](const Vec<2>& x, double weight) {
    const auto value = conserved<2>(gas, state(x));
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += weight * value[v];
    area += weight;
  };
  const auto node = [&](Eigen::Index k) -> Vec<2> { return source.nodes.col(connectivity(k, column)); };
  if (connectivity.rows() == 3) { // exact for quadratic functions
    for (int k = 0; k < 3; ++k) add((4.0 * node(k) + node((k + 1) % 3) + node((k + 2) % 3)) / 6.0, 1.0);
  } else {
    const double g = 1.0 / std::sqrt(3.0);
    for (const auto& [xi, eta] : {std::pair{-g, -g}, std::pair{g, -g}, std::pair{g, g}, std::pair{-g, g}}) {
      const Vec<2> x = 0.25 * ((1 - xi) * (1 - eta) * node(0) + (1 + xi) * (1 - eta) * node(1) +
                               (1 + xi) * (1 + eta) * node(2) + (1 - xi) * (1 + eta) * node(3));
      const Vec<2> a = 0.25 * ((1 - eta) * (node(1) - node(0)) + (1 + eta) * (node(2) - node(3)));
      const Vec<2> b = 0.25 * ((1 - xi) * (node(3) - node(0)) + (1 + xi) * (node(2) - node(1)));
      add(x, a.x() * b.y() - a.y() * b.x());
    }
  }
  for (auto& value : sum) value /= area;
  return sum;
}

} // namespace

template <int D>
void set_amounts(const MeshSource<D>& source, const Mesh<D>& mesh, const Gas& gas, const std::vector<double>& volume,
                 const std::vector<Vec<D>>& centroid, const StateFunction<D>& state, Average average,
                 std::vector<Values<D>>& amounts)
{
  std::vector<std::pair<const Connectivity*, Eigen::Index>> cells;
  for (const auto& block : source.blocks)
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) cells.emplace_back(&block.connectivity, e);
  amounts.resize(mesh.n_cells);
  for (std::size_t c = 0; c < mesh.n_cells; ++c) {
    Values<D> mean;
    if constexpr (D == 2) {
      const auto& [connectivity, column] = cells[static_cast<std::size_t>(mesh.order[c])];
      mean = average == Average::quadrature ? mean_over(source, *connectivity, column, gas, state)
                                            : conserved<2>(gas, state(centroid[c]));
    } else {
      if (average == Average::quadrature) throw MeshError("averages by quadrature are for the plane");
      mean = conserved<D>(gas, state(centroid[c]));
    }
    for (std::size_t v = 0; v < mean.size(); ++v) amounts[c][v] = mean[v] * volume[c];
  }
}

template void set_amounts(const MeshSource<2>&, const Mesh<2>&, const Gas&, const std::vector<double>&,
                          const std::vector<Vec<2>>&, const StateFunction<2>&, Average, std::vector<Values<2>>&);
template void set_amounts(const MeshSource<3>&, const Mesh<3>&, const Gas&, const std::vector<double>&,
                          const std::vector<Vec<3>>&, const StateFunction<3>&, Average, std::vector<Values<3>>&);

} // namespace mullion::euler
