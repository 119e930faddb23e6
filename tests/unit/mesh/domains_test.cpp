// Generated domains in the plane: what test problems and the flow over an arch are posed on.
#include "files/file_error.hpp"
#include "files/generator_text.hpp"
#include "files/generators.hpp"
#include "support/mesh_samples.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace mullion::mesh_files;
using namespace mullion::testing;

namespace {

std::string complaint(const std::string& text)
{
  try {
    generated(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

/// Twice the area at each corner of each cell, the smallest of all [m^2].
double smallest_turn(const MeshFile& mesh)
{
  double smallest = 1e300;
  for (const auto& [shape, cells] : mesh.blocks) {
    if (facts(shape).dimension != 2) continue;
    for (const auto& cell : cells.colwise())
      for (Eigen::Index k = 0, n = cell.size(); k < n; ++k) {
        const Eigen::Vector2d at = mesh.nodes.col(cell[k]);
        const Eigen::Vector2d u = mesh.nodes.col(cell[(k + 1) % n]) - at;
        const Eigen::Vector2d v = mesh.nodes.col(cell[(k + n - 1) % n]) - at;
        smallest = std::min(smallest, u[0] * v[1] - u[1] * v[0]);
      }
  }
  return smallest;
}

double area(const MeshFile& mesh)
{
  double sum = 0.0;
  for (const auto& [shape, cells] : mesh.blocks) {
    if (facts(shape).dimension != 2) continue;
    for (const auto& cell : cells.colwise())
      for (Eigen::Index k = 0, n = cell.size(); k < n; ++k) {
        const auto a = mesh.nodes.col(cell[k]), b = mesh.nodes.col(cell[(k + 1) % n]);
        sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
      }
  }
  return sum;
}

/// The nodes of a group of lines.
std::set<Index> nodes_of(const MeshFile& mesh, const std::string& name)
{
  std::set<Index> nodes;
  for (const auto& [block, column] : find_group(mesh, name).elements)
    for (const auto node : mesh.blocks[static_cast<std::size_t>(block)].connectivity.col(column)) nodes.insert(node);
  return nodes;
}

Eigen::Index n_cells(const MeshFile& mesh)
{
  Eigen::Index n = 0;
  for (const auto& [shape, cells] : mesh.blocks) n += facts(shape).dimension == 2 ? cells.cols() : 0;
  return n;
}

/// All edges of cells that no other cell has, as the cell goes through them: the gas or solid is on their left, so
/// that the normal, to their right, points outward.
std::set<std::pair<Index, Index>> boundary(const MeshFile& mesh)
{
  std::set<std::pair<Index, Index>> edges;
  for (const auto& [shape, cells] : mesh.blocks) {
    if (facts(shape).dimension != 2) continue;
    for (const auto& cell : cells.colwise())
      for (Eigen::Index k = 0, n = cell.size(); k < n; ++k) edges.emplace(cell[k], cell[(k + 1) % n]);
  }
  std::set<std::pair<Index, Index>> open;
  for (const auto& [a, b] : edges)
    if (!edges.contains({b, a})) open.emplace(a, b);
  return open;
}

// The arch that all defaults are about, with a few numbers of its own.
const double angle = 15.0 * std::numbers::pi / 180.0;
const double outer = 0.34795 / angle + 0.003;     // its outer face's radius [m]
const double end = outer * std::sin(0.5 * angle); // half its chord [m]
const double face = 2.0 * end / 34;               // the mean width of 34 faces [m]
const Eigen::Vector2d centre(0.0, -outer* std::cos(0.5 * angle));
constexpr double round_off = 1e-14; // of coordinates around 1

} // namespace

TEST_CASE("each face of a domain's boundary is in one group, with its normal outward, and no cell is turned over")
{
  for (const char* text :
       {"box:6x5,ratio=3:0.5,skew=0.03", "arch:24x2", "duct_arch:10x8", "box_arch:34x16", "bump:12x5", "cook:4x3"})
    for (const char* cells : {"", ",triangles", ",alternating,perturb=0.2", ",delaunay,perturb=0.2,seed=3"}) {
      CAPTURE(std::string(text) + cells);

      const auto mesh = generated(std::string(text) + cells);

      std::set<std::pair<Index, Index>> grouped;
      for (const auto& group : mesh.groups) {
        if (group.dimension != 1) continue;
        for (const auto& [block, column] : group.elements) {
          const auto line = mesh.blocks[static_cast<std::size_t>(block)].connectivity.col(column);
          CHECK(grouped.emplace(line[0], line[1]).second);
        }
      }
      CHECK(grouped == boundary(mesh));
      CHECK(find_group(mesh, "volume").elements.size() == static_cast<std::size_t>(n_cells(mesh)));
      CHECK(smallest_turn(mesh) > 0.0);
    }
}

TEST_CASE("the duct over the arch has 10 020 quadrilaterals, fine on the arch and coarse at the ends")
{
  const auto mesh = generated("duct_arch:34x60");
  const auto shell = nodes_of(mesh, "shell");

  CHECK(n_cells(mesh) == 10020); // 167 columns: 34 faces, 63 cells to the left and 70 to the right of the arch
  CHECK(mesh.nodes.cols() == 168 * 61);
  CHECK(shell.size() == 35);
  CHECK(find_group(mesh, "floor").elements.size() == 133);
  for (const auto node : shell) {
    const Eigen::Vector2d x = mesh.nodes.col(node) - centre;
    CHECK(std::abs(x.norm() - outer) < round_off);
    const double turns = std::atan2(x[0], x[1]) / (angle / 34); // from the middle, in faces
    CHECK(std::abs(turns - std::round(turns)) < 1e-11);         // 1e-14 of an angle that is a thousandth of it
  }
  CHECK(mesh.nodes.col(*shell.begin()) == Eigen::Vector2d(-end, 0.0));
  CHECK(mesh.nodes.col(*shell.rbegin()) == Eigen::Vector2d(end, 0.0));

  // Along the floor, which the first 168 nodes are: the first cell beside the arch is 1.04 mean faces wide, each
  // further one 1.04 times as wide as the one before, up to 45 mm.
  const auto width = [&](int i) { return mesh.nodes(0, i + 1) - mesh.nodes(0, i); };
  for (int k = 0; k < 63; ++k) {
    const double expected = std::min(face * std::pow(1.04, k + 1), 0.045);
    CHECK(width(62 - k) == doctest::Approx(expected).epsilon(1e-12)); // differences of numbers up to 2
    CHECK(width(97 + k) == doctest::Approx(expected).epsilon(1e-12));
  }
  CHECK(mesh.nodes(0, 0) <= -2.2);
  CHECK(mesh.nodes(0, 1) > -2.2);
  CHECK(mesh.nodes(0, 167) >= 2.5);
  CHECK(mesh.nodes(0, 166) < 2.5);

  // Upward over the flat floor: the first row as high as a face is wide, a constant factor, the roof at 1.25 m.
  const auto y = [&](int j) { return mesh.nodes(1, j * 168); };
  CHECK(y(1) == doctest::Approx(face).epsilon(1e-12)); // bisected to round-off
  for (int j = 2; j <= 60; ++j)
    CHECK((y(j) - y(j - 1)) / (y(j - 1) - y(j - 2)) ==
          doctest::Approx(1.02198).epsilon(1e-5)); // by sum, with a calculator
  CHECK(y(60) == 1.25);
  // Over the arch's crest the same parts of what is left.
  const double crest = outer + centre[1];
  CHECK(mesh.nodes(1, 63 + 17) == doctest::Approx(crest).epsilon(round_off));
  CHECK(mesh.nodes(1, 168 + 63 + 17) == doctest::Approx(crest + (1.25 - crest) * y(1) / 1.25).epsilon(round_off));
}

TEST_CASE("the closed box over the arch has one cell beside it and rows that sum up to its height")
{
  const auto mesh = generated("box_arch:34x16");

  CHECK(n_cells(mesh) == 576);
  CHECK(mesh.nodes.row(0).maxCoeff() == doctest::Approx(end + 1.04 * face).epsilon(round_off));
  CHECK(mesh.nodes.row(0).minCoeff() == -mesh.nodes.row(0).maxCoeff());
  CHECK(mesh.nodes.row(1).maxCoeff() == 0.2);
  CHECK(mesh.nodes(1, 37) == doctest::Approx(face).epsilon(1e-12));
  const auto y = [&](int j) { return mesh.nodes(1, j * 37); };
  for (int j = 2; j <= 16; ++j)
    CHECK((y(j) - y(j - 1)) / (y(1) - y(0)) == doctest::Approx(std::pow((y(2) - y(1)) / y(1), j - 1)).epsilon(1e-10));
  CHECK(nodes_of(mesh, "left").size() == 17);
  CHECK(find_group(mesh, "floor").elements.size() == 2);
}

TEST_CASE("the solid arch has its outer face where the gas has it, and its thickness everywhere")
{
  const auto arch = generated("arch:34x2"), gas = generated("duct_arch:34x4");
  const auto wet = nodes_of(arch, "wet"), inner = nodes_of(arch, "inner"), shell = nodes_of(gas, "shell");

  REQUIRE(wet.size() == shell.size());
  auto on_gas = shell.begin();
  for (const auto node : wet) CHECK((arch.nodes.col(node) - gas.nodes.col(*on_gas++)).norm() < round_off);
  for (const auto node : inner)
    CHECK(((arch.nodes.col(node) - centre).norm() - (outer - 0.006)) == doctest::Approx(0.0).epsilon(round_off));
  // A ring's sector of 34 chords: the mean radius times thickness times angle, up to sin x / x with x = angle / 34.
  const double x = angle / 34;
  CHECK(area(arch) == doctest::Approx(0.34795 * 0.006 * std::sin(x) / x).epsilon(1e-11)); // sums over areas near 1e-5
  CHECK(nodes_of(arch, "start").size() == 3);
  for (const auto node : nodes_of(arch, "end"))
    CHECK(std::abs(std::atan2(arch.nodes(0, node), arch.nodes(1, node) - centre[1]) - 0.5 * angle) < round_off);
}

TEST_CASE("Ni's channel has its bump on the middle third")
{
  const auto mesh = generated("bump:48x16");

  CHECK(n_cells(mesh) == 768);
  CHECK(mesh.nodes.col(24).isApprox(Eigen::Vector2d(1.5, 0.1), round_off));
  for (const auto node : nodes_of(mesh, "bump")) // the circle of the radius 1.3
    CHECK(std::abs((mesh.nodes.col(node) - Eigen::Vector2d(1.5, -1.2)).norm() - 1.3) < round_off);
  for (const auto node : nodes_of(mesh, "floor")) CHECK(mesh.nodes(1, node) == 0.0);
  CHECK(mesh.nodes(1, 24 + 49 * 8) == doctest::Approx(0.55).epsilon(round_off)); // halfway between crest and roof
}

TEST_CASE("Cook's membrane has its corners and its area")
{
  const auto mesh = generated("cook:8x4,triangles");

  CHECK(mesh.nodes.col(8) == Eigen::Vector2d(48.0, 44.0));
  CHECK(mesh.nodes.col(44) == Eigen::Vector2d(48.0, 60.0));
  CHECK(mesh.nodes.col(36) == Eigen::Vector2d(0.0, 44.0));
  CHECK(area(mesh) == doctest::Approx(0.5 * (44.0 + 16.0) * 48.0).epsilon(round_off));
}

TEST_CASE("a box's cells grow by one factor along each axis, and stay in place with none")
{
  const auto mesh = generated("box:4x2,size=15x3,ratio=8:0.5");
  CHECK(mesh.nodes.row(0).head(5).isApprox(Eigen::RowVectorXd{{0.0, 1.0, 3.0, 7.0, 15.0}}, round_off));
  CHECK(mesh.nodes(1, 5) == doctest::Approx(2.0).epsilon(round_off));

  const auto space = generated("box:4x1x1,size=15x1x1,ratio=8:1:1");
  CHECK(space.nodes.row(0).head(5).isApprox(Eigen::RowVectorXd{{0.0, 1.0, 3.0, 7.0, 15.0}}, round_off));

  CHECK(is_same(generated("box:7x49,ratio=1:1,perturb=0.2"), generated("box:7x49,perturb=0.2")));
}

TEST_CASE("a skewed box moves its inner nodes by two waves and its sides not at all")
{
  const auto mesh = generated("box:8x4,size=10x10,skew=0.3"), straight = generated("box:8x4,size=10x10");

  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    const Eigen::Vector2d x = straight.nodes.col(i);
    const double moved = 0.3 * std::sin(0.2 * std::numbers::pi * x[0]) * std::sin(0.2 * std::numbers::pi * x[1]);
    CHECK((mesh.nodes.col(i) - x - Eigen::Vector2d(moved, moved)).norm() < round_off);
    if (x[0] == 0.0 || x[0] == 10.0 || x[1] == 0.0 || x[1] == 10.0) CHECK(mesh.nodes.col(i) == x);
  }
}

TEST_CASE("triangles are cut along one diagonal, along both in turn, or along the better one")
{
  const auto meeting = [](const char* text) { // how many nodes have so many triangles, inside
    const auto mesh = generated(text);
    std::vector<int> at_node(static_cast<std::size_t>(mesh.nodes.cols()), 0);
    const auto triangles = elements_of(mesh, Shape::triangle3);
    for (const auto node : triangles.reshaped()) ++at_node[static_cast<std::size_t>(node)];
    std::map<int, int> count;
    for (int j = 1; j < 20; ++j)
      for (int i = 1; i < 20; ++i) ++count[at_node[static_cast<std::size_t>(i + 21 * j)]];
    return count;
  };
  CHECK(meeting("box:20x20,triangles") == std::map<int, int>{{6, 361}});
  CHECK(meeting("box:20x20,alternating") == std::map<int, int>{{4, 180}, {8, 181}});
  const auto irregular = meeting("box:20x20,delaunay,perturb=0.24");
  CHECK(irregular.size() >= 4); // 4, 5, 6, 7, 8: no pattern

  // No corner lies within the circle of the triangle across its diagonal: the angles there sum up to at most pi.
  const auto mesh = generated("box:20x20,delaunay,perturb=0.24");
  const auto triangles = elements_of(mesh, Shape::triangle3);
  for (Eigen::Index cell = 0; cell < 400; ++cell) {
    const auto first = triangles.col(2 * cell), second = triangles.col(2 * cell + 1);
    double across = 0.0;
    for (const auto& [t, other] : {std::pair{first, second}, std::pair{second, first}})
      for (Eigen::Index k = 0; k < 3; ++k) {
        if ((other.array() == t[k]).any()) continue;
        const Eigen::Vector2d u = mesh.nodes.col(t[(k + 1) % 3]) - mesh.nodes.col(t[k]);
        const Eigen::Vector2d v = mesh.nodes.col(t[(k + 2) % 3]) - mesh.nodes.col(t[k]);
        across += std::acos(u.dot(v) / (u.norm() * v.norm()));
      }
    CHECK(across <= std::numbers::pi + 1e-7); // acos near its ends loses half the digits
  }
}

TEST_CASE("errors in a domain's text say what would be right")
{
  CHECK(complaint("box:8x8,skew=0.4").find("turns over near (") != std::string::npos);
  CHECK(complaint("box:8x8,ratio=0:1") ==
        "mesh \"box:8x8,ratio=0:1\": the ratio 0 of the last cell's size to the first's; it is above 0");
  CHECK(complaint("arch:8x1,angle=180").find("it is above 0 and below pi") != std::string::npos);
  CHECK(complaint("arch:8x1,thickness=3").find("the thickness is below twice the radius") != std::string::npos);
  CHECK(complaint("duct_arch:34x60,left=0").find("the arch takes -0.17387 to 0.17387") != std::string::npos);
  CHECK(complaint("duct_arch:34x60,height=0.01").find("it lies above the arch") != std::string::npos);
  CHECK(complaint("duct_arch:34x1").find("take other numbers of rows or faces") != std::string::npos);
  CHECK(complaint("duct_arch:34x60,growth=0.9") ==
        "mesh \"duct_arch:34x60,growth=0.9\": cells that grow by the factor 0.9; it is at least 1");
  CHECK(complaint("duct_arch:34x60,right=inf").find("numbers, with : between them") != std::string::npos);
  CHECK(complaint("bump:32x32").find("a multiple of 3") != std::string::npos);
  CHECK(complaint("bump:33x32,height=0.5").find("below 0.5") != std::string::npos);
  CHECK(complaint("cook:8") == "mesh \"cook:8\": 1 numbers of cells; two, say 32x24");
}
