// Gmsh's files: those that Gmsh wrote, our own, and broken ones.
#include "files/file_error.hpp"
#include "files/generators.hpp"
#include "files/msh.hpp"
#include "support/mesh_samples.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace mullion::mesh_files;
using namespace mullion::testing;

namespace {

MeshFile parse_sample(const std::string& name) { return parse_msh(name, mesh_sample(name)); }

/// What the reader says of a file; "" if it takes it.
std::string complaint(const std::string& text)
{
  try {
    parse_msh("m.msh", text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& piece) { return text.find(piece) != std::string::npos; }

const std::string head = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string head_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string nodes = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";
const std::string elements = "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n";

} // namespace

TEST_CASE("a mesh of Gmsh is the same in every version and encoding")
{
  const auto mesh = parse_sample("cube_msh41_a.msh");

  CHECK(mesh.dimension == 3);
  CHECK(mesh.nodes.cols() == 12);
  CHECK(elements_of(mesh, Shape::hexahedron8).cols() == 2);
  CHECK(elements_of(mesh, Shape::quadrilateral4).cols() == 4);
  CHECK(find_group(mesh, "wall").elements.size() == 2);
  CHECK(find_group(mesh, "the lid").elements.size() == 1);
  CHECK(find_group(mesh, "99").elements.size() == 2); // its two layers; the geometry gives it no name
  CHECK(find_group(mesh, "edge").dimension == 1);
  CHECK(find_group(mesh, "corner", 0).elements.size() == 1);
  CHECK(find_group(mesh, "body").elements.size() == 2);
  // The lid lies at z = 0.5, and is in "wall" as well.
  const auto lid = only(mesh, find_group(mesh, "the lid"));
  CHECK(lid.nodes.row(2) == Eigen::RowVector4d::Constant(0.5));
  CHECK(only(mesh, find_group(mesh, "wall")).nodes.cols() == 8);
  CHECK(is_same(parse_sample("cube_msh41_b.msh"), mesh));
  const auto older = parse_sample("cube_msh2_a.msh");
  CHECK(older.nodes == mesh.nodes);
  CHECK(elements_of(older, Shape::hexahedron8) == elements_of(mesh, Shape::hexahedron8));
  CHECK(elements_of(older, Shape::quadrilateral4).cols() == 4); // the lid is listed twice, once a group
  for (const auto& group : mesh.groups) CHECK(find_group(older, group.name).elements.size() == group.elements.size());
  CHECK(is_same(parse_sample("cube_msh2_b.msh"), older));
}

TEST_CASE("a binary MSH file of a machine with the other order of bytes is read")
{
  // The bytes of the numbers 1 to 4 and of nodes at 0 and 1 are easy to turn round by hand.
  const auto number = [](int value) { return std::string("\0\0\0", 3) + static_cast<char>(value); };
  const std::string zero(8, '\0'), one = "\x3f\xf0" + std::string(6, '\0'); // 1.0, sign and exponent first
  const auto text = "$MeshFormat\n2.2 1 8\n" + number(1) + "\n$EndMeshFormat\n$Nodes\n2\n" + number(1) + zero + zero +
                    zero + number(2) + one + zero + zero + "\n$EndNodes\n$Elements\n1\n" + number(1) + number(1) +
                    number(1) + number(1) + number(4) + number(2) + number(1) + "\n$EndElements\n";

  const auto mesh = parse_msh("swapped", text);

  CHECK(mesh.nodes == Eigen::RowVector2d(0.0, 1.0));
  CHECK(elements_of(mesh, Shape::line2) == Connectivity(Eigen::Vector2i(1, 0)));
  CHECK(find_group(mesh, "4").dimension == 1);
}

TEST_CASE("every shape has its nodes in their order, and nodes without an element are left out")
{
  const auto mesh = parse_sample("shapes_msh2_a.msh");

  CHECK(elements_of(mesh, Shape::triangle3) == (Connectivity(3, 2) << 0, 0, 1, 5, 5, 4).finished());
  CHECK(elements_of(mesh, Shape::quadrilateral4) == (Connectivity(4, 2) << 0, 1, 3, 8, 2, 9, 1, 2).finished());
  CHECK(elements_of(mesh, Shape::hexahedron8) == (Connectivity(8, 1) << 0, 1, 2, 3, 4, 5, 6, 7).finished());
  CHECK(elements_of(mesh, Shape::tetrahedron4) == (Connectivity(4, 1) << 1, 8, 9, 5).finished());
  CHECK(elements_of(mesh, Shape::pyramid5) == (Connectivity(5, 1) << 0, 1, 2, 3, 6).finished());
  CHECK(elements_of(mesh, Shape::prism6) == (Connectivity(6, 1) << 0, 1, 2, 4, 5, 6).finished());
  CHECK(elements_of(mesh, Shape::line2) == (Connectivity(2, 1) << 0, 1).finished());
  CHECK(elements_of(mesh, Shape::point1) == Connectivity::Constant(1, 1, 8));
  CHECK(mesh.nodes.cols() == 10); // of 11
  CHECK(mesh.nodes.col(9) == Eigen::Vector3d(2.0, 1.0, 0.125));
  CHECK(mesh.node_numbers.back() == 10);
  CHECK(is_same(parse_sample("shapes_msh2_b.msh"), mesh));
}

TEST_CASE("what is written is read again to the bit")
{
  for (const auto& mesh :
       {parse_sample("cube_msh41_a.msh"), parse_sample("shapes_msh2_a.msh"),
        line(3, Eigen::Vector2d(0.1, 0.2), Eigen::Vector2d(1.0 / 3.0, 7.0)),
        box_2d({3, 2, Cells::triangles, {0.2, 5}}, {1.0, 0.3}), box_3d({2, 1, 2}, Volumes::tets, {1, 2, 3})}) {
    const auto again = parse_msh("again", msh_text(mesh), mesh.dimension);

    CHECK(again.nodes == mesh.nodes);
    CHECK(is_sound(again));
    REQUIRE(again.groups.size() == mesh.groups.size());
    for (const auto& group : mesh.groups) {
      const auto& found = find_group(again, group.name, group.dimension);
      REQUIRE(found.elements.size() == group.elements.size());
      CHECK(only(again, found).nodes.sum() == doctest::Approx(only(mesh, group).nodes.sum()).epsilon(1e-14));
    }
    for (const auto& block : mesh.blocks) CHECK(elements_of(again, block.shape).cols() == block.connectivity.cols());
    CHECK(msh_text(parse_msh("again", msh_text(again), mesh.dimension)) == msh_text(again));
  }
}

TEST_CASE("the space is the smallest in which the nodes lie, or the one that is asked for")
{
  CHECK(complaint(head + nodes + elements) == "");
  CHECK(parse_msh("m", head + nodes + elements).dimension == 2);
  CHECK(parse_msh("m", head + nodes + elements, 3).nodes.rows() == 3);
  CHECK_THROWS_WITH_AS(parse_msh("m", head + nodes + elements, 1),
                       "m: node 3 of the mesh has y = 1, so it does not lie in 1 dimensions; ask for 2", FileError);
}

TEST_CASE("errors of MSH files say where, what, and what would be right")
{
  CHECK(complaint("") == "m.msh:1: found \"\"; expected $MeshFormat");
  CHECK(complaint("$MeshFormat\n4 0 8\n") ==
        "m.msh:2: version 4 of the format; versions 2.2 and 4.1 are read (gmsh -format msh41)");
  CHECK(complaint(head + nodes) == "m.msh:14: the file has no $Elements; a mesh has both");
  CHECK(complaint(head + nodes + "$Elements\n1 1 1 1\n2 1 9 1\n") ==
        "m.msh:16: an element of type 9 (triangle6, second order); elements are linear: point, line, triangle, "
        "quadrangle, tetrahedron, hexahedron, prism or pyramid (save the mesh with Mesh.ElementOrder = 1)");
  CHECK(contains(complaint(head + nodes + "$Elements\n1 1 1 1\n2 1 777 1\n"), "type 777 (unknown)"));
  CHECK(contains(complaint(head + nodes + "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 4\n$EndElements\n"),
                 "m.msh:17: element 1 has the node 4; $Nodes, before it, has no node of that number"));
  CHECK(contains(complaint(head + "$Nodes\n1 2 1 2\n2 1 0 2\n1\n1\n0 0 0\n0 0 0\n"), "m.msh:8: a second node 1"));
  CHECK(contains(complaint(head + "$Nodes\n1 1 1 1\n2 1 0 1\n1\n0 zero 0\n"),
                 "m.msh:8: found \"zero\"; expected the y of a node, a number"));
  CHECK(contains(complaint(head + "$Nodes\n1 3 1 3\n2 1 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n"),
                 "the blocks hold 2 nodes; the section announced 3"));
  CHECK(contains(complaint(head + "$PartitionedEntities\n"), "a partitioned mesh"));
  CHECK(contains(complaint(head + "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 nan 0\n0 1 0\n$EndNodes\n" + elements),
                 "node 2 of the mesh has the coordinate y = nan"));
}

TEST_CASE("a number of nodes or elements that the file cannot hold is an error before memory is asked for")
{
  CHECK(contains(complaint(head + "$Nodes\n1 1099511627776 1 9\n"), "1099511627776, but only"));
  CHECK(contains(complaint(head_2 + "$Nodes\n1099511627776\n1 0 0 0\n"), "1099511627776, but only"));
  CHECK(contains(complaint(head_2 + "$Nodes\n-1\n"), "cannot be negative"));
  CHECK(contains(complaint(head_2 + "$Nodes\n99999999999999999999\n"), "an integer"));
}

TEST_CASE("a group that is not there, or whose name two have, is an error that says so")
{
  auto mesh = parse_sample("cube_msh41_a.msh");
  CHECK_THROWS_WITH_AS(
      find_group(mesh, "lid"),
      "the mesh has no group \"lid\"; it has \"corner\", \"edge\", \"wall\", \"99\", \"the lid\", \"body\"", FileError);
  mesh.groups.push_back({"wall", 1, {{1, 0}}});
  CHECK_THROWS_AS(find_group(mesh, "wall"), FileError);
  CHECK(find_group(mesh, "wall", 1).elements.size() == 1);
}
