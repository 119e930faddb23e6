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
  balance.source_work = balance.work_scale = 2.0;
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

TEST_CASE("a gap is a warning, then an error, in faces of the coarser mesh, and names the places")
{
  const auto at = [](double y) { return along([=](double s) { return Eigen::Vector2d(s, y); }, 10); };
  const auto source = along(flat, 20);
  const auto verdict = [&](double y) { return judge(source, at(y), overlay(source, at(y)).report, {}); };
  const auto everywhere = [](const std::string& gap) { // the first of equal ones come first
    return "; 20 source faces (face 0 at (0.025, 0) m: " + gap + " m; face 1 at (0.075, 0) m: " + gap +
           " m; face 2 at (0.125, 0) m: " + gap + " m; …)";
  };

  CHECK_FALSE(says(verdict(0.04).warnings, "apart"));
  CHECK(says(verdict(0.06).warnings,
             "the surfaces are up to 0.06 m apart, 0.6 faces; above 0.5 faces the transfer loses accuracy" +
                 everywhere("0.06")));
  CHECK(verdict(0.19).errors.empty());
  CHECK(verdict(0.21).errors ==
        std::vector{"the surfaces are up to 0.21 m apart, 2.1 faces; at most 2 faces are sensible" +
                    everywhere("0.21") + ". Are both in the same coordinates?"});
}

TEST_CASE("of a dent the deepest faces are named first, with their depth, and only those beyond the tolerance count")
{
  const auto source = along([](double s) { return Eigen::Vector2d(s, std::abs(s - 0.4) < 0.05 ? 0.07 : 0.0); }, 10);
  const auto target = along(flat, 10);

  const auto verdict = judge(source, target, overlay(source, target).report, {});

  // Node 4 stands out by 0.07 m, 0.65 of the faces' mean size with the two long ones; no other node does.
  CHECK(
      says(verdict.warnings, "2 source faces (face 3 at (0.35, 0.035) m: 0.07 m; face 4 at (0.45, 0.035) m: 0.07 m)"));
}

TEST_CASE("an overhang is a warning that names faces, and an error if it is long")
{
  const auto target = along(flat, 10);
  const auto verdict = [&](double length) {
    const auto source = along([=](double s) { return flat(length * s); }, 10);
    return judge(source, target, overlay(source, target).report, {});
  };

  CHECK(joined(verdict(1.04)) ==
        "warning: the source reaches 0.04 m beyond the target's end; the force there goes to the end node, whose "
        "traction is wrong; 1 source face (face 9 at (0.988, 0) m: 0.04 m)\n"
        "warning: source faces are covered between 0.615385 and 1 times; 1 source face (face 9 at (0.988, 0) m: "
        "0.615385 times)\n"
        "warning: 1 source node (node 10 at (1.04, 0) m) not facing the target; places on it are interpolated\n"
        "warning: 1 corner or end of the source (node 10 at (1.04, 0) m) without a partner on the target\n"
        "warning: 1 corner or end of the target (node 10 at (1, 0) m) without a partner on the source\n");
  const auto far = verdict(1.3); // faces of 0.13: 7 holds the end, 8 reaches 0.17 beyond it, 9 reaches 0.3
  REQUIRE(far.errors.size() == 1);
  CHECK(far.errors[0] == "the source reaches 0.3 m beyond the target's end, 2.30769 faces; at most 0.5 of a face is "
                         "sensible; 2 source faces (face 9 at (1.235, 0) m: 0.3 m; face 8 at (1.105, 0) m: 0.17 m)");
  CHECK(says(far.warnings, "2 source faces (face 8 at (1.105, 0) m; face 9 at (1.235, 0) m) without a counterpart; "
                           "23.0769 % of the source is not covered"));
  CHECK(says(far.warnings, "the source measures 1.3 m, the target 1"));
  CHECK(
      says(verdict(0.7).warnings, "3 target nodes (node 8 at (0.8, 0) m; node 9 at (0.9, 0) m; node 10 at (1, 0) m)"));
}

