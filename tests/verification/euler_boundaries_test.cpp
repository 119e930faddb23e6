// The open boundaries of the fluid of the plane, each where the exact solution is known: supersonic inflow and outflow
// (a uniform stream, a vortex that leaves, a ramp with an oblique shock) and a prescribed state (a wave of density that
// comes in and leaves).
#include "support/euler_flow.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace mullion::euler;
using namespace mullion::testing;

namespace {

constexpr double pi = std::numbers::pi, g = 1.4;

Condition<2> supersonic_inflow(const Values<2>& state)
{
  Condition<2> condition;
  condition.kind = Kind::supersonic_inflow;
  condition.state = state;
  return condition;
}

Condition<2> supersonic_outflow()
{
  Condition<2> condition;
  condition.kind = Kind::supersonic_outflow;
  return condition;
}

Condition<2> prescribed(const std::function<Values<2>(const Vec<2>&, double)>& function)
{
  Condition<2> condition;
  condition.kind = Kind::prescribed;
  condition.function = function;
  return condition;
}

/// Steps on the resting mesh up to `end`, all of one size.
void run(EulerFlow<2>& flow, double end, double courant)
{
  const auto n_steps = static_cast<int>(std::ceil((end - flow.time) / flow.stable_step(courant)));
  const double dt = (end - flow.time) / n_steps;
  for (int k = 0; k < n_steps; ++k) flow.step(dt);
}

/// Mean over the domain of |rho - exact|, the exact means of the cells by quadrature.
double density_error(EulerFlow<2>& flow, const std::function<Values<2>(const Vec<2>&)>& exact)
{
  const auto found = flow.amounts;
  flow.start(exact, Average::quadrature);
  double error = 0.0, volume = 0.0;
  for (std::size_t c = 0; c < found.size(); ++c) {
    error += std::abs(found[c][0] - flow.amounts[c][0]);
    volume += flow.shape(c).volume;
  }
  flow.amounts = found;
  return error / volume;
}

// ---- a vortex that leaves ----------------------------------------------------------------------------------------

constexpr double vortex_speed = 3.0; ///< of the stream; the vortex turns with 0.16 at most and c = 1.18

/// An isentropic vortex (shu1998 section 5, strength 1) that starts in the middle of 10 m and is carried along x.
Values<2> vortex(const Vec<2>& x, double t)
{
  constexpr double beta = 1.0;
  const double dx = x.x() - 5.0 - vortex_speed * t, dy = x.y() - 5.0;
  const double e = std::exp(0.5 * (1.0 - dx * dx - dy * dy));
  const double temperature = 1.0 - (g - 1.0) * beta * beta / (8.0 * g * pi * pi) * e * e;
  const double rho = std::pow(temperature, 1.0 / (g - 1.0));
  return {rho, vortex_speed - beta / (2.0 * pi) * e * dy, beta / (2.0 * pi) * e * dx, rho * temperature};
}

/// It comes in with a uniform stream, and leaves; y is periodic.
const std::vector<Side<2>> sides = {{"x_min", supersonic_inflow({1.0, vortex_speed, 0.0, 1.0})},
                                    {"x_max", supersonic_outflow()}};

// ---- an oblique shock --------------------------------------------------------------------------------------------

struct ObliqueShock {
  double angle;    ///< beta, from the stream [rad]
  double pressure; ///< p_2 / p_1
};

/// The weak one of both that turn a stream of Mach number m by theta; anderson2003 section 4.3:
/// tan(theta) = 2 cot(beta) (m^2 sin^2(beta) - 1) / (m^2 (g + cos(2 beta)) + 2).
ObliqueShock oblique_shock(double m, double theta)
{
  const auto turn = [&](double beta) {
    const double s = m * std::sin(beta);
    return std::atan(2.0 / std::tan(beta) * (s * s - 1.0) / (m * m * (g + std::cos(2.0 * beta)) + 2.0));
  };
  double low = std::asin(1.0 / m), high = low + theta + 0.2; // the turn grows with beta up to the largest one
  for (int k = 0; k < 100; ++k) {
    const double beta = 0.5 * (low + high);
    (turn(beta) < theta ? low : high) = beta;
  }
  const double s = m * std::sin(low);
  return {low, 1.0 + 2.0 * g / (g + 1.0) * (s * s - 1.0)};
}

struct RampErrors {
  double angle;         ///< of the shock [rad]
  double wall_pressure; ///< on the second half of the ramp, relative, of the mean
  double pressure;      ///< mean over the domain, relative to p_1
};

/// Mach 2 over a ramp of 10 degrees that begins a quarter of a metre behind the inflow.
RampErrors ramp_errors(int n)
{
  constexpr double mach = 2.0, theta = 10.0 * pi / 180.0, corner = 0.25, length = 1.25, height = 1.2;
  const auto exact = oblique_shock(mach, theta);
  Scheme<2> scheme;
  scheme.limiter = {Limiter::venkatakrishnan, 0.3, 1.0, {1.0, 1.0, 1.0, 1.0}};
  auto file = mullion::mesh_files::read_or_generate(
      "box:" + std::to_string(5 * n) + "x" + std::to_string(4 * n) + ",size=1.25x1.2", 2);
  for (Eigen::Index i = 0; i < file.nodes.cols(); ++i) {
    const double floor = std::max(file.nodes(0, i) - corner, 0.0) * std::tan(theta);
    file.nodes(1, i) = floor + file.nodes(1, i) * (1.0 - floor / height);
  }
  const Values<2> stream{g, mach, 0.0, 1.0}; // c = 1
  EulerFlow<2> flow(file,
                    {{"x_min", supersonic_inflow(stream)},
                     {"y_max", supersonic_inflow(stream)}, // the shock leaves below it
                     {"x_max", supersonic_outflow()},
                     {"y_min", wall<2>()}},
                    scheme);
  flow.start([&](const Vec<2>&) { return stream; });
  run(flow, 5.0, 0.8); // the stream crosses the domain eight times

  RampErrors errors{0.0, 0.0, 0.0};
  double on_wall = 0.0, volume = 0.0;
  int n_on_wall = 0;
  std::vector<std::vector<std::pair<double, double>>> columns(static_cast<std::size_t>(5 * n)); // of (y, p), by x
  for (std::size_t c = 0; c < flow.amounts.size(); ++c) {
    const auto shape = flow.shape(c);
    const double x = shape.centroid.x() - corner, y = shape.centroid.y(), p = flow.value(c)[3];
    const bool is_behind = x > 0.0 && y < x * std::tan(exact.angle);
    errors.pressure += std::abs(p - (is_behind ? exact.pressure : 1.0)) * shape.volume;
    volume += shape.volume;
    columns[static_cast<std::size_t>((x + corner) / length * 5 * n)].emplace_back(y, p);
    if (x > 0.5 && y - x * std::tan(theta) < height / (4 * n)) { // the lowest row
      on_wall += p;
      ++n_on_wall;
    }
  }
  errors.pressure /= volume;
  errors.wall_pressure = std::abs(on_wall / n_on_wall / exact.pressure - 1.0);
  // The shock is where the pressure is the mean of both sides; its angle is that of the line through these places.
  double sum = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double x = (static_cast<double>(i) + 0.5) / (5 * n) * length - corner;
    if (x < 0.4) continue;
    auto& column = columns[i];
    std::sort(column.begin(), column.end());
    const double middle = 0.5 * (1.0 + exact.pressure);
    for (std::size_t k = column.size(); k-- > 1;) {
      const auto [y_0, p_0] = column[k - 1];
      const auto [y_1, p_1] = column[k];
      if (p_0 < middle || p_1 >= middle) continue;
      const double y = y_0 + (p_0 - middle) / (p_0 - p_1) * (y_1 - y_0);
      sum += 1.0;
      sum_x += x;
      sum_y += y;
      sum_xx += x * x;
      sum_xy += x * y;
      break;
    }
  }
  errors.angle = std::abs(std::atan((sum * sum_xy - sum_x * sum_y) / (sum * sum_xx - sum_x * sum_x)) - exact.angle);
  return errors;
}

} // namespace

