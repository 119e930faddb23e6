// Mesh motion: what its equations reproduce exactly, which nodes are given, and how far a mesh over an arch can follow.
#include "files/generator_text.hpp"
#include "moving_mesh/constraints.hpp"
#include "moving_mesh/motion_equations.hpp"
#include "moving_mesh/quality.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <vector>

using namespace mullion::moving_mesh;
namespace files = mullion::mesh_files;

namespace {

struct Sample {
  MovingMesh mesh;
  std::vector<Index> wall; ///< nodes of one group
};

/// A generated mesh, without the faces of its boundary, and the nodes of a group.
Sample sample(const std::string& text, const std::string& wall)
{
  const auto file = files::generated(text);
  std::vector<files::Block> cells;
  for (const auto& block : file.blocks)
    if (files::facts(block.shape).dimension == file.dimension) cells.push_back(block);
  std::set<Index> nodes;
  for (const auto& [block, column] : files::find_group(file, wall).elements)
    for (const auto node : file.blocks[static_cast<std::size_t>(block)].connectivity.col(column)) nodes.insert(node);
  return {mesh_of_blocks(file.nodes, cells), {nodes.begin(), nodes.end()}};
}

using Function = std::function<Eigen::VectorXd(const Eigen::VectorXd& x)>;

/// The motion of all nodes if the given components are those of a function.
Eigen::MatrixXd motion(const MovingMesh& mesh, const MotionSolver& solver, const IsGiven& is_given, const Function& f)
{
  Eigen::MatrixXd velocity = Eigen::MatrixXd::Zero(mesh.nodes.rows(), mesh.nodes.cols());
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    const auto value = f(mesh.nodes.col(i));
    for (Eigen::Index c = 0; c < mesh.nodes.rows(); ++c)
      if (is_given(c, i)) velocity(c, i) = value[c];
  }
  complete_motion(solver, velocity);
  return velocity;
}

double largest_error(const MovingMesh& mesh, const Eigen::MatrixXd& velocity, const Function& f)
{
  double largest = 0.0;
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i)
    largest = std::max(largest, (velocity.col(i) - f(mesh.nodes.col(i))).cwiseAbs().maxCoeff());
  return largest;
}

std::vector<double> uniform(const MovingMesh& mesh)
{
  return std::vector<double>(static_cast<std::size_t>(mesh.n_elements()), 1.0);
}

MotionSolver masud_hughes(const MovingMesh& mesh, const IsGiven& is_given)
{
  return solver_by_component(laplacian_matrix(mesh, masud_hughes_stiffness(element_measures(mesh, mesh.nodes))),
                             is_given);
}

MotionSolver elastic(const MovingMesh& mesh, const IsGiven& is_given)
{
  return coupled_solver(
      elasticity_matrix(mesh, inverse_measure_stiffness(element_measures(mesh, mesh.nodes), 1.0), 0.3), is_given);
}

/// Meshes of every kind of element, with inner nodes that lie nowhere in particular.
const std::vector<std::string> irregular = {"box:7x6,size=2x1,perturb=0.2", "box:7x6,size=2x1,triangles,perturb=0.2",
                                            "box:7x6,size=2x1,delaunay,perturb=0.24,ratio=5:1",
                                            "box:4x3x3,perturb=0.15", "box:4x3x3,tets,perturb=0.15"};

// Solutions of systems of a few hundred unknowns with a condition of about 1e3.
constexpr double solved = 1e-12;

} // namespace

TEST_CASE("a translation of the whole boundary moves the whole mesh alike, whatever the stiffness")
{
  for (const auto& text : irregular) {
    CAPTURE(text);
    const auto mesh = sample(text, "x_min").mesh;
    const auto is_given = constraints(mesh, {}, {}).is_given;
    const Function f = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return Eigen::Vector3d(0.3, -1.0, 0.5).head(x.size());
    };

    for (const auto& solver : {masud_hughes(mesh, is_given), elastic(mesh, is_given)})
      CHECK(largest_error(mesh, motion(mesh, solver, is_given, f), f) < solved);
  }
}

