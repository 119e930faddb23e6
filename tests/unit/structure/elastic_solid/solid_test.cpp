// A solid's matrices: Cook's membrane, masses, supports, and what is wrong with a mesh.
#include "elastic_solid/boundary.hpp"
#include "elastic_solid/solid.hpp"
#include "elastic_solid/time_integration.hpp"
#include "support/solid_meshes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace mullion::elastic_solid;
using namespace mullion::testing;
namespace mesh_files = mullion::mesh_files;

namespace {

/// Vertical displacement of Cook's membrane at the middle of its right edge under a shear force 1.
double cook(int n, Formulation formulation, bool in_triangles = false)
{
  auto solid = cook_membrane(n);
  if (in_triangles) {
    const auto quads = solid.blocks[0].connectivity;
    mesh_files::Connectivity triangles(3, 2 * quads.cols());
    for (Eigen::Index e = 0; e < quads.cols(); ++e) {
      triangles.col(2 * e) << quads(0, e), quads(1, e), quads(2, e);
      triangles.col(2 * e + 1) << quads(0, e), quads(2, e), quads(3, e);
    }
    solid.blocks = {{Shape::triangle3, triangles}};
  }
  solid.material = {.youngs_modulus = 1.0, .poisson_ratio = 1.0 / 3.0, .plane = Plane::stress};
  solid.formulation = formulation;
  const System system{.stiffness = stiffness_matrix(solid), .mass = {}, .free = free_dofs(solid, [n](auto node, auto) {
                                                                          return node % (n + 1) == 0;
                                                                        })};
  std::vector<FaceOf> right;
  for (int j = 0; j < n; ++j) {
    const int quad = n * j + n - 1;
    right.push_back(in_triangles ? FaceOf{2 * quad, 1} : FaceOf{quad, 1});
  }
  const auto edge = surface_mass(solid.nodes, surface_of(solid, right));
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(2, solid.n_nodes());
  load.row(1) = Eigen::RowVectorXd::Constant(solid.n_nodes(), 1.0 / 16.0) * edge; // on 16 m: a force of 1
  CHECK(load.sum() == doctest::Approx(1.0).epsilon(1e-13));

  const auto u = static_displacement(system, FreeSolver(system.stiffness, system.free), load.reshaped(),
                                     Eigen::VectorXd::Zero(solid.n_dofs()));
  return u[2 * ((n + 1) * (n / 2) + n) + 1]; // n is even
}

} // namespace

TEST_CASE("Cook's membrane: both quadrilaterals give the deflections that another program gives")
{
  // A separate finite-element code in Python, five digits; enhanced elements also as in Simo & Rifai 1990, Table 3.
  const struct {
    int n;
    double standard, enhanced;
  } table[] = {
      {2, 11.845, 21.050}, {4, 18.299, 23.016}, {8, 22.079, 23.689}, {16, 23.430, 23.883}, {32, 23.818, 23.940}};
  for (const auto& [n, standard, enhanced] : table) {
    CAPTURE(n);
    CHECK(std::abs(cook(n, Formulation::standard) - standard) < 6e-4); // the digits printed, and round-off
    CHECK(std::abs(cook(n, Formulation::enhanced) - enhanced) < 6e-4);
  }
}

TEST_CASE("Cook's membrane in triangles approaches the same deflection from below")
{
  const double limit = 23.967; // quadratic elements on a 128 x 128 mesh
  double before = 1e9;
  for (const int n : {8, 16, 32}) {
    const double error = limit - cook(n, Formulation::standard, true);
    CHECK(error > 0.0);
    // Order h^2 in energy but for the corner of the clamped side, which leaves about h^1.3: 2.4 a halving.
    CHECK(error < before / 2.2);
    before = error;
  }
}

TEST_CASE("triangles: displacements converge with second order on distorted meshes")
{
  // The gradient of a harmonic function is in equilibrium without a body force: that of e^x sin y.
  double before = 0.0;
  for (const int n : {8, 16, 32}) {
    auto solid = solid_of(mesh_files::box_2d({n, n, mesh_files::Cells::triangles, {0.2, 3}}, {1.0, 1.0}));
    solid.material = {.youngs_modulus = 1.0, .poisson_ratio = 0.3, .plane = Plane::strain};
    Eigen::MatrixXd exact(2, solid.n_nodes());
    for (Eigen::Index i = 0; i < solid.n_nodes(); ++i) {
      const double x = solid.nodes(0, i), y = solid.nodes(1, i);
      exact.col(i) << std::exp(x) * std::sin(y), std::exp(x) * std::cos(y);
    }
    const auto is_side = [&](Eigen::Index i, Eigen::Index) {
      return solid.nodes.col(i).minCoeff() < 1e-9 || solid.nodes.col(i).maxCoeff() > 1.0 - 1e-9;
    };
    const System system{.stiffness = stiffness_matrix(solid), .mass = {}, .free = free_dofs(solid, is_side)};

    const auto u = static_displacement(system, FreeSolver(system.stiffness, system.free),
                                       Eigen::VectorXd::Zero(solid.n_dofs()), exact.reshaped());

    const double error = (u - exact.reshaped()).norm() / std::sqrt(static_cast<double>(solid.n_dofs()));
    if (before > 0.0) CHECK(std::log2(before / error) > 1.8); // 2, less what the random mesh varies
    before = error;
  }
  CHECK(before < 3.3e-4); // interpolation: h^2/8 times the second derivatives, up to e
}

