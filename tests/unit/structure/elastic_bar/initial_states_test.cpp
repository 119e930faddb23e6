// Initial states of the bar.
#include "elastic_bar/initial_states.hpp"

#include "support/kernel_storage.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::elastic_bar;
using mullion::testing::BarMotion;

TEST_CASE("a bar at rest has only the acceleration of its load")
{
  const Bar bar{.density = 10.0, .length = 1.0, .n_elements = 5}; // end mass 1 kg
  BarMotion motion(bar);
  motion.velocity[2] = 4.0;

  set_rest(bar, motion.view(), 7.0);

  CHECK(motion.displacement == std::vector<double>(6, 0.0));
  CHECK(motion.velocity == std::vector<double>(6, 0.0));
  CHECK(motion.acceleration == std::vector<double>{7.0, 0.0, 0.0, 0.0, 0.0, 0.0});
}

TEST_CASE("a mode of a clamped bar is a sine with the amplitude at the loaded end and exact zero "
          "at the clamp")
{
  const Bar bar{.density = 1.0, .youngs_modulus = 4.0, .length = 3.0, .n_elements = 6}; // c_s = 2
  BarMotion motion(bar);

  set_mode(bar, motion.view(), 0.01, 0.8, 0.0);

  for (std::size_t i = 0; i <= 6; ++i)
    CHECK(motion.displacement[i] ==
          doctest::Approx(0.01 * std::sin(0.4 * (3.0 - 0.5 * static_cast<double>(i))) /
                          std::sin(1.2)));
  CHECK(motion.displacement[6] == 0.0);
  CHECK(motion.velocity == std::vector<double>(7, 0.0));
}

TEST_CASE("a mode of a free bar is a cosine")
{
  const Bar bar{.density = 1.0,
                .youngs_modulus = 4.0,
                .length = 3.0,
                .n_elements = 6,
                .far_end = FarEnd::free};
  BarMotion motion(bar);

  set_mode(bar, motion.view(), 0.01, 0.8, 0.0);

  CHECK(motion.displacement[0] == doctest::Approx(0.01));
  CHECK(motion.displacement[6] == doctest::Approx(0.01 / std::cos(1.2)));
}

TEST_CASE("the end load that balances a mode keeps it moving as one: acceleration is -w^2 u up to "
          "the element error")
{
  const Bar bar{.density = 1.0, .youngs_modulus = 4.0, .length = 3.0, .n_elements = 300};
  const double k = 0.4;
  const double stress_load = 4.0 * k * 0.01 * std::cos(k * 3.0) / std::sin(k * 3.0); // -E u'(0)
  BarMotion motion(bar);

  set_mode(bar, motion.view(), 0.01, 0.8, stress_load);

  for (std::size_t i = 0; i < 300;
       ++i) // (k dx)^2 / 12 = 1.3e-6 inside; k dx / 3 tan-like at the loaded end
    CHECK(motion.acceleration[i] == doctest::Approx(-0.64 * motion.displacement[i]).epsilon(2e-3));
}
