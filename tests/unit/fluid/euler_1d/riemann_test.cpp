// The HLLC flux relative to a moving face: consistency, invariances and the acoustic limit.
#include "euler_1d/riemann.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

using namespace mullion::euler_1d;

namespace {

constexpr Gas air{1.4};
constexpr double c0 = 328.165; // sound speed of the state below [m/s], where only its size matters

void check_flux(const Flux& found, const Flux& expected, double tolerance)
{
  CHECK(std::abs(found.mass - expected.mass) <= tolerance * 1.3 * c0);
  CHECK(std::abs(found.momentum - expected.momentum) <= tolerance * 1e5);
  CHECK(std::abs(found.energy - expected.energy) <= tolerance * 1e5 * c0);
}

} // namespace

TEST_CASE("HLLC of two equal states is the physical flux at any speed of flow and face")
{
  for (const double u : {-500.0, -20.0, 0.0, 3.0, 400.0})
    for (const double w : {-600.0, -350.0, -1.0, 0.0, 5.0, 340.0, 700.0}) {
      const Primitive q{1.3, u, 1e5};

      const Flux flux = hllc_flux(air, q, q, w);

      // a dozen operations on numbers a few times the scales
      check_flux(flux, physical_flux(air, q, w), 1e-14);
    }
}

TEST_CASE("HLLC lets no mass through a contact that moves with the face, only its pressure")
{
  const Primitive heavy{4.0, 12.0, 1e5};
  const Primitive light{1.3, 12.0, 1e5};

  const Flux flux = hllc_flux(air, heavy, light, 12.0);

  check_flux(flux, {0.0, 1e5, 1e5 * 12.0}, 1e-14); // round-off
}

TEST_CASE("HLLC sees the same waves from a moving observer")
{
  const Primitive left{1.5, 30.0, 1.3e5};
  const Primitive right{1.1, -40.0, 0.8e5};
  const double w = 10.0;
  const double observer = 50.0;
  const auto seen = [&](Primitive q) {
    q.velocity += observer;
    return q;
  };

  const Flux rest = hllc_flux(air, left, right, w);
  const Flux moved = hllc_flux(air, seen(left), seen(right), w + observer);

  // exact relations of the change of frame; the energies differ by round-off of rho E
  check_flux(moved,
             {rest.mass, rest.momentum + observer * rest.mass,
              rest.energy + observer * rest.momentum + 0.5 * observer * observer * rest.mass},
             1e-13);
}

TEST_CASE("HLLC of mirrored states is the mirrored flux")
{
  const Primitive left{1.5, 30.0, 1.3e5};
  const Primitive right{1.1, -40.0, 0.8e5};
  const auto mirror = [](const Primitive& q) {
    return Primitive{q.density, -q.velocity, q.pressure};
  };

  for (const double w : {-400.0, -30.0, 0.0, 25.0, 400.0}) {
    const Flux flux = hllc_flux(air, left, right, w);
    const Flux mirrored = hllc_flux(air, mirror(right), mirror(left), -w);

    check_flux(mirrored, {-flux.mass, flux.momentum, -flux.energy}, 1e-14); // round-off
  }
}

TEST_CASE("HLLC upwinds when the face outruns all waves")
{
  const Primitive left{1.5, 30.0, 1.3e5};
  const Primitive right{1.1, -40.0, 0.8e5};

  check_flux(hllc_flux(air, left, right, -600.0), physical_flux(air, left, -600.0), 0.0);
  check_flux(hllc_flux(air, left, right, 600.0), physical_flux(air, right, 600.0), 0.0);
}

TEST_CASE("HLLC tends to the acoustic solution for weak jumps")
{
  // Linear acoustics: p* = (p_L + p_R) / 2 + z (u_L - u_R) / 2, read on a face that moves with u*.
  const Primitive base{1.3, 0.0, 1e5};
  const double z = impedance(air, base);
  const auto error = [&](double eps) {
    const double dp = eps * 1e5;
    const double du = 0.7 * eps * 1e5 / z;
    const Primitive left{1.3 * (1.0 + eps / 1.4), du, 1e5 + dp};
    const double u_star = 0.5 * du + 0.5 * dp / z;
    const double p_star = 1e5 + 0.5 * dp + 0.5 * z * du;
    return std::abs(hllc_flux(air, left, base, u_star).momentum - p_star);
  };

  CHECK(error(1e-4) < 1e-8 * 1e5); // second order in the jump, with a factor below one
  CHECK(error(1e-2) >
        50.0 * error(1e-3)); // and it is second order: 100, less what the next order takes
}
