// What is said of meshes and boundaries that cannot be used.
#include "euler/mesh_input.hpp"
#include "euler/patches.hpp"

#include "files/read.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace mullion::euler;

namespace {

template <class Call> std::string message_of(const Call& call)
{
  try {
    call();
  } catch (const MeshError& error) {
    return error.what();
  }
  return "no error";
}

std::string source_error(const std::string& mesh, const std::vector<std::string>& patches)
{
  const auto file = mullion::mesh_files::read_or_generate(mesh, 2);
  return message_of([&] { return source_of<2>(file, patches); });
}

} // namespace

TEST_CASE("boundary faces without a condition are named by their groups")
{
  CHECK(source_error("box:4x2", {"x_min", "y_max"}) ==
        "6 boundary faces have no condition, the first at (0.125000, 0.000000) m; they are in the groups: x_max, "
        "y_min");
}

TEST_CASE("a group that the mesh does not have is answered with those that it has")
{
  CHECK(source_error("box:4x2", {"inlet"}) ==
        "the mesh has no boundary group \"inlet\"; there are: x_min, x_max, y_min, y_max");
}

TEST_CASE("a group has one condition")
{
  PatchTexts texts;
  texts.slip_wall = "a, b";
  texts.farfield = "b";
  CHECK(message_of([&] { patches_of(texts); }) == "group \"b\" has two conditions; a boundary face has one");
}

TEST_CASE("lists of names and pairs are read, and a missing name is an error")
{
  CHECK(names_in(" a, b c ,d") == std::vector<std::string>{"a", "b c", "d"});
  CHECK(names_in("  ").empty());
  CHECK(message_of([] { names_in("a,,b"); }) == "\"a,,b\": a name is missing; expected names with commas between");
  CHECK(pairs_in("a:b, c : d")[1] == std::pair<std::string, std::string>{"c", "d"});
  CHECK(message_of([] { pairs_in("a"); }) == "\"a\": expected two groups with a colon between, as x_min:x_max");
}

TEST_CASE("periodic boundaries that do not fit onto each other are an error")
{
  const auto file = mullion::mesh_files::read_or_generate("box:4x2", 2);
  auto source = source_of<2>(file, {"x_min", "x_max", "y_min", "y_max"});

  source.periodic = {{0, 2}};

  CHECK(message_of([&] { return build_mesh(source); }) ==
        "periodic boundaries have 2 and 4 faces; they must have the same number of them");
}
