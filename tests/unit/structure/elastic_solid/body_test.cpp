// From a mesh with groups to a body: what is held, wet and loaded, and what is wrong with the groups.
#include "elastic_solid/body.hpp"
#include "elastic_solid/initial_states.hpp"
#include "files/file_error.hpp"
#include "files/read.hpp"
#include "support/solid_meshes.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace mullion::elastic_solid;
using namespace mullion::mesh_files;

namespace {

const MeshFile& box()
{
  static const auto mesh = read_or_generate("box:4x2,quads,size=2x1"); // node i + 5 j at (i/2, j/2)
  return mesh;
}

std::string error_of(const MeshFile& mesh, const GroupTexts& groups)
{
  try {
    (void)body_of(mesh, groups);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a list of groups is split at its commas")
{
  CHECK(names_in("").empty());
  CHECK(names_in(" , ").empty());
  CHECK(names_in("left") == std::vector<std::string>{"left"});
  CHECK(names_in(" left side ,right,") == std::vector<std::string>{"left side", "right"});
}

TEST_CASE("groups become held nodes, wet faces that point outward, and loaded faces")
{
  const auto body = body_of(box(), {.wet = "y_max, x_max",
                                    .clamped = "x_min",
                                    .roller_x = "y_min",
                                    .roller_y = "y_min",
                                    .roller_z = "",
                                    .prescribed = "x_max",
                                    .edge_load = "y_min"});

  CHECK(body.wet_nodes == std::vector<mullion::elastic_solid::Index>{4, 9, 10, 11, 12, 13, 14});
  REQUIRE(body.wet.size() == 1);
  CHECK(body.wet[0].connectivity.cols() == 6);
  for (const auto face : body.wet[0].connectivity.colwise()) {
    const Eigen::Vector2d a = body.nodes.col(body.wet_nodes[static_cast<std::size_t>(face[0])]),
                          b = body.nodes.col(body.wet_nodes[static_cast<std::size_t>(face[1])]);
    const Eigen::Vector2d normal(b[1] - a[1], a[0] - b[0]), from_centre = 0.5 * (a + b) - Eigen::Vector2d(1.0, 0.5);
    CHECK(normal.dot(from_centre) > 0.0);
  }
  CHECK(body.constraints[0] == (1 | 2)); // a corner of the clamped side
  CHECK(body.constraints[1] == (1 | 2)); // on both rollers
  CHECK(body.constraints[4] == (1 | 2 | prescribed_bit));
  CHECK(body.constraints[14] == prescribed_bit);
  CHECK(body.constraints[12] == 0);
  CHECK(faces_in(body.loaded_faces).size() == 4);
  for (const auto& [element, local] : faces_in(body.loaded_faces)) {
    CHECK(element < 4);
    CHECK(local == 0);
  }
}

TEST_CASE("a clamped node of a three-dimensional body is held in three directions")
{
  const auto body = body_of(read_or_generate("box:1x1x1,hexes"), {.wet = "z_max",
                                                                  .clamped = "x_min",
                                                                  .roller_x = "",
                                                                  .roller_y = "",
                                                                  .roller_z = "x_max",
                                                                  .prescribed = "",
                                                                  .edge_load = ""});
  CHECK(body.constraints[0] == 7);
  CHECK(body.constraints[1] == 4);
  CHECK(body.wet[0].shape == Shape::quadrilateral4);
}

TEST_CASE("what is wrong with the groups is said with their key and what there is")
{
  GroupTexts groups;
  CHECK(error_of(box(), groups).find("wet: it names no face") == 0);
  groups.wet = "y_mox";
  CHECK(error_of(box(), groups).find("wet: the mesh has no group \"y_mox\"") == 0);
  CHECK(error_of(box(), groups).find("\"y_max\"") != std::string::npos);
  groups.wet = "volume"; // of dimension 2
  CHECK(error_of(box(), groups).find("wet: the mesh has no group \"volume\" of dimension 1") == 0);
  groups.wet = "y_max";
  CHECK(error_of(box(), groups) == "");
  groups.clamped = "left";
  CHECK(error_of(box(), groups).find("clamped: the mesh has no group \"left\"; it has \"volume\"") == 0);
  groups.clamped = "";
  groups.roller_z = "y_max";
  CHECK(error_of(box(), groups).find("roller_z: the mesh lies in the plane") == 0);

  auto inside = box(); // a line between two elements
  groups = {};
  groups.wet = "cut";
  inside.blocks.push_back({Shape::line2, (Connectivity(2, 1) << 5, 6).finished()});
  inside.groups.push_back({"cut", 1, {{static_cast<mullion::mesh_files::Index>(inside.blocks.size() - 1), 0}}});
  CHECK(error_of(inside, groups).find("wet: the element of group \"cut\" from node 5 at (0, 0.5) m to node 6") == 0);
}

TEST_CASE("a uniform pressure's shape is scaled at the monitored node")
{
  const int n = 16;
  auto arch = mullion::testing::arch(n, 1, 0.34795, 0.006, 0.2618);
  arch.material = {.youngs_modulus = 70.0e9, .poisson_ratio = 0.3, .density = 2600.0};
  arch.formulation = Formulation::enhanced;
  const System system{.stiffness = stiffness_matrix(arch),
                      .mass = {},
                      .free = mullion::testing::free_dofs(arch, mullion::testing::at_ends(n))};
  std::vector<FaceOf> outer;
  for (int e = 0; e < n; ++e) outer.push_back({e, 2});
  const auto normals = nodal_normals(arch.nodes, surface_of(arch, outer));
  CHECK(normals(1, n + 1 + n / 2) > 0.0); // outward is up
  const FreeSolver stiffness(system.stiffness, system.free);

  const auto u = pressure_shape(stiffness, normals, n / 2, Eigen::Vector2d(0.0, 1.0), -2.0e-4);

  CHECK(u[2 * (n / 2) + 1] == doctest::Approx(-2.0e-4).epsilon(1e-14));
  CHECK(std::abs(u[2 * (n / 2)]) < 1e-12 * 2e-4 * 1e4); // symmetric
  const Eigen::VectorXd force = system.stiffness * u;
  const Eigen::VectorXd load = normals.reshaped();
  const double pressure = force[2 * (n + 1 + n / 2) + 1] / load[2 * (n + 1 + n / 2) + 1];
  for (const auto i : system.free) // K u is a pressure on the outer face and nothing else
    CHECK(std::abs(force[i] - pressure * load[i]) < 1e-7 * std::abs(pressure) * load.cwiseAbs().maxCoeff());
  CHECK(pressure < 0.0);

  CHECK(pressure_shape(stiffness, normals, 0, Eigen::Vector2d(0.0, 1.0), 1.0).isZero(0.0)); // a clamped node
}