TEST_CASE("a linear motion of the boundary is continued exactly with uniform stiffness, on every kind of element")
{
  for (const auto& text : irregular) {
    CAPTURE(text);
    const auto mesh = sample(text, "x_min").mesh;
    const auto is_given = constraints(mesh, {}, {}).is_given;
    Eigen::Matrix3d gradient;
    gradient << 0.3, -0.2, 0.7, 0.5, 0.1, -0.4, 0.2, 0.6, -0.3;
    const Function f = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return gradient.topLeftCorner(x.size(), x.size()) * x;
    };

    const auto laplacian = solver_by_component(laplacian_matrix(mesh, uniform(mesh)), is_given);
    CHECK(largest_error(mesh, motion(mesh, laplacian, is_given, f), f) < solved);
    const auto elasticity = coupled_solver(elasticity_matrix(mesh, uniform(mesh), 0.3), is_given);
    CHECK(largest_error(mesh, motion(mesh, elasticity, is_given, f), f) < solved);
    // And not with a stiffness that varies, which is what it is for.
    CHECK(largest_error(mesh, motion(mesh, masud_hughes(mesh, is_given), is_given, f), f) > 1e-4);
  }
}

TEST_CASE("pyramids and prisms continue a linear motion too, beside hexahedra and tetrahedra")
{
  // A cube of six pyramids around its middle, moved off the middle, with a prism on its top.
  Eigen::MatrixXd nodes(3, 11);
  nodes.transpose() << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 0.4, 0.55, 0.45, //
      0.1, 0.4, 1.8, 0.9, 0.6, 2.0;
  struct Block {
    Eigen::MatrixXi connectivity;
  };
  Eigen::MatrixXi pyramids(5, 6), prisms(6, 1);
  pyramids.transpose() << 0, 1, 2, 3, 8, 4, 7, 6, 5, 8, 0, 4, 5, 1, 8, 1, 5, 6, 2, 8, 2, 6, 7, 3, 8, 3, 7, 4, 0, 8;
  prisms.col(0) << 4, 7, 9, 5, 6, 10;
  const auto mesh = mesh_of_blocks(nodes, std::vector<Block>{{pyramids}, {prisms}});
  REQUIRE(complaint_about(mesh) == "");
  const auto given = constraints(mesh, {}, {}).is_given;
  const Function f = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return Eigen::Vector3d(0.3 * x[0] - 0.2 * x[1], 0.5 * x[2], x[0] + x[1]);
  };

  CHECK((given.col(8) == false).all());
  CHECK(given.cast<int>().sum() == 30);
  const auto solver = coupled_solver(elasticity_matrix(mesh, uniform(mesh), 0.3), given);
  CHECK(largest_error(mesh, motion(mesh, solver, given, f), f) < solved);
  // The pyramids fill the cube; over the warped roof of the prism the parts by both cuts are taken.
  const auto measures = element_measures(mesh, mesh.nodes);
  double cube = 0.0;
  for (int e = 0; e < 6; ++e) cube += measures[static_cast<std::size_t>(e)];
  CHECK(cube == doctest::Approx(1.0).epsilon(1e-14));
}

TEST_CASE("hexahedra and quadrilaterals have no preferred diagonal")
{
  const auto [mesh, wall] = sample("box:3x3", "x_min");
  const auto matrix = laplacian_matrix(mesh, uniform(mesh));

  // The nine-point star of a square: half of the five-point star, on its axes, and no more than that on either
  // diagonal (P1 on squares couples the ends of a diagonal by 0).
  CHECK(matrix.coeff(5, 5) == doctest::Approx(4.0).epsilon(1e-14));
  for (const int neighbour : {1, 4, 6, 9}) CHECK(matrix.coeff(5, neighbour) == doctest::Approx(-1.0).epsilon(1e-14));
  for (const int neighbour : {0, 2, 8, 10}) CHECK(std::abs(matrix.coeff(5, neighbour)) < 1e-15);
}