TEST_CASE("a supersonic stream that comes in on two sides and leaves on two stays uniform, on a moving mesh too")
{
  const Values<2> stream{1.3, 700.0, 520.0, 1.0e5}; // Mach 2.1 along x, 1.6 along y
  for (const char* cells : {"quads", "triangles"}) {
    CAPTURE(cells);
    EulerFlow<2> flow(std::string("box:12x10,") + cells + ",size=1x0.8",
                      {{"x_min", supersonic_inflow(stream)},
                       {"y_min", supersonic_inflow(stream)},
                       {"x_max", supersonic_outflow()},
                       {"y_max", supersonic_outflow()}},
                      {});
    flow.start([&](const Vec<2>&) { return stream; });
    const double dt = flow.stable_step(0.5);

    for (int k = 0; k < 100; ++k) flow.step(dt);

    CHECK(deviation(flow, stream) < 1e-13); // round-off of 100 steps

    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> along(-1.0, 1.0);
    EulerFlow<2>::Nodes v(2, flow.nodes.cols());
    for (int k = 0; k < 20; ++k) { // there and back, so that no cell is folded; the boundary's nodes move, too
      if (k % 2 == 0)
        for (Eigen::Index i = 0; i < v.size(); ++i) v(i) = 0.01 / dt * along(random);
      else v = -v;
      flow.step(dt, v);
    }
    CHECK(deviation(flow, stream) < 1e-12); // the geometric conservation law, to round-off of the areas
  }
}

