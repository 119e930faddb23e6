// Newmark and central differences: energy, statics, periods, exact waves, equilibrium of the
// acceleration.
#include "elastic_bar/newmark.hpp"

#include "elastic_bar/initial_states.hpp"
#include "support/kernel_storage.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace mullion::elastic_bar;
using mullion::testing::BarMotion;
using mullion::testing::worst;

namespace {

double energy(const Bar& bar, const BarMotion& motion)
{
  return potential_energy(bar, motion.displacement) + kinetic_energy(bar, motion.velocity);
}

double rough_load(int step) { return 1e4 * std::sin(0.37 * step) + (step % 7 < 3 ? 2e4 : -1e4); }

// Largest |M a - F + K u| over the moving nodes, over the largest nodal force.
double residual(const Bar& bar, const BarMotion& motion, double load)
{
  std::vector<double> a(bar.n_nodes());
  equilibrium_acceleration(bar, motion.displacement, load, a);
  double largest = 0.0;
  double scale = std::abs(load);
  for (std::size_t i = 0; i < bar.n_free(); ++i) {
    largest = worst(largest, std::abs(a[i] - motion.acceleration[i]) * bar.nodal_mass(i));
    scale = std::max(scale, std::abs(a[i]) * bar.nodal_mass(i));
  }
  return largest / scale;
}

} // namespace

TEST_CASE("Newmark: the work of the mean of both loads is the change of the bar's energy")
{
  for (const FarEnd far_end : {FarEnd::clamped, FarEnd::free}) {
    const Bar bar{.density = 260.0,
                  .youngs_modulus = 2.8e5,
                  .length = 0.2,
                  .n_elements = 10,
                  .far_end = far_end};
    BarMotion motion(bar);
    double load = rough_load(0);
    set_rest(bar, motion.view(), load);
    Newmark newmark(bar, 3e-4);
    double work = 0.0;
    double throughput = 0.0;

    for (int step = 1; step <= 2000; ++step) {
      const double u_begin = motion.displacement[0];
      newmark.step(motion.view(), rough_load(step));
      const double w =
          interface_work(0.5 * (load + rough_load(step)), u_begin, motion.displacement[0]);
      load = rough_load(step);
      work += w;
      throughput += std::abs(w);
    }

    CHECK(std::abs(energy(bar, motion) - work) < 1e-12 * throughput); // round-off of 2000 steps
    CHECK(residual(bar, motion, load) <
          1e-11); // the acceleration is in equilibrium with the last load
  }
}

TEST_CASE("Newmark with a mean load: its work is the change of the bar's energy")
{
  for (const FarEnd far_end : {FarEnd::clamped, FarEnd::free}) {
    const Bar bar{.density = 260.0,
                  .youngs_modulus = 2.8e5,
                  .length = 0.2,
                  .n_elements = 10,
                  .far_end = far_end};
    BarMotion motion(bar);
    Newmark newmark(bar, 3e-4);
    double work = 0.0;
    double throughput = 0.0;

    for (int step = 1; step <= 2000; ++step) {
      const double u_begin = motion.displacement[0];
      newmark.step_mean(motion.view(), rough_load(step));
      const double w = interface_work(rough_load(step), u_begin, motion.displacement[0]);
      work += w;
      throughput += std::abs(w);
    }

    CHECK(std::abs(energy(bar, motion) - work) < 1e-12 * throughput); // round-off of 2000 steps
    CHECK(residual(bar, motion, rough_load(2000)) < 1e-15);           // by construction
  }
}