TEST_CASE("Masud and Hughes make small elements stiff, equal ones uniform, and slivers no stiffer than the cap")
{
  CHECK(masud_hughes_stiffness({2.0, 2.0}) == std::vector<double>{1.0, 1.0});
  // tau = (1 - 1/4) / (V / 4) = 3 / V: by hand.
  CHECK(masud_hughes_stiffness({1.0, 2.0, 4.0}) == std::vector<double>{4.0, 2.5, 1.75});
  CHECK(masud_hughes_stiffness({1e-9, 1.0})[0] == 1.0 + 1e4);
  CHECK(inverse_measure_stiffness({1.0, 2.0, 4.0}, 2.0) == std::vector<double>{16.0, 4.0, 1.0});
}

TEST_CASE("the boundary is found from the topology, and sides let their nodes slide along them")
{
  const auto [mesh, wall] = sample("box:4x3,size=4x3", "x_max");
  CHECK(boundary_faces(mesh).size() == 14);
  CHECK(boundary_faces(sample("box:2x3x4", "x_min").mesh).size() == 2 * (6 + 8 + 12));
  CHECK(boundary_faces(sample("box:2x3x4,tets", "x_min").mesh).size() == 4 * (6 + 8 + 12));

  const auto [is_given, n_faces] = constraints(mesh, wall, {{1, false}, {1, true}});

  CHECK(n_faces == std::vector<Index>{4, 4});
  const auto given = [&](int i, int j) { return Eigen::Vector2i(is_given.col(i + 5 * j).cast<int>()); };
  CHECK(given(2, 1) == Eigen::Vector2i(0, 0)); // inside
  CHECK(given(2, 0) == Eigen::Vector2i(0, 1)); // on a side that slides: along x only
  CHECK(given(0, 0) == Eigen::Vector2i(1, 1)); // where it meets one that does not
  CHECK(given(0, 1) == Eigen::Vector2i(1, 1));
  CHECK(given(4, 3) == Eigen::Vector2i(1, 1)); // the wall's end

  const auto free = constraints(mesh, wall, {{1, false}, {1, true, true}});
  CHECK(free.n_faces == std::vector<Index>{4, 4});
  const auto left = [&](int i, int j) { return Eigen::Vector2i(free.is_given.col(i + 5 * j).cast<int>()); };
  CHECK(left(2, 0) == Eigen::Vector2i(0, 1));
  CHECK(left(2, 3) == Eigen::Vector2i(0, 0)); // on a side that is free
  CHECK(left(0, 3) == Eigen::Vector2i(1, 1)); // where it meets one that stays
}

TEST_CASE("between a wall that is pulled sideways and a side that stays, with free sides, a mesh is sheared evenly")
{
  for (const char* text : {"box:6x4,size=3x1", "box:6x4,size=3x1,alternating"}) {
    CAPTURE(text);
    const auto [mesh, wall] = sample(text, "y_min");
    const auto is_given = constraints(mesh, wall, {{0, false, true}, {0, true, true}}).is_given;
    const Function f = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return Eigen::Vector2d(1.0 - x[1], 0.5 * (1.0 - x[1]));
    };

    // Laplace's natural condition is that nothing changes across the side, as here. (An elastic body's is no traction.)
    CHECK(largest_error(mesh, motion(mesh, masud_hughes(mesh, is_given), is_given, f), f) < solved);
  }
}

TEST_CASE("between a wall that is pushed and its opposite, with sliding sides, a mesh is squeezed evenly")
{
  for (const char* text : {"box:6x4,size=3x1", "box:6x4,size=3x1,alternating", "box:3x2x2,size=3x1x1"}) {
    CAPTURE(text);
    const auto [mesh, wall] = sample(text, "x_max");
    const auto is_given =
        constraints(mesh, wall,
                    mesh.dimension == 2 ? std::vector<Side>{{1, false}, {1, true}}
                                        : std::vector<Side>{{1, false}, {1, true}, {2, false}, {2, true}})
            .is_given;
    const Function f = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return x[0] / 3.0 * Eigen::VectorXd::Unit(x.size(), 0);
    };

    CHECK(largest_error(mesh, motion(mesh, masud_hughes(mesh, is_given), is_given, f), f) < solved);
    // An elastic body evades sideways, but for the sides that keep it there.
    CHECK(largest_error(mesh, motion(mesh, elastic(mesh, is_given), is_given, f), f) < solved);
  }
}

