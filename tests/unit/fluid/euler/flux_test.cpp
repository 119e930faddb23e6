// Numerical fluxes: consistency, exact contact waves, moving faces, and the same bits for one face and for several at a
// time.
#include "euler/flux.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

using namespace mullion::euler;

namespace {

constexpr Gas air{1.4};

using Faces = std::vector<FaceStates<2, double>>;
using FluxOf = Values<2> (*)(const Gas&, const FaceStates<2, double>&);
Values<2> hllc(const Gas& gas, const FaceStates<2, double>& face) { return hllc_flux<2, double>(gas, face); }
Values<2> roe(const Gas& gas, const FaceStates<2, double>& face) { return roe_flux<2, double>(gas, face); }

/// Random states and faces, every wave pattern among them.
Faces random_faces(std::size_t n)
{
  Faces faces(n);
  std::mt19937_64 random(11);
  const auto between = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(random() >> 11) / 9007199254740992.0;
  };
  for (auto& face : faces) {
    for (auto* side : {&face.left, &face.right})
      *side = {between(0.1, 2.0), between(-3.0, 3.0), between(-3.0, 3.0), between(0.1, 2.0)};
    const double angle = between(0.0, 6.28);
    face.normal = {std::cos(angle), std::sin(angle)};
    face.area = between(0.5, 2.0);
    face.speed = between(-1.0, 1.0);
  }
  return faces;
}

} // namespace

TEST_CASE("between equal states each flux is the gas's own")
{
  for (const FluxOf flux_of : {hllc, roe})
    for (auto face : random_faces(64)) {
      face.right = face.left;

      const auto flux = flux_of(air, face);

      const auto exact = physical_flux<2>(air, face.left, face.normal.data(), face.speed);
      for (std::size_t v = 0; v < 4; ++v) // 1e-13: round-off of numbers up to 20
        CHECK(flux[v] == doctest::Approx(exact[v] * face.area).epsilon(1e-13).scale(10.0));
    }
}

TEST_CASE("a contact that moves with the face passes nothing but pressure")
{
  for (const FluxOf flux_of : {hllc, roe})
    for (auto face : random_faces(16)) {
      const auto [nx, ny] = face.normal;
      face.right[3] = face.left[3];
      for (auto* side : {&face.left, &face.right}) { // slipping along each other as well
        const double along = (*side)[1];
        (*side)[1] = face.speed * nx - along * ny;
        (*side)[2] = face.speed * ny + along * nx;
      }

      const auto flux = flux_of(air, face);

      const double push = face.left[3] * face.area;
      CHECK(std::abs(flux[0]) < 1e-14); // round-off of u . n - s
      CHECK(flux[1] == doctest::Approx(push * nx).epsilon(1e-13).scale(1.0));
      CHECK(flux[3] == doctest::Approx(push * face.speed).epsilon(1e-13).scale(1.0));
    }
}

TEST_CASE("an observer who moves along sees the same flux of mass and a flux of momentum that follows from it")
{
  for (const FluxOf flux_of : {hllc, roe})
    for (const auto& face : random_faces(128)) {
      auto seen = face;
      for (auto* side : {&seen.left, &seen.right}) {
        (*side)[1] += 0.7;
        (*side)[2] -= 0.4;
      }
      seen.speed += 0.7 * face.normal[0] - 0.4 * face.normal[1];

      const auto rest = flux_of(air, face), moved = flux_of(air, seen);

      CHECK(moved[0] == doctest::Approx(rest[0]).epsilon(1e-11).scale(10.0));
      CHECK(moved[1] == doctest::Approx(rest[1] + 0.7 * rest[0]).epsilon(1e-11).scale(10.0));
    }
}

TEST_CASE("several faces at a time have the bits of each by itself")
{
  const auto faces = random_faces(128);
  for (std::size_t first = 0; first < faces.size(); first += 4) {
    FaceStates<2, Lanes<4>> several;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& face = faces[first + i];
      for (std::size_t v = 0; v < 4; ++v) {
        several.left[v][i] = face.left[v];
        several.right[v][i] = face.right[v];
      }
      several.normal[0][i] = face.normal[0];
      several.normal[1][i] = face.normal[1];
      several.area[i] = face.area;
      several.speed[i] = face.speed;
    }

    const auto by_hllc = hllc_flux<2, Lanes<4>>(air, several), by_roe = roe_flux<2, Lanes<4>>(air, several);

    for (std::size_t i = 0; i < 4; ++i) {
      const auto alone_hllc = hllc(air, faces[first + i]), alone_roe = roe(air, faces[first + i]);
      for (std::size_t v = 0; v < 4; ++v) {
        const double hllc_lane = by_hllc[v][i], roe_lane = by_roe[v][i];
        CHECK(std::memcmp(&hllc_lane, &alone_hllc[v], sizeof(double)) == 0);
        CHECK(std::memcmp(&roe_lane, &alone_roe[v], sizeof(double)) == 0);
      }
    }
  }
}