TEST_CASE("Newmark: both forms of the step agree where the mean of the loads is the mean load")
{
  const Bar bar{.density = 260.0, .youngs_modulus = 2.8e5, .length = 0.2, .n_elements = 6};
  BarMotion by_step(bar), by_mean(bar);
  set_rest(bar, by_step.view(), rough_load(0));
  Newmark newmark(bar, 3e-4);

  for (int step = 1; step <= 50; ++step) {
    newmark.step(by_step.view(), rough_load(step));
    newmark.step_mean(by_mean.view(), 0.5 * (rough_load(step - 1) + rough_load(step)));
  }

  const double scale = std::abs(by_step.displacement[0]);
  for (std::size_t i = 0; i < bar.n_nodes(); ++i)
    CHECK(std::abs(by_step.displacement[i] - by_mean.displacement[i]) <
          1e-11 * scale); // round-off of 50 steps
}

TEST_CASE("every integrator leaves the static solution and the clamped node alone")
{
  const Bar bar{
      .density = 260.0, .youngs_modulus = 1e6, .length = 0.2, .area = 2.0, .n_elements = 5};
  const double load = 1e3;
  const double u0 = load * 0.2 / (1e6 * 2.0); // F L_s / (E A)
  Newmark newmark(bar, 2e-4);
  const auto run = [&](auto&& step) {
    BarMotion motion(bar);
    for (std::size_t i = 0; i < 6; ++i)
      motion.displacement[i] = u0 * (1.0 - static_cast<double>(i) / 5.0);
    equilibrium_acceleration(bar, motion.displacement, load, motion.acceleration);
    for (int n = 0; n < 200; ++n)
      step(motion.view());
    CHECK(std::abs(motion.displacement[0] - u0) < 1e-11 * u0); // round-off
    CHECK(motion.displacement[5] == 0.0);                      // exactly
    CHECK(motion.velocity[5] == 0.0);
    CHECK(motion.acceleration[5] == 0.0);
  };

  run([&](const Motion& m) { newmark.step(m, load); });
  run([&](const Motion& m) { newmark.step_mean(m, load); });
  run([&](const Motion& m) { central_difference_step(bar, m, 2e-4, load); });
  run([&](const Motion& m) { central_difference_step_mean(bar, m, 2e-4, load); });
}

TEST_CASE("Newmark gives a mode the frequency (2 / dt) atan(w dt / 2)")
{
  // A mode of the lumped elements: sin(k X) with w = (2 c_s / dx) sin(k dx / 2), here with c_s = 1.
  const Bar bar{.density = 1.0, .youngs_modulus = 1.0, .length = 1.0, .n_elements = 8};
  const double k = std::numbers::pi / 2.0;
  const double w = 16.0 * std::sin(k / 16.0);
  const double dt = 0.3; // 2.4 times the stability limit of central differences
  const double angle = 2.0 * std::atan(0.5 * w * dt);
  BarMotion motion(bar);
  set_mode(bar, motion.view(), 0.01, k, 0.0);
  Newmark newmark(bar, dt);

  double error = 0.0;
  for (int step = 1; step <= 300; ++step) {
    newmark.step(motion.view(), 0.0);
    error = worst(error, std::abs(motion.displacement[0] - 0.01 * std::cos(step * angle)));
  }

  CHECK(error < 1e-11 * 0.01); // round-off of 300 steps
}

TEST_CASE("central differences at unit Courant number carry a load step exactly through the bar")
{
  // d'Alembert: under a sudden load F the loaded end moves with F / (A z_s) until the wave is back
  // at 2 L_s / c_s, then with -F / (A z_s).
  const Bar bar{
      .density = 4.0, .youngs_modulus = 1.0, .length = 1.0, .n_elements = 10}; // c_s = 0.5, z_s = 2
  const double dt = 0.2;
  BarMotion motion(bar);
  set_rest(bar, motion.view(), 3.0);

  for (int step = 1; step <= 40; ++step) {
    central_difference_step(bar, motion.view(), dt, 3.0);
    const double t = step * dt;
    const double exact = t <= 4.0 ? 1.5 * t : 1.5 * (8.0 - t);
    CHECK(std::abs(motion.displacement[0] - exact) < 1e-12); // round-off
  }
}

