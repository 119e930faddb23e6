// Generated meshes: places, orientation, groups, and the texts of case files.
#include "files/file_error.hpp"
#include "files/generator_text.hpp"
#include "files/generators.hpp"
#include "files/read.hpp"
#include "support/mesh_samples.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <unistd.h>

using namespace mullion::mesh_files;
using namespace mullion::testing;

namespace {

/// All elements as a group.
Group all(const MeshFile& mesh)
{
  Group group;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (Eigen::Index e = 0; e < mesh.blocks[b].connectivity.cols(); ++e)
      group.elements.push_back({static_cast<Index>(b), static_cast<Index>(e)});
  return group;
}

std::string complaint(const std::string& text)
{
  try {
    generated(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

double smallest_tet(const MeshFile& mesh)
{
  double smallest = 1e300;
  const auto tets = elements_of(mesh, Shape::tetrahedron4);
  for (const auto& tet : tets.colwise()) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = mesh.nodes.col(tet[k + 1]) - mesh.nodes.col(tet[0]);
    smallest = std::min(smallest, edges.determinant() / 6.0);
  }
  return smallest;
}

constexpr double round_off = 1e-14; // sums of a few hundred numbers around 1

} // namespace

TEST_CASE("a line has equal parts and ends where it should")
{
  const auto mesh = line(4, Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(3.0, 4.0));

  CHECK(mesh.dimension == 2);
  CHECK(mesh.nodes.col(0) == Eigen::Vector2d(1.0, 0.0));
  CHECK(mesh.nodes.col(1) == Eigen::Vector2d(1.5, 1.0));
  CHECK(mesh.nodes.col(4) == Eigen::Vector2d(3.0, 4.0));
  CHECK(elements_of(mesh, Shape::line2).col(3) == Eigen::Vector2i(3, 4));
}

TEST_CASE("an arc lies on its circle, and its normals point outward")
{
  const auto mesh = arc(6, 2.0, 0.0, 0.5 * std::numbers::pi, {1.0, -1.0});

  for (const auto& x : mesh.nodes.colwise())
    CHECK((x - Eigen::Vector2d(1.0, -1.0)).norm() == doctest::Approx(2.0).epsilon(round_off));
  // The chord from (3, -1) to (1, 1), turned to the right.
  CHECK((directed_area(mesh, all(mesh)) - Eigen::Vector3d(2.0, 2.0, 0.0)).norm() < round_off);
}

TEST_CASE("a rectangle keeps its area and its edges however it is perturbed, and the seed decides")
{
  for (const auto cells : {Cells::quads, Cells::triangles}) {
    const auto mesh = rectangle({32, 24, cells, {0.2, 3}}, 2.0, 1.0);

    CHECK((directed_area(mesh, all(mesh)) - Eigen::Vector3d(0.0, 0.0, 2.0)).norm() < 100 * round_off);
    CHECK(mesh.nodes.row(0).minCoeff() == 0.0);
    CHECK(mesh.nodes.row(0).maxCoeff() == 2.0);
    CHECK((mesh.nodes - rectangle({32, 24, cells, {}}, 2.0, 1.0).nodes).norm() > 0.1);
    CHECK(is_same(mesh, rectangle({32, 24, cells, {0.2, 3}}, 2.0, 1.0)));
    CHECK(!is_same(mesh, rectangle({32, 24, cells, {0.2, 4}}, 2.0, 1.0)));
  }
}

TEST_CASE("a spherical cap lies on its sphere, and its directed area is that of its rim")
{
  const double angle = 1.2;
  for (const auto cells : {Cells::quads, Cells::triangles}) {
    const auto mesh = spherical_cap(5, 12, cells, 3.0, angle);

    CHECK((mesh.nodes.colwise().norm().array() - 3.0).abs().maxCoeff() < 4 * round_off);
    // By Stokes: the area of the regular polygon of 12 corners on the rim.
    const double rim = 3.0 * std::sin(angle);
    const double polygon = 0.5 * 12 * rim * rim * std::sin(2.0 * std::numbers::pi / 12);
    CHECK((directed_area(mesh, all(mesh)) - Eigen::Vector3d(0.0, 0.0, polygon)).norm() < 100 * round_off);
  }
}

TEST_CASE("a wing has its corners where span, chords, sweep and twist put them")
{
  const double sweep = 0.3, twist = 0.1;
  const auto mesh = wing_panel({2, 3, Cells::quads, {}}, {4.0, 1.0, 0.5, sweep, twist, 0.0});

  const double back = 4.0 * std::tan(sweep), quarter = back + 0.125;
  CHECK(mesh.nodes.col(0) == Eigen::Vector3d(0.0, 0.0, 0.0));
  CHECK(mesh.nodes.col(2) == Eigen::Vector3d(1.0, 0.0, 0.0));
  const Eigen::Vector3d nose(quarter - 0.125 * std::cos(twist), 4.0, 0.125 * std::sin(twist)); // up
  const Eigen::Vector3d tail(quarter + 0.375 * std::cos(twist), 4.0, -0.375 * std::sin(twist));
  CHECK((mesh.nodes.col(9) - nose).norm() < round_off);
  CHECK((mesh.nodes.col(11) - tail).norm() < round_off);
}

TEST_CASE("the sides of a box point outward, and close it")
{
  const auto flat = box_2d({3, 4, Cells::triangles, {0.2, 1}}, {2.0, 3.0}, {1.0, 1.0});
  CHECK((directed_area(flat, find_group(flat, "x_max")) - Eigen::Vector3d(3.0, 0.0, 0.0)).norm() < round_off);
  CHECK((directed_area(flat, find_group(flat, "y_min")) - Eigen::Vector3d(0.0, -2.0, 0.0)).norm() < round_off);
  CHECK((directed_area(flat, find_group(flat, "x_min")) + Eigen::Vector3d(3.0, 0.0, 0.0)).norm() < round_off);
  CHECK((directed_area(flat, find_group(flat, "y_max")) + Eigen::Vector3d(0.0, -2.0, 0.0)).norm() < round_off);
  for (const auto volumes : {Volumes::hexes, Volumes::tets}) {
    const auto box = box_3d({3, 2, 2}, volumes, {1.0, 2.0, 3.0}, {0.0, 0.0, -1.0}, {0.15, 1});

    const Eigen::Vector3d area(6.0, 3.0, 2.0);
    for (int k = 0; k < 3; ++k) {
      const std::string axis = {"xyz"[k]};
      const Eigen::Vector3d expected = area[k] * Eigen::Vector3d::Unit(k);
      CHECK((directed_area(box, find_group(box, axis + "_max")) - expected).norm() < 10 * round_off);
      CHECK((directed_area(box, find_group(box, axis + "_min")) + expected).norm() < 10 * round_off);
    }
    CHECK(find_group(box, "volume").elements.size() == (volumes == Volumes::hexes ? 12 : 72));
  }
}

TEST_CASE("perturbed tetrahedra fill their box and none turns over")
{
  const auto mesh = box_3d({6, 6, 6}, Volumes::tets, {1.0, 1.0, 1.0}, {0, 0, 0}, {0.166, 9});

  CHECK(smallest_tet(mesh) > 0.0);
  CHECK(smallest_tet(mesh) < 1.0 / (6 * 216)); // the size without perturbation
}

TEST_CASE("texts of case files give the meshes of the functions")
{
  CHECK(is_same(generated("line:10,from=0:1,to=2:1"), line(10, Eigen::Vector2d(0, 1), Eigen::Vector2d(2, 1))));
  CHECK(is_same(generated("line:3"), line(3, Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0))));
  CHECK(is_same(generated("rectangle:32x24,triangles,perturb=0.2,seed=3"),
                rectangle({32, 24, Cells::triangles, {0.2, 3}}, 1.0, 1.0)));
  CHECK(is_same(generated("box:2x3,size=2x1,origin=1:1"), box_2d({2, 3, Cells::quads, {}}, {2, 1}, {1, 1})));
  CHECK(is_same(generated("box:2x3x1,tets"), box_3d({2, 3, 1}, Volumes::tets, {1, 1, 1})));
  CHECK(is_same(generated("cap:3x6,triangles,angle=180e-1"),
                spherical_cap(3, 6, Cells::triangles, 1.0, 18.0 * std::numbers::pi / 180.0)));
  CHECK(generated("wing:4x8,span=2,sweep=30,twist=-4,tip=0.5").nodes.row(1).maxCoeff() == 2.0);
  CHECK(generated("arc:4,angle=90").nodes.cols() == 5);
}

TEST_CASE("errors in a generator's text show it and say what would be right")
{
  CHECK(complaint("rectangle:3x3,triangels") == "mesh \"rectangle:3x3,triangels\": the option \"triangels\"; it takes "
                                                "alternating, delaunay, origin, perturb, quads, seed, size, triangles");
  CHECK(complaint("rectangle:3") == "mesh \"rectangle:3\": 1 numbers of cells; two, say 32x24");
  CHECK(complaint("rectangle:3x0") ==
        "mesh \"rectangle:3x0\": \"0\" as a number of cells; integers from 1 on, say 32x24");
  CHECK(complaint("box:3x3,perturb=0.3") ==
        "mesh \"box:3x3,perturb=0.3\": perturb = 0.3; it is at least 0 and below 0.25, or elements could turn over");
  CHECK(complaint("box:3x3,quads,triangles") ==
        "mesh \"box:3x3,quads,triangles\": both quads and triangles; one of them");
  CHECK(complaint("arc:3,radius=-1") == "mesh \"arc:3,radius=-1\": the radius of an arc is -1; it is above 0");
  CHECK(complaint("box:3x3,size=1") == "mesh \"box:3x3,size=1\": size of 1 numbers; 2, with x between them");
  CHECK(complaint("box:3x3,seed=1,seed=2") == "mesh \"box:3x3,seed=1,seed=2\": \"seed\" twice; each option once");
  CHECK(complaint("box:3x3,perturb=nan").find("numbers, with : between them") != std::string::npos);
  CHECK(complaint("rectangle:40000x40000").find("up to 2e+07 are generated") != std::string::npos);
  CHECK(complaint("sphere:3").find("arc, arch, box, box_arch, bump, cap, cook, duct_arch, line, rectangle, wing") !=
        std::string::npos);
}

TEST_CASE("an interface lies in a space of one dimension more than its elements")
{
  const auto flat = generated("box:2x2,triangles"); // in the plane
  CHECK(interface_of(generated("line:3"), "").dimension == 2);
  CHECK(interface_of(line(3, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)), "").dimension == 2);
  CHECK(interface_of(only(flat, find_group(flat, "volume")), "").dimension == 3);
  CHECK(interface_of(generated("box:2x2"), "x_max").blocks.front().shape == Shape::line2);
  CHECK(interface_of(generated("box:2x2x2"), "z_min").nodes.cols() == 9);
  CHECK_THROWS_WITH_AS(interface_of(generated("box:2x2x2"), ""),
                       "the mesh has elements hexahedron8, so it is no surface; name the group that is: "
                       "\"x_min\", \"y_min\", \"z_min\", \"x_max\", \"y_max\", \"z_max\"",
                       FileError);
}

TEST_CASE("meshes go to files and back by the ending of their names")
{
  const auto mesh = generated("box:2x2");
  for (const char* ending : {".msh", ".vtu"}) {
    const auto file =
        (std::filesystem::temp_directory_path() / ("mullion-mesh-" + std::to_string(::getpid()) + ending)).string();
    write_mesh(mesh, file);

    const auto again = read_or_generate(file);

    CHECK(again.nodes == mesh.nodes);
    CHECK(again.groups.size() == mesh.groups.size());
    std::remove(file.c_str());
  }
  CHECK_THROWS_AS(read_mesh("mesh.stl"), FileError);
  CHECK_THROWS_AS(read_mesh("/nowhere/mesh.msh"), FileError);
}