TEST_CASE("a vortex leaves through a supersonic outflow with second order, and nothing comes back")
{
  for (const char* cells : {"quads", "triangles"}) {
    CAPTURE(cells);
    std::vector<double> half_gone, gone;
    for (const int n : {40, 80}) {
      EulerFlow<2> flow("box:" + std::to_string(n) + "x" + std::to_string(n) + "," + cells + ",size=10x10", sides, {},
                        {{"y_min", "y_max"}});
      flow.start([](const Vec<2>& x) { return vortex(x, 0.0); }, Average::quadrature);

      run(flow, 5.0 / vortex_speed, 0.8); // its middle is on the boundary
      half_gone.push_back(density_error(flow, [](const Vec<2>& x) { return vortex(x, 5.0 / vortex_speed); }));
      run(flow, 10.0 / vortex_speed, 0.8); // it is 5 m behind it: there e is 1e-5
      gone.push_back(density_error(flow, [](const Vec<2>& x) { return vortex(x, 10.0 / vortex_speed); }));
    }
    // Observed 2.1 and 1.8 on quadrilaterals, 2.5 and 2.4 on triangles.
    CHECK(std::log2(half_gone[0] / half_gone[1]) > 1.8);
    CHECK(std::log2(gone[0] / gone[1]) > 1.6);
    // Of the 2.8e-4 that the vortex takes off the mean density, 1.1e-6 and 0.5e-6 are left behind: its trail in this
    // scheme, which the first check has seen to vanish. Half of it sent back would be 1.4e-4.
    CHECK(gone[1] < 3e-6);
  }
}

TEST_CASE("a wave of density comes in and leaves through a prescribed state with second order")
{
  // Density is carried by a uniform velocity at a uniform pressure: exact, and at Mach 0.5 neither all in nor all out.
  constexpr double u = 0.5, v = 0.3;
  const auto exact = [](const Vec<2>& x, double t) {
    return Values<2>{1.4 * (1.0 + 0.2 * std::sin(2.0 * pi * (x.x() - u * t)) * std::cos(2.0 * pi * (x.y() - v * t))), u,
                     v, 1.0};
  };
  for (const char* cells : {"quads", "triangles"}) {
    CAPTURE(cells);
    std::vector<double> errors;
    double pressure = 0.0;
    for (const int n : {16, 32}) {
      EulerFlow<2> flow("box:" + std::to_string(n) + "x" + std::to_string(n) + "," + cells,
                        {{"x_min", prescribed(exact)},
                         {"x_max", prescribed(exact)},
                         {"y_min", prescribed(exact)},
                         {"y_max", prescribed(exact)}},
                        {});
      flow.start([&](const Vec<2>& x) { return exact(x, 0.0); }, Average::quadrature);

      run(flow, 2.0, 0.8); // the gas is changed once

      errors.push_back(density_error(flow, [&](const Vec<2>& x) { return exact(x, 2.0); }));
      for (std::size_t c = 0; c < flow.amounts.size(); ++c)
        pressure = std::max(pressure, std::abs(flow.value(c)[3] - 1.0));
    }
    CHECK(std::log2(errors[0] / errors[1]) > 1.8); // observed 2.3
    CHECK(errors[1] < 2.4e-3);                     // observed 1.2e-3; the wave's own mean is 0.11
    CHECK(pressure < 1e-13);                       // a contact: nothing but round-off in 400 steps
  }
}

TEST_CASE("a ramp in a supersonic stream makes the exact oblique shock")
{
  // naca1135, chart of oblique shocks: Mach 2 turned by 10 degrees has a shock at 39.3 degrees with p_2 / p_1 = 1.707.
  const auto exact = oblique_shock(2.0, 10.0 * pi / 180.0);
  REQUIRE(exact.angle * 180.0 / pi == doctest::Approx(39.314).epsilon(1e-4));
  REQUIRE(exact.pressure == doctest::Approx(1.7066).epsilon(1e-4));

  const auto coarse = ramp_errors(8), fine = ramp_errors(16);

  // Observed: 0.0065 and 0.0004 degrees, 2.3e-4 and 1.2e-5; the bounds leave room for a limiter that settles
  // elsewhere.
  CHECK(coarse.angle < 0.05 * pi / 180.0);
  CHECK(fine.angle < 0.02 * pi / 180.0);
  CHECK(coarse.wall_pressure < 1e-3);
  CHECK(fine.wall_pressure < 2e-4);
  // A captured shock is a few cells wide on any mesh: first order in the mean, observed 0.98.
  CHECK(std::log2(coarse.pressure / fine.pressure) > 0.85);
  CHECK(fine.pressure < 0.01); // observed 0.0063
}
