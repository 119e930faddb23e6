// Every scheme as `mullion run` does it against a hand-written loop over the same kernels: to the bit where both are
// the same algorithm, so neither windows nor transfers, time stamps nor processes change anything.
#include "support/coupled_piston.hpp"
#include "support/piston_run.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

using namespace mullion::test;
using mullion::testing::CibcWeights;
using mullion::testing::CoupledPiston;
using mullion::testing::Offset;
using mullion::testing::Piston;
using mullion::testing::Profile;
using mullion::testing::worst;

namespace {

using Loop = std::function<void(CoupledPiston&)>;

constexpr int n_cells = 20;
constexpr double end = 5.0; // f_f t

PistonRun light_piston(double courant, const std::vector<std::string>& sets)
{
  const Piston piston{.density_ratio = 20.0}; // light, so that the two sides feel one another within 400 steps
  return {.piston = piston, .cells = n_cells, .dt = courant_step(piston, n_cells, courant), .end = end, .sets = sets};
}

/// u_I of the loop, after 0, 1, … steps.
std::vector<double> loop_displacement(const PistonRun& run, const Loop& step, Offset offset)
{
  CoupledPiston loop(run.piston, n_cells, run.dt, offset);
  std::vector<double> u = {loop.u()};
  for (int n = 1; n <= n_steps(run); ++n) {
    step(loop);
    u.push_back(loop.u());
  }
  return u;
}

void check_bits(const PistonRun& run, const Loop& step, Offset offset = Offset::none)
{
  CAPTURE(fmt::format("{}", fmt::join(run.sets, " ")));
  const auto expected = loop_displacement(run, step, offset);

  const auto found = history_of(run).at("structure.wet.displacement");

  REQUIRE(found.size() == expected.size());
  int n_different = 0;
  for (std::size_t n = 0; n < found.size(); ++n) n_different += found[n] != expected[n];
  CHECK(n_different == 0);
  CHECK(found.back() != found.front()); // it moved
}

} // namespace

TEST_CASE("css gives the bits of a hand-written loop, in either order and with either profile")
{
  for (const auto profile : {Profile::constant, Profile::linear}) {
    const std::string option = profile == Profile::constant ? "driver.profile=constant" : "driver.profile=linear";
    check_bits(light_piston(0.5, {"driver.order=structure_first", option}),
               [&](CoupledPiston& p) { p.css_structure_first(profile); });
    check_bits(light_piston(0.5, {"driver.order=fluid_first", option}),
               [&](CoupledPiston& p) { p.css_fluid_first(profile); });
  }
}

TEST_CASE("gss, iss and explicit_lagfree give the bits of hand-written loops")
{
  check_bits(light_piston(0.5, {"driver.scheme=gss"}), [](CoupledPiston& p) { p.gss_trapezoidal(); });
  check_bits(
      light_piston(0.5, {"driver.scheme=iss", "driver.starts_early=true"}), [](CoupledPiston& p) { p.iss(); },
      Offset::half);
  check_bits(light_piston(0.5, {"driver.scheme=explicit_lagfree", "structure.integrator=central_difference"}),
             [](CoupledPiston& p) { p.explicit_lagfree(); });
}

TEST_CASE("all readings of cibc give the bits of hand-written loops")
{
  const auto cibc = [](double courant, const std::vector<std::string>& sets) {
    auto run = light_piston(courant, {"driver.scheme=cibc"});
    const double omega = 0.4 / run.piston.fluid_speed();
    run.sets.push_back(fmt::format("driver.fluid_density={}", run.piston.rho0));
    run.sets.push_back(fmt::format("driver.omega={}", omega));
    run.sets.insert(run.sets.end(), sets.begin(), sets.end());
    return std::pair(run, CibcWeights{omega, omega});
  };
  {
    const auto [run, omega] = cibc(0.25, {}); // its Courant number must be 0.3 at most
    check_bits(run, [omega = omega](CoupledPiston& p) { p.cibc(omega); });
  }
  {
    // 0.2: its weight must be 8/3 of the Courant number at most, which 0.4 is
    const auto [run, omega] = cibc(0.2, {"driver.reading=printed"});
    check_bits(run, [omega = omega](CoupledPiston& p) { p.cibc_printed(omega); });
  }
  {
    const auto [run, omega] = cibc(0.5, {"driver.half_offset=true", "driver.starts_early=true"});
    check_bits(
        run, [omega = omega](CoupledPiston& p) { p.cibc_half_offset(omega); }, Offset::half);
  }
  for (const int n : {1, 3}) {
    const auto [run, omega] = cibc(0.5, {fmt::format("driver.sub_iterations={}", n)});
    check_bits(run, [omega = omega, n](CoupledPiston& p) { p.cibc_sub_iterated(omega, n); });
  }
}

TEST_CASE("strong coupling gives what a hand-written fixed point iteration gives, with any acceleration")
{
  // mu = 200: the round-off of 1e5 Pa moves a lighter bar's end by more than the tolerance, and the loop would not end.
  // 1e-9 A: each of 400 steps may leave 1e-11 of the velocity, times w dt = 0.02, which is 8e-11 A if all went one way;
  // the parallel iteration 1e-9 of the gas's traction too, 6 % of the forces on the bar: 400 * 0.02 * 0.06 * 1e-9 =
  // 5e-10.
  const Piston piston{.density_ratio = 200.0};
  for (const std::string acceleration : {"constant", "aitken", "iqn_ils", "iqn_mvj"})
    for (const std::string iteration : {"serial", "parallel"}) {
      CAPTURE(acceleration);
      CAPTURE(iteration);
      const PistonRun run{.piston = piston,
                          .cells = n_cells,
                          .dt = courant_step(piston, n_cells, 0.5),
                          .end = end,
                          .sets = {"driver.scheme=strong", "driver.acceleration=" + acceleration,
                                   "driver.iteration=" + iteration, "driver.relaxation=1", "driver.first_relaxation=1",
                                   "driver.motion_tolerance=1e-11", "driver.motion_floor=1e-15",
                                   "driver.traction_tolerance=1e-9", "driver.traction_floor=1e-10"}};
      const auto expected = loop_displacement(
          run, [](CoupledPiston& p) { p.strong(); }, Offset::none);

      const auto found = history_of(run).at("structure.wet.displacement");

      REQUIRE(found.size() == expected.size());
      double largest = 0.0;
      for (std::size_t n = 0; n < found.size(); ++n) largest = worst(largest, std::abs(found[n] - expected[n]));
      CHECK(largest < 1e-9 * mode_amplitude);
    }
}
