// Resultants and defects by hand, and what a user is told.
#include "surface/balance.hpp"

#include "support/surface_pairs.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

bool says(const std::vector<std::string>& messages, const std::string& words)
{
  return std::any_of(messages.begin(), messages.end(),
                     [&](const auto& m) { return m.find(words) != std::string::npos; });
}

std::string joined(const Verdict& verdict)
{
  std::string all;
  for (const auto& m : verdict.warnings) all += "warning: " + m + "\n";
  for (const auto& m : verdict.errors) all += "error: " + m + "\n";
  return all;
}

} // namespace

TEST_CASE("force and moment of loads are those by hand")
{
  const auto mesh = polyline({{1.0, 0.0}, {1.0, 2.0}});

  const auto sum = resultant_of_loads(mesh, Field{{3.0, -1.0}, {0.0, 4.0}});

  CHECK(sum.force == Point(2, 4, 0));
  CHECK(sum.moment == Point(0, 0, 1 * 0 - 0 * 3 + 1 * 4 - 2 * -1)); // x F_y - y F_x
  CHECK(sum.force_scale == doctest::Approx(3.0 + std::sqrt(17.0)).epsilon(1e-15));
  CHECK(sum.moment_scale == doctest::Approx(3.0 + std::sqrt(17.0)).epsilon(1e-15)); // both one from the mean node
}

TEST_CASE("force and moment of a traction are its integrals, and those of its consistent loads")
{
  const auto mesh = polyline({{0.0, 0.0}, {0.0, 3.0}});
  const Field traction{{2.0, 2.0}, {0.0, 6.0}}; // t_y = 2 y

  const auto sum = resultant_of_traction(mesh, traction, Location::nodes);
  const auto loads = resultant_of_loads(mesh, apply(native_mass(mesh), traction));
  const auto facial = resultant_of_traction(mesh, Field{{2.0}, {1.0}}, Location::faces);

  CHECK((sum.force - Point(6, 9, 0)).norm() < 1e-14);
  CHECK((sum.moment - Point(0, 0, -9)).norm() < 1e-14); // - integral of y 2 dy
  CHECK((loads.force - sum.force).norm() < 1e-14);
  CHECK((loads.moment - sum.moment).norm() < 1e-14);
  CHECK((facial.force - Point(6, 3, 0)).norm() < 1e-14);
  CHECK((facial.moment - Point(0, 0, -9)).norm() < 1e-14);
}

TEST_CASE("work is the sum of loads times motion")
{
  CHECK(work_of(Field{{1.0, 2.0}, {3.0, 4.0}}, Field{{5.0, 6.0}, {7.0, 8.0}}) == 5.0 + 12.0 + 21.0 + 32.0);
}

TEST_CASE("defects are relative to what acts, not to what is left of it")
{
  Balance balance;
  balance.source.force_scale = 10.0; // cancels to a zero force
  balance.target.force = {1e-3, 0.0, 0.0};
  balance.source_work = 2.0;
  balance.target_work = 1.0;

  const auto defects = defects_of(balance);

  CHECK(defects.force == doctest::Approx(1e-4).epsilon(1e-15));
  CHECK(defects.work == 0.5);
  CHECK(defects.moment == 0.0);
  balance.source.force_scale = 0.0;
  CHECK(std::isinf(defects_of(balance).force));
}

TEST_CASE("surfaces that fit are not remarked upon")
{
  const auto source = along(flat, 8), target = along(flat, 7);

  CHECK(joined(judge(source, target, overlay(source, target).report, {})) == "");
}

TEST_CASE("a gap is a warning, then an error, in faces of the coarser mesh")
{
  const auto at = [](double y) { return along([=](double s) { return Eigen::Vector2d(s, y); }, 10); };
  const auto source = along(flat, 20);
  const auto verdict = [&](double y) { return judge(source, at(y), overlay(source, at(y)).report, {}); };

  CHECK_FALSE(says(verdict(0.04).warnings, "apart"));
  CHECK(says(verdict(0.06).warnings, "up to 0.06 m apart, 0.6 faces"));
  CHECK(verdict(0.19).errors.empty());
  CHECK(says(verdict(0.21).errors, "up to 0.21 m apart, 2.1 faces; at most 2"));
}

TEST_CASE("an overhang is a warning that names faces, and an error if it is long")
{
  const auto target = along(flat, 10);
  const auto verdict = [&](double length) {
    const auto source = along([=](double s) { return flat(length * s); }, 10);
    return judge(source, target, overlay(source, target).report, {});
  };

  CHECK(says(verdict(1.04).warnings, "reaches 0.04 m beyond the target's end"));
  CHECK(says(verdict(1.04).warnings, "1 source face (face 9 at (0.988, 0) m) in part"));
  CHECK(verdict(1.04).errors.empty());
  CHECK(says(verdict(1.3).errors, "reaches 0.3 m beyond the target's end"));
  CHECK(says(verdict(1.3).warnings, "2 source faces (face 8 at (1.105, 0) m; face 9 at (1.235, 0) m)"));
  CHECK(says(verdict(1.3).warnings, "the source measures 1.3 m, the target 1"));
  CHECK(
      says(verdict(0.7).warnings, "3 target nodes (node 8 at (0.8, 0) m; node 9 at (0.9, 0) m; node 10 at (1, 0) m)"));
}

TEST_CASE("a force or work that is lost is an error with both numbers")
{
  Balance balance;
  balance.source.force = {10.0, 0.0, 0.0};
  balance.source.force_scale = 10.0;
  balance.target.force = {9.0, 0.0, 0.0};
  balance.source_work = 2.0;
  balance.target_work = 2.5;

  CHECK(says(judge(balance, false, {}).errors, "receives the force (9, 0, 0) N, the source gives (10, 0, 0) N"));
  CHECK(judge(balance, false, {}).errors.size() == 1);
  CHECK(says(judge(balance, true, {}).errors, "2.5 on the target and 2 on the source: relative defect 0.2"));
  balance.target = balance.source;
  balance.target_work = balance.source_work;
  CHECK(joined(judge(balance, true, {})) == "");
}
