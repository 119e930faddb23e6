// Closed and open left ends.
#include "euler_1d/left_end.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::euler_1d;

namespace {

constexpr Gas air{1.4};
constexpr Reference outside{1.3, 1e5};

} // namespace

TEST_CASE("gas at rest in the reference state stays so at an open end")
{
  const Primitive b = open_end_state(air, outside, {1.3, 0.0, 1e5}, 0.0);

  CHECK(b.density == 1.3);
  CHECK(b.velocity == 0.0);
  CHECK(b.pressure == 1e5);
}

TEST_CASE("a wave that runs to the left passes an open end unchanged")
{
  Primitive wave{1.3, 0.0, 1.001e5};
  wave.density = 1.3 * std::pow(1.001, 1.0 / 1.4);
  wave.velocity = -(wave.pressure - 1e5) / impedance(air, wave); // p' = -z u

  const Primitive b = open_end_state(air, outside, wave, 0.0);

  CHECK(b.pressure == doctest::Approx(wave.pressure).epsilon(1e-14)); // round-off
  CHECK(b.velocity == doctest::Approx(wave.velocity).epsilon(1e-13));
  CHECK(b.density == doctest::Approx(wave.density).epsilon(1e-14));
}

TEST_CASE("an open end takes its density from the side the gas comes from")
{
  const Primitive hot{0.9, 0.0, 0.99e5}; // lower pressure: inflow
  const Primitive hot_out{0.9, 0.0, 1.01e5};

  const Primitive in = open_end_state(air, outside, hot, 0.0);
  const Primitive out = open_end_state(air, outside, hot_out, 0.0);

  CHECK(in.velocity > 0.0);
  CHECK(in.density == doctest::Approx(1.3 * (1.0 + (in.pressure - 1e5) / 1.4e5)).epsilon(1e-14));
  CHECK(out.velocity < 0.0);
  CHECK(out.density ==
        doctest::Approx(0.9 * (1.0 + (out.pressure - 1.01e5) / 1.414e5)).epsilon(1e-14));
}

TEST_CASE("a closed end lets no mass and at rest no energy through")
{
  const Primitive q{1.3, 5.0, 1e5};

  const Flux fixed = left_end_flux(air, LeftEnd::closed, outside, q, 0.0);
  const Flux moving = left_end_flux(air, LeftEnd::closed, outside, q, 5.0);

  CHECK(fixed.mass == 0.0);
  CHECK(fixed.energy == 0.0);
  CHECK(fixed.momentum == doctest::Approx(1e5 - impedance(air, q) * 5.0).epsilon(1e-15));
  CHECK(moving.momentum == 1e5); // moves with the gas
  CHECK(moving.energy == 5e5);
}
