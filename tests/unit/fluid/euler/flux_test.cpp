// Numerical fluxes: consistency, exact contact waves, moving faces, and the same bits with every width of vectors.
#include "euler/flux.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>

using namespace mullion::euler;

namespace {

constexpr Gas air{1.4};

/// Random states and faces, every wave pattern among them.
std::unique_ptr<FaceBatch<2>> random_faces(std::size_t n)
{
  auto batch = std::make_unique<FaceBatch<2>>();
  std::mt19937_64 random(11);
  const auto between = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(random() >> 11) / 9007199254740992.0;
  };
  for (std::size_t k = 0; k < n; ++k) {
    for (auto* side : {&batch->left, &batch->right}) {
      (*side)[0][k] = between(0.1, 2.0);
      (*side)[1][k] = between(-3.0, 3.0);
      (*side)[2][k] = between(-3.0, 3.0);
      (*side)[3][k] = between(0.1, 2.0);
    }
    const double angle = between(0.0, 6.28);
    batch->normal[0][k] = std::cos(angle);
    batch->normal[1][k] = std::sin(angle);
    batch->area[k] = between(0.5, 2.0);
    batch->speed[k] = between(-1.0, 1.0);
  }
  return batch;
}

using Fluxes = void (*)(const Gas&, FaceBatch<2>&, std::size_t);
void hllc(const Gas& gas, FaceBatch<2>& batch, std::size_t n) { hllc_fluxes<2>(gas, batch, n); }

} // namespace

TEST_CASE("between equal states each flux is the gas's own")
{
  for (const Fluxes fluxes : {Fluxes(hllc), Fluxes(roe_fluxes<2>)}) {
    auto batch = random_faces(64);
    batch->right = batch->left;

    fluxes(air, *batch, 64);

    for (std::size_t k = 0; k < 64; ++k) {
      const Values<2> w = {batch->left[0][k], batch->left[1][k], batch->left[2][k], batch->left[3][k]};
      const double n[] = {batch->normal[0][k], batch->normal[1][k]};
      const auto exact = physical_flux<2>(air, w, n, batch->speed[k]);
      for (std::size_t v = 0; v < 4; ++v) // 1e-13: round-off of numbers up to 20
        CHECK(batch->flux[v][k] == doctest::Approx(exact[v] * batch->area[k]).epsilon(1e-13).scale(10.0));
    }
  }
}

TEST_CASE("a contact that moves with the face passes nothing but pressure")
{
  for (const Fluxes fluxes : {Fluxes(hllc), Fluxes(roe_fluxes<2>)}) {
    auto batch = random_faces(16);
    for (std::size_t k = 0; k < 16; ++k) {
      const double nx = batch->normal[0][k], ny = batch->normal[1][k], s = batch->speed[k];
      batch->right[3][k] = batch->left[3][k];
      for (auto* side : {&batch->left, &batch->right}) { // slipping along each other as well
        const double along = (*side)[1][k];
        (*side)[1][k] = s * nx - along * ny;
        (*side)[2][k] = s * ny + along * nx;
      }
    }

    fluxes(air, *batch, 16);

    for (std::size_t k = 0; k < 16; ++k) {
      const double push = batch->left[3][k] * batch->area[k];
      CHECK(std::abs(batch->flux[0][k]) < 1e-14); // round-off of u . n - s
      CHECK(batch->flux[1][k] == doctest::Approx(push * batch->normal[0][k]).epsilon(1e-13).scale(1.0));
      CHECK(batch->flux[3][k] == doctest::Approx(push * batch->speed[k]).epsilon(1e-13).scale(1.0));
    }
  }
}

TEST_CASE("an observer who moves along sees the same flux of mass and a flux of momentum that follows from it")
{
  for (const Fluxes fluxes : {Fluxes(hllc), Fluxes(roe_fluxes<2>)}) {
    auto rest = random_faces(128), moved = random_faces(128);
    for (std::size_t k = 0; k < 128; ++k) {
      for (auto* side : {&moved->left, &moved->right}) {
        (*side)[1][k] += 0.7;
        (*side)[2][k] -= 0.4;
      }
      moved->speed[k] += 0.7 * moved->normal[0][k] - 0.4 * moved->normal[1][k];
    }

    fluxes(air, *rest, 128);
    fluxes(air, *moved, 128);

    for (std::size_t k = 0; k < 128; ++k) {
      CHECK(moved->flux[0][k] == doctest::Approx(rest->flux[0][k]).epsilon(1e-11).scale(10.0));
      CHECK(moved->flux[1][k] == doctest::Approx(rest->flux[1][k] + 0.7 * rest->flux[0][k]).epsilon(1e-11).scale(10.0));
    }
  }
}

TEST_CASE("HLLC has the same bits with the widest vectors of this processor as with those of every processor")
{
  auto wide = random_faces(128), narrow = random_faces(128);

  hllc_fluxes<2>(air, *wide, 127, Width::best); // 127: not a multiple of any width
  hllc_fluxes<2>(air, *narrow, 127, Width::baseline);

  for (std::size_t v = 0; v < 4; ++v)
    CHECK(std::memcmp(wide->flux[v].data(), narrow->flux[v].data(), 127 * sizeof(double)) == 0);
}