TEST_CASE("a mesh that nothing holds is noticed")
{
  const auto mesh = sample("box:3x3", "x_min").mesh;
  const IsGiven none = IsGiven::Constant(2, 16, false), all = IsGiven::Constant(2, 16, true);

  CHECK(!solver_by_component(laplacian_matrix(mesh, uniform(mesh)), none).is_regular());
  CHECK(!coupled_solver(elasticity_matrix(mesh, uniform(mesh), 0.3), none).is_regular());
  CHECK(solver_by_component(laplacian_matrix(mesh, uniform(mesh)), all).is_regular()); // nothing to solve for
}

TEST_CASE("shapes are 1 for the best elements and fall with distortion")
{
  const double root = std::sqrt(3.0);
  Eigen::MatrixXd nodes(2, 7);
  nodes << 0, 2, 1, 3, 5, 5, 3, 0, 0, root, 0, 0, 1, 2;
  struct Block {
    Eigen::MatrixXi connectivity;
  };
  Eigen::MatrixXi triangle(3, 1), quadrilateral(4, 1);
  triangle.col(0) << 0, 1, 2;
  quadrilateral.col(0) << 3, 4, 5, 6;
  const auto mesh = mesh_of_blocks(nodes, std::vector<Block>{{triangle}, {quadrilateral}});

  CHECK(shape_of_element(mesh, nodes, 0) == doctest::Approx(1.0).epsilon(1e-14));
  // The sharpest corner of the quadrilateral has the angle between (-2, 1) and (0, -2), or (-2, 0): sin = 2 / sqrt 5.
  CHECK(shape_of_element(mesh, nodes, 1) == doctest::Approx(2.0 / std::sqrt(5.0)).epsilon(1e-14));
  const auto cubes = sample("box:2x2x2", "x_min").mesh;
  CHECK(shape_of_element(cubes, cubes.nodes, 3) == doctest::Approx(1.0).epsilon(1e-14));
  // A corner of a cube cut off: edges 1, 1, 1, and three of sqrt 2, so 72 sqrt 3 / 6 / 9^1.5.
  const auto tets = sample("box:1x1x1,tets", "x_min").mesh;
  const double longest = 3.0 + 2.0 * 2.0 + 3.0; // of a Kuhn tetrahedron: 1, 1, 1, sqrt 2, sqrt 2, sqrt 3
  CHECK(shape_of_element(tets, tets.nodes, 0) ==
        doctest::Approx(72.0 * root / 6.0 / std::pow(longest, 1.5)).epsilon(1e-13));
}

TEST_CASE("a folded corner is found where the area of its element alone would not tell")
{
  const auto mesh = sample("box:3x3,size=3x3", "x_min").mesh;
  const auto measures = element_measures(mesh, mesh.nodes);
  auto moved = mesh.nodes;
  moved.col(5) += Eigen::Vector2d(0.6, 0.6); // the inner corner of cell 0; cell 4 has an arrowhead there

  const auto quality = quality_of(mesh, measures, moved);

  CHECK(quality.is_folded);
  CHECK(quality.folded == 4);
  CHECK(quality.folded_ratio == doctest::Approx(-0.1).epsilon(1e-14)); // 1/2 (1 - 1.2): the part without the far corner
  CHECK(quality.min_area_ratio == doctest::Approx(0.4).epsilon(1e-14));
  CHECK(quality.smallest == 4);
  CHECK(quality.min_shape < 0.0);
  CHECK(!quality_of(mesh, measures, mesh.nodes).is_folded);
  moved(0, 5) = std::nan("");
  CHECK(quality_of(mesh, measures, moved).is_folded);
}

TEST_CASE("what cannot be moved is said in words")
{
  const auto complaint = [](const std::string& text) {
    const auto file = files::generated(text);
    return complaint_about(mesh_of_blocks(file.nodes, file.blocks));
  };
  CHECK(complaint("box:2x2") == "element 4 has 2 nodes; elements that fill the plane have 3 or 4");
  auto mesh = sample("box:2x2", "x_min").mesh;
  mesh.nodes.col(4) += Eigen::Vector2d(0.6, 0.0);
  CHECK(complaint_about(mesh) ==
        "element 1 around (0.9, 0.25) is folded or turned over; all elements turn to the left and are convex");
}
