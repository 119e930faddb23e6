// The kernels of the two probes: sampled functions, their loads, and measures of what is received.
#include "files/generators.hpp"
#include "files/read.hpp"
#include "probes/sampled_surface.hpp"
#include "surface/balance.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

using namespace mullion::probes;
namespace files = mullion::mesh_files;
namespace surface = mullion::surface;

namespace {

SampledSurface sampled_text(const std::string& text, bool is_reversed = false)
{
  const auto mesh = files::interface_of(files::read_or_generate(text), "");
  return sampled(surface::mesh_of_blocks(mesh.nodes, mesh.blocks), is_reversed);
}

Eigen::VectorXd along_normal(const Eigen::VectorXd&, const Eigen::VectorXd& normal) { return normal; }

constexpr double round_off = 1e-13; // of sums of some hundred terms around 1

} // namespace

TEST_CASE("loads of a polynomial of degree 5 are its exact integral, on lines, triangles and quadrilaterals")
{
  const SurfaceFunction degree_5 = [](const Eigen::VectorXd& x, const Eigen::VectorXd&) -> Eigen::VectorXd {
    return std::pow(x[0], 5) * Eigen::VectorXd::Ones(x.size());
  };
  for (const char* text : {"line:3", "rectangle:3x2,triangles,perturb=0.2", "rectangle:2x2,quads"}) {
    const auto loads = loads_of(sampled_text(text), degree_5);

    CAPTURE(text);
    CHECK(loads.row(0).sum() == doctest::Approx(1.0 / 6.0).epsilon(round_off)); // of x^5 over [0, 1]
  }
  // The load of the last node of three lines: integral of (3 x - 2) x^5 from 2/3 to 1.
  const auto primitive = [](double x) { return 3.0 * std::pow(x, 7) / 7.0 - 2.0 * std::pow(x, 6) / 6.0; };
  CHECK(loads_of(sampled_text("line:3"), degree_5)(1, 3) ==
        doctest::Approx(primitive(1.0) - primitive(2.0 / 3.0)).epsilon(round_off));
}

TEST_CASE("weights of the nodes sum to the area, whose halves and quarters they are on a regular mesh")
{
  const auto s = sampled_text("rectangle:2x2,quads");

  CHECK(s.weights[0] == doctest::Approx(1.0 / 16.0).epsilon(round_off));
  CHECK(s.weights[1] == doctest::Approx(1.0 / 8.0).epsilon(round_off));
  CHECK(s.weights[4] == doctest::Approx(1.0 / 4.0).epsilon(round_off));
}

TEST_CASE("normals go by the right hand, or against it")
{
  for (const bool is_reversed : {false, true}) {
    const double sign = is_reversed ? -1.0 : 1.0;
    const auto flat = sampled_text("rectangle:2x2,triangles", is_reversed), line = sampled_text("line:2", is_reversed);

    CHECK((on_faces(flat, along_normal).colwise() - Eigen::Vector3d(0.0, 0.0, sign)).norm() < round_off);
    CHECK((on_nodes(flat, along_normal).colwise() - Eigen::Vector3d(0.0, 0.0, sign)).norm() < round_off);
    CHECK((on_faces(line, along_normal).colwise() - Eigen::Vector2d(0.0, -sign)).norm() < round_off);
    CHECK(loads_of(flat, along_normal).row(2).sum() == doctest::Approx(sign).epsilon(round_off));
  }
  // On an arc the mean normal of a node between two equal lines is radial, exactly.
  const auto arc = sampled_text("arc:8,radius=2,angle=120");
  CHECK((on_nodes(arc, along_normal) - arc.nodal_normals).norm() == 0.0);
  for (Eigen::Index i = 1; i < 8; ++i)
    CHECK((arc.nodal_normals.col(i) - arc.mesh.nodes.col(i) / 2.0).norm() < round_off);
}

TEST_CASE("a pressure on a cap has the force of its rim's area")
{
  const auto cap = sampled_text("cap:4x12,quads,radius=2,angle=50");
  const double rim = 2.0 * std::sin(50.0 * std::numbers::pi / 180.0);
  const double area = 6.0 * rim * rim * std::sin(std::numbers::pi / 6.0); // of a regular polygon of 12 corners

  const auto sum = surface::resultant_of_loads(cap.mesh, loads_of(cap, along_normal));

  CHECK((sum.force - Eigen::Vector3d(0.0, 0.0, area)).norm() < round_off * area);
  CHECK(sum.moment.norm() < round_off * area); // symmetric about the axis
}

TEST_CASE("the power of a traction on a motion is the integral of their product")
{
  const auto s = sampled_text("line:4,from=0:0,to=2:0");
  const auto x = [](const Eigen::VectorXd& at, const Eigen::VectorXd&) -> Eigen::VectorXd {
    return Eigen::Vector2d(at[0], 0.0);
  };

  // On nodes: the integral of x^2 over [0, 2]. On faces: that of x times the centre of its line of 1/2.
  CHECK(power_of_traction(s, on_nodes(s, x), surface::Location::nodes, on_nodes(s, x)) ==
        doctest::Approx(8.0 / 3.0).epsilon(round_off));
  const double by_hand = 0.5 * (0.0625 + 0.5625 + 1.5625 + 3.0625);
  CHECK(power_of_traction(s, on_faces(s, x), surface::Location::faces, on_nodes(s, x)) ==
        doctest::Approx(by_hand).epsilon(round_off));
  // By loads: the same as on nodes, where both are linear.
  CHECK(surface::work_of(loads_of(s, x), on_nodes(s, x)) == doctest::Approx(8.0 / 3.0).epsilon(round_off));
}

TEST_CASE("the size of a nodal field is its mean over the surface and its largest, and errors are relative to it")
{
  const auto s = sampled_text("line:2");                        // weights 1/4, 1/2, 1/4
  const Field f = (Field(2, 3) << 3, 0, 0, 4, 0, 1).finished(); // |f| = 5, 0, 1

  const auto norms = norms_of(s, f);
  const auto relative = relative_error(s, 1.25 * f, f), absolute = relative_error(s, f, Field::Zero(2, 3));

  CHECK(norms.l2 == doctest::Approx(std::sqrt((25.0 + 1.0) / 4.0)).epsilon(round_off));
  CHECK(norms.max == 5.0);
  CHECK(relative.l2 == doctest::Approx(0.25).epsilon(round_off));
  CHECK(relative.max == doctest::Approx(0.25).epsilon(round_off));
  CHECK(absolute.l2 == norms.l2);
  CHECK(absolute.max == norms.max);
}

TEST_CASE("the loads of a constant traction, by the weights of their nodes, are that traction")
{
  const auto s = sampled_text("wing:4x5,quads,sweep=20,twist=10,camber=0.1,tip=0.4");
  const SurfaceFunction constant = [](const Eigen::VectorXd&, const Eigen::VectorXd&) -> Eigen::VectorXd {
    return Eigen::Vector3d(1.0, -2.0, 0.5);
  };

  const auto traction = per_weight(s, loads_of(s, constant));

  CHECK((traction.colwise() - Eigen::Vector3d(1.0, -2.0, 0.5)).norm() < round_off);
}
