// The geometric conservation law: a uniform flow stays uniform, however the nodes move, on every kind of cell.
#include "support/euler_flow.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <random>
#include <string>

using namespace mullion::euler;
using namespace mullion::testing;

namespace {

const Values<2> oblique = {1.3, 80.0, 60.0, 3.039e5};
const Values<3> oblique_3d = {1.3, 80.0, 60.0, -40.0, 3.039e5};

/// Twenty steps in which each node goes to a new random place about its own; boundary nodes as well.
template <int D>
double worst_deviation(const std::string& mesh, const Values<D>& state, const Scheme<D>& scheme, double part, double h)
{
  std::vector<Side<D>> sides;
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    if (D == 3 || name[0] != 'z') sides.push_back({name, far_field<D>(state)});
  EulerFlow<D> flow(mesh, sides, scheme);
  flow.start([&](const Vec<D>&) { return state; });
  std::mt19937_64 random(7);
  const auto shaken = [&] { return (static_cast<double>(random() >> 11) / 9007199254740992.0 - 0.5) * 2.0 * part * h; };
  const double dt = flow.stable_step(0.3);
  double worst = 0.0;
  for (int k = 0; k < 20; ++k) {
    typename EulerFlow<D>::Nodes v = flow.source.nodes - flow.nodes;
    for (Eigen::Index i = 0; i < v.size(); ++i) v.data()[i] = (v.data()[i] + shaken()) / dt;
    flow.step(dt, v);
    worst = std::max(worst, deviation(flow, state));
  }
  return worst;
}

} // namespace

// 1e-12: round-off of some hundred additions of numbers that cancel to a hundredth of their size. A scheme with the
// planes of the wrong instant is off by 4e-3 and more.
TEST_CASE("a uniform flow stays uniform on randomly moving quadrilaterals and triangles")
{
  for (const auto integrator : {Integrator::jameson, Integrator::rk4})
    for (const auto flux : {Flux::hllc, Flux::roe})
      for (const char* mesh : {"box:8x8", "box:8x8,triangles"}) {
        Scheme<2> scheme;
        scheme.integrator = integrator;
        scheme.flux = flux;
        scheme.limiter.limiter = flux == Flux::roe ? Limiter::barth_jespersen : Limiter::none;
        CAPTURE(mesh);
        CHECK(worst_deviation<2>(mesh, oblique, scheme, 0.15, 0.125) < 1e-12);
      }
}

TEST_CASE("a uniform flow stays uniform on randomly moving hexahedra and tetrahedra")
{
  for (const auto integrator : {Integrator::jameson, Integrator::rk4})
    for (const char* mesh : {"box:3x3x3", "box:3x3x3,tets"}) {
      Scheme<3> scheme;
      scheme.integrator = integrator;
      CAPTURE(mesh);
      CHECK(worst_deviation<3>(mesh, oblique_3d, scheme, 0.06, 1.0 / 3.0) < 1e-12);
    }
}