TEST_CASE("consistent and lumped masses add up to the body's mass in each direction")
{
  for (const auto shape : {Shape::triangle3, Shape::quadrilateral4, Shape::tetrahedron4, Shape::hexahedron8}) {
    auto solid = patch(shape);
    solid.material.density = 3.0;
    if (solid.dimension() == 2) solid.thickness = 0.5;
    const double expected = 3.0 * solid.thickness * solid.dimension(); // the unit square or cube
    CHECK(mass_matrix(solid, MassKind::consistent).sum() == doctest::Approx(expected).epsilon(1e-13));
    const auto lumped = mass_matrix(solid, MassKind::lumped);
    CHECK(lumped.sum() == doctest::Approx(expected).epsilon(1e-13));
    CHECK(lumped.nonZeros() == solid.n_dofs()); // a diagonal
    CHECK(lumped.diagonal().minCoeff() > 0.0);
  }
}

TEST_CASE("nodal tractions become loads with their force, and normals point out of the body")
{
  for (const auto shape : {Shape::triangle3, Shape::quadrilateral4, Shape::tetrahedron4, Shape::hexahedron8}) {
    const auto solid = patch(shape);
    const auto surface = surface_of(solid, boundary_faces(solid));
    const Eigen::Index d = solid.dimension();

    const auto mass = surface_mass(solid.nodes, surface);
    const auto normals = nodal_normals(solid.nodes, surface);

    CHECK(mass.sum() == doctest::Approx(d == 2 ? 4.0 : 6.0).epsilon(1e-13)); // the square's sides, the cube's faces
    for (Eigen::Index k = 0; k < d; ++k) CHECK(std::abs(normals.row(k).sum()) < 1e-14 * 6.0); // closed
    double volume = 0.0; // divergence theorem: int x . n dA = d V
    for (Eigen::Index i = 0; i < solid.n_nodes(); ++i) volume += solid.nodes.col(i).dot(normals.col(i));
    CHECK(volume == doctest::Approx(static_cast<double>(d)).epsilon(1e-13));
  }
}

TEST_CASE("a body that can still move as a whole is told from one that is held")
{
  const auto solid = patch(Shape::quadrilateral4, 2); // node 0 at the origin, 8 at (1, 1)
  std::vector<bool> held(static_cast<std::size_t>(solid.n_dofs()), false);
  CHECK(missing_support(solid, held).find("3 of its 3 rigid motions are free") != std::string::npos);
  held[0] = held[1] = true; // it can turn about node 0
  CHECK(missing_support(solid, held).find("1 of its 3") != std::string::npos);
  held[16] = true; // u_x of the corner opposite
  CHECK(missing_support(solid, held) == "");
  held[16] = false;
  held[2] = true; // u_x of node 1, on the line of u_x through node 0: still turns
  CHECK(missing_support(solid, held).find("1 of its 3") != std::string::npos);

  const auto cube = patch(Shape::hexahedron8, 1);
  held.assign(24, false);
  for (int k = 0; k < 6; ++k) held[static_cast<std::size_t>(k)] = true; // two corners: it turns about the edge
  CHECK(missing_support(cube, held).find("1 of its 6") != std::string::npos);
  held[8] = true;
  CHECK(missing_support(cube, held) == "");
}

TEST_CASE("of two separate parts the one that is not held is named")
{
  auto solid = patch(Shape::quadrilateral4, 1);
  const auto other = solid;
  solid.nodes.conservativeResize(2, 8);
  solid.nodes.rightCols(4) = other.nodes.colwise() + Eigen::Vector2d(5.0, 0.0);
  solid.blocks.push_back({Shape::quadrilateral4, other.blocks[0].connectivity.array() + 4});
  std::vector<bool> held(16, false);
  for (std::size_t i = 0; i < 8; ++i) held[i] = true;

  const auto missing = missing_support(solid, held);

  CHECK(missing.find("around (5.5, 0.5) m (4 nodes)") != std::string::npos);
}

TEST_CASE("what is wrong with a mesh is said with its place")
{
  auto solid = patch(Shape::quadrilateral4, 2);
  CHECK(complaint_about(solid) == "");

  auto turned = solid;
  turned.blocks[0].connectivity.col(3).reverseInPlace();
  CHECK(complaint_about(turned).find("element 3, a quadrilateral4 at (") == 0);
  CHECK(complaint_about(turned).find("counterclockwise") != std::string::npos);

  auto flat = solid;
  flat.nodes.row(1).setZero();
  CHECK(complaint_about(flat).find("element 0") == 0);

  auto lonely = solid;
  lonely.nodes.conservativeResize(2, 10);
  lonely.nodes.col(9) << 2.0, 3.0;
  CHECK(complaint_about(lonely).find("node 9 at (2, 3) m belongs to no element") == 0);

  auto lines = solid;
  lines.blocks = {{Shape::line2, solid.blocks[0].connectivity.topRows(2)}};
  CHECK(complaint_about(lines).find("a solid consists of triangles and quadrilaterals") != std::string::npos);
  lines.blocks.clear();
  CHECK(complaint_about(lines).find("no elements") != std::string::npos);
}