TEST_CASE("too little coverage is an error that names faces, those without a counterpart or else the least covered")
{
  const auto source = along(flat, 4), target = along(flat, 4);
  OverlayReport without, little;
  without.covered_fraction = little.covered_fraction = 0.25;
  without.uncovered_faces.add(1), without.uncovered_faces.add(2), without.uncovered_faces.add(3);
  little.fit = {{.coverage = 0.1}, {.coverage = 0.4}, {.coverage = 0.3}, {.coverage = 0.2}};

  CHECK(judge(source, target, without, {}).errors ==
        std::vector<std::string>{"only 25 % of the source has a counterpart, less than 50 %; without one: 3 source "
                                 "faces (face 1 at (0.375, 0) m; face 2 at (0.625, 0) m; face 3 at (0.875, 0) m). Are "
                                 "both in the same unit, and do they face each other?"});
  CHECK(judge(source, target, little, {}).errors ==
        std::vector<std::string>{"only 25 % of the source has a counterpart, less than 50 %; 4 source faces (face 0 at "
                                 "(0.125, 0) m: 0.1 times; face 3 at (0.875, 0) m: 0.2 times; face 2 at (0.625, 0) m: "
                                 "0.3 times; …). Are both in the same unit, and do they face each other?"});
}

TEST_CASE("faces that are covered more than once are named")
{
  const auto source = along(flat, 4), target = along(flat, 4);
  OverlayReport report;
  report.max_coverage = 2.0;
  report.fit = {{.coverage = 1.0}, {.coverage = 1.5}, {.coverage = 2.0}, {.coverage = 1.05}};

  CHECK(joined(judge(source, target, report, {})) ==
        "warning: source faces are covered between 1 and 2 times; 2 source faces (face 2 at (0.625, 0) m: 2 times; "
        "face 1 at (0.375, 0) m: 1.5 times)\n");
}

TEST_CASE("a force or work that is promised and lost is told with both numbers")
{
  Balance balance;
  balance.source.force = {10.0, 0.0, 0.0};
  balance.source.force_scale = 10.0;
  balance.target.force = {9.0, 0.0, 0.0};
  balance.source_work = 2.0;
  balance.target_work = balance.work_scale = 2.5;
  const std::string force = "the target receives the force (9, 0, 0) N, the source gives (10, 0, 0) N: relative defect "
                            "0.1, at most 1e-10 is round-off";
  const std::string work = "the loads do the work 2.5 on the target and 2 on the source: relative defect 0.2, at most "
                           "1e-10 is round-off";

  CHECK(complaints_about(balance, {}, {}) == std::vector{force});
  CHECK(complaints_about(balance, {.force = true, .work = true}, {}) == std::vector{force, work});
  CHECK(complaints_about(balance, {.force = false, .work = false}, {}).empty());
  balance.target.force.x() = std::nan("");
  CHECK(complaints_about(balance, {}, {}).size() == 1);
  balance.target = balance.source;
  balance.target_work = balance.source_work;
  CHECK(complaints_about(balance, {.force = true, .work = true}, {}).empty());
}

TEST_CASE("work that cancels is measured by what acts, not by what is left of it")
{
  const Field loads{{1.0, -1.0}, {0.0, 0.0}}, motion{{2.0, 2.0}, {5.0, -5.0}};

  CHECK(work_of(loads, motion) == 0.0);
  CHECK(work_scale_of(loads, motion) == doctest::Approx(2.0 * std::sqrt(29.0)).epsilon(1e-15));
}

TEST_CASE("where force gets lost is named: nodes and faces that do not arrive whole")
{
  const auto source = along(flat, 4), target = along(flat, 3);
  const auto points = refined(source, target).points;
  Operator nodal = load_operator(source, target, points, Location::nodes);
  Operator facial = load_operator(source, target, points, Location::faces);

  CHECK(places_of_lost_force(source, nodal, Location::nodes, {}) == "");
  CHECK(places_of_lost_force(source, facial, Location::faces, {}) == "");
  nodal.coeffRef(0, 1) *= 1.0 + 1e-8;
  facial.coeffRef(2, 3) = 0.0;
  CHECK(places_of_lost_force(source, nodal, Location::nodes, {}) == "1 source node (node 1 at (0.25, 0) m)");
  CHECK(places_of_lost_force(source, facial, Location::faces, {}) == "1 source face (face 3 at (0.875, 0) m)");
}
