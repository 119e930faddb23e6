#include "waving_fluid.hpp"

#include <cmath>

namespace mullion::test {

std::vector<FieldSpec> WavingFluid::fields()
{
  return {state("volume", "coordinates", Location::node, vector, "m", "where the nodes are").overwritten(),
          output("volume", "velocity", Location::node, vector, "m/s", "of the nodes"),
          output("volume", "pressure", Location::element, scalar, "Pa", "100 kPa and 1 kPa times the element's number"),
          output("volume", "solver_residual", Location::pane, scalar, "1", "ten to the power of minus the step")};
}

std::vector<InputSpec> WavingFluid::inputs() { return {}; }

void WavingFluid::define(const TimeStep& initial)
{
  const int nx = options_.cells, ny = (options_.cells + 1) / 2;
  Coordinates nodes(2, (nx + 1) * (ny + 1));
  Connectivity squares(4, nx * ny), triangles(3, 2 * nx * ny);
  Eigen::Index n_squares = 0, n_triangles = 0;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      nodes.col(j * (nx + 1) + i) << i, j;
      if (i == nx || j == ny) continue;
      const Index a = j * (nx + 1) + i, b = a + 1, c = b + nx + 1, d = c - 1;
      if (2 * j < ny) squares.col(n_squares++) << a, b, c, d;
      else {
        triangles.col(n_triangles++) << a, b, c;
        triangles.col(n_triangles++) << a, c, d;
      }
    }
  make_window("volume", {{0,
                          nodes,
                          {{ElementType::quadrilateral4, squares.leftCols(n_squares)},
                           {ElementType::triangle3, triangles.leftCols(n_triangles)}}}});
  attach();
  fill(initial);
}

void WavingFluid::attach()
{
  reference_ = pane("volume").coordinates;
  coordinates_ = field("volume", "coordinates");
  velocity_ = field("volume", "velocity");
  pressure_ = field("volume", "pressure");
  residual_ = field("volume", "solver_residual");
}

void WavingFluid::step(const TimeStep& step) { fill(step); }

void WavingFluid::fill(const TimeStep& step)
{
  auto coordinates = coordinates_.now();
  auto velocity = velocity_.now();
  for (Eigen::Index i = 0; i < reference_.cols(); ++i) {
    const double lift_rate = options_.amplitude * reference_(0, i);
    velocity.col(i) << 0.0, lift_rate;
    coordinates.col(i) << reference_(0, i), reference_(1, i) + lift_rate * step.end;
  }
  auto pressure = pressure_.now();
  for (Eigen::Index e = 0; e < pressure.cols(); ++e) pressure(0, e) = 1e5 + 1e3 * static_cast<double>(e);
  residual_.now()(0, 0) = std::pow(10.0, -static_cast<double>(step.index));
}

} // namespace mullion::test