TEST_CASE("velocity Verlet keeps the energy up to a bounded term of second order in the step")
{
  const Bar bar{.density = 1.0, .youngs_modulus = 1.0, .length = 1.0, .n_elements = 8};
  const auto drift = [&](double dt) {
    BarMotion motion(bar);
    set_mode(bar, motion.view(), 0.01, std::numbers::pi / 2.0, 0.0);
    const double begin = energy(bar, motion);
    double largest = 0.0;
    for (int step = 0; step < static_cast<int>(40.0 / dt); ++step) { // ten periods
      central_difference_step(bar, motion.view(), dt, 0.0);
      largest = worst(largest, std::abs(energy(bar, motion) - begin) / begin);
    }
    return largest;
  };

  CHECK(drift(0.05) <
        std::pow(0.25 * std::numbers::pi * 0.05, 2.0) * 1.01); // (w dt / 2)^2 of the mode
  CHECK(std::log2(drift(0.05) / drift(0.025)) == doctest::Approx(2.0).epsilon(0.02));
}

TEST_CASE("the two halves of a central difference step are the step")
{
  const Bar bar{.density = 260.0, .youngs_modulus = 2.8e5, .length = 0.2, .n_elements = 6};
  BarMotion whole(bar), halves(bar);
  set_rest(bar, whole.view(), 100.0);
  set_rest(bar, halves.view(), 100.0);

  for (int step = 1; step <= 20; ++step) {
    central_difference_step(bar, whole.view(), 1e-4, rough_load(step));
    central_difference_displacement(bar, halves.view(), 1e-4);
    central_difference_velocity(bar, halves.view(), 1e-4, rough_load(step));
  }

  CHECK(whole.displacement == halves.displacement); // bit for bit
  CHECK(whole.velocity == halves.velocity);
}

TEST_CASE("after a step with a mean load the acceleration is in equilibrium with that load")
{
  const Bar bar{.density = 260.0, .youngs_modulus = 2.8e5, .length = 0.2, .n_elements = 6};
  BarMotion motion(bar);

  for (int step = 1; step <= 20; ++step)
    central_difference_step_mean(bar, motion.view(), 1e-4, rough_load(step));

  CHECK(residual(bar, motion, rough_load(20)) < 1e-15); // by construction
}

TEST_CASE("a damaged acceleration does not matter to a step with a mean load")
{
  const Bar bar{.density = 260.0, .youngs_modulus = 2.8e5, .length = 0.2, .n_elements = 6};
  BarMotion sound(bar), damaged(bar);
  std::fill(damaged.acceleration.begin(), damaged.acceleration.end(), std::nan(""));
  Newmark newmark(bar, 1e-4);

  newmark.step_mean(sound.view(), 5.0);
  newmark.step_mean(damaged.view(), 5.0);

  CHECK(sound.displacement == damaged.displacement);
  CHECK(sound.acceleration == damaged.acceleration);

  std::fill(damaged.acceleration.begin(), damaged.acceleration.end(), std::nan(""));
  central_difference_step_mean(bar, sound.view(), 1e-4, 7.0);
  central_difference_step_mean(bar, damaged.view(), 1e-4, 7.0);
  CHECK(sound.displacement == damaged.displacement);
  CHECK(sound.velocity == damaged.velocity);
}

TEST_CASE("a bar of one element is a mass on a spring")
{
  const Bar bar{
      .density = 2.0, .youngs_modulus = 3.0, .length = 1.0, .n_elements = 1}; // m = 1, k = 3
  BarMotion motion(bar);
  motion.displacement[0] = 1.0;
  equilibrium_acceleration(bar, motion.displacement, 0.0, motion.acceleration);
  Newmark newmark(bar, 0.1);

  newmark.step(motion.view(), 0.0);

  CHECK(motion.displacement[0] ==
        doctest::Approx(std::cos(2.0 * std::atan(0.05 * std::sqrt(3.0)))).epsilon(1e-14));
  CHECK(motion.displacement[1] == 0.0);
}
