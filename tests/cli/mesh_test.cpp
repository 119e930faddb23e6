// `mullion mesh`: what it writes reads back to the mesh that went in, what it prints is right where the numbers are
// known by hand, and what cannot be done is refused as `mullion run` and `mullion check` refuse it.
#include "support/mesh_samples.hpp"
#include "support/run_case.hpp"

#include "files/read.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace mullion::test;
namespace mesh_files = mullion::mesh_files;

namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string plane_case = MULLION_SOURCE_DIR "/configs/paper/superseismic_lite.toml";

ProcessResult mesh(const RunFolder& folder, const std::string& file, const std::vector<std::string>& sets,
                   const std::string& out = "out")
{
  std::vector<std::string> arguments = {"mesh", file, "--out", (folder / out).string()};
  for (const auto& set : sets) arguments.insert(arguments.end(), {"--set", set});
  return folder.command(arguments);
}

/// The nodes of each element of a group, in the order of these.
std::vector<std::vector<int>> elements_in(const mesh_files::MeshFile& mesh, const mesh_files::Group& group)
{
  std::vector<std::vector<int>> elements;
  for (const auto& [block, column] : group.elements) {
    const auto nodes = mesh.blocks[static_cast<std::size_t>(block)].connectivity.col(column);
    elements.emplace_back(nodes.begin(), nodes.end());
  }
  std::sort(elements.begin(), elements.end());
  return elements;
}

/// Nodes to the bit, elements of the largest dimension in their order, and groups; Gmsh's files begin with the elements
/// of the smallest dimension, so the order of the others does not count.
bool is_same(const mesh_files::MeshFile& a, const mesh_files::MeshFile& b)
{
  bool is_same = a.nodes == b.nodes && a.blocks.size() == b.blocks.size() && a.groups.size() == b.groups.size();
  for (const auto& block : a.blocks) {
    const auto other = mullion::testing::elements_of(b, block.shape);
    const bool is_cell = mesh_files::facts(block.shape).dimension == a.dimension;
    is_same &= other.cols() == block.connectivity.cols() && (!is_cell || other == block.connectivity);
  }
  for (const auto& group : a.groups)
    is_same =
        is_same && elements_in(a, group) == elements_in(b, mesh_files::find_group(b, group.name, group.dimension));
  return is_same;
}

/// A block by itself, in space.
std::string solid_case(const RunFolder& folder, const std::string& mesh_text)
{
  const auto file = (folder / "solid.toml").string();
  std::ofstream(file) << "[run]\nname = \"solid\"\nend_time = 1e-3\ndt = 1e-4\n"
                         "[structure]\nmodule = \"elastic_solid\"\nwet = \"z_max\"\nclamped = \"z_min\"\nmesh = \""
                      << mesh_text << "\"\n[driver]\nscheme = \"uncoupled\"\n";
  return file;
}

} // namespace

TEST_CASE("the meshes that are written in Gmsh's format read back as the meshes that went in, groups and all")
{
  const RunFolder folder;
  const std::string fluid = "box:9x6,triangles,size=0.8x0.4,perturb=0.2", structure = "box:7x5,size=0.8x0.4";

  const auto result = mesh(folder, plane_case, {"fluid.mesh=" + fluid, "structure.mesh=" + structure});

  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  CHECK(result.err == "");
  CHECK(is_same(mesh_files::read_mesh((folder / "out/fluid.msh").string(), 2), mesh_files::read_or_generate(fluid, 2)));
  CHECK(is_same(mesh_files::read_mesh((folder / "out/structure.msh").string(), 2),
                mesh_files::read_or_generate(structure, 2)));
  // and a run takes the file in the place of the generator's text
  const auto again =
      mesh(folder, plane_case, {"fluid.mesh=" + (folder / "out/fluid.msh").string(), "structure.mesh=" + structure},
           "again");
  REQUIRE_MESSAGE(again.exit_code == 0, again.err);
  CHECK(
      is_same(mesh_files::read_mesh((folder / "again/fluid.msh").string(), 2), mesh_files::read_or_generate(fluid, 2)));
}

TEST_CASE("a mesh in space goes to Gmsh's format and back, too")
{
  for (const char* text : {"box:3x2x2,tets,size=1x1x0.5", "box:3x2x2,size=1x1x0.5"}) {
    CAPTURE(text);
    const RunFolder folder;

    const auto result = mesh(folder, solid_case(folder, text), {});

    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
    CHECK(is_same(mesh_files::read_mesh((folder / "out/structure.msh").string(), 3),
                  mesh_files::read_or_generate(text, 3)));
  }
}

TEST_CASE("the summary of a mesh has the numbers that one counts by hand")
{
  const RunFolder folder;

  // Cells of 0.2 by 0.1: 20 of them, 30 nodes, all alike.
  const auto result = mesh(folder, plane_case,
                           {"fluid.mesh=box:4x5,size=0.8x0.5", "structure.mesh=box:2x1,triangles,size=0.8x0.4",
                            "fluid.initial_mesh_displacement=0; 0"});

  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  CHECK(has(result.out, "fluid/volume: 30 nodes, 20 quadrilaterals\n"
                        "  extent          (0, 0) to (0.8, 0.5) m\n"
                        "  each cell       0.02 m^2\n"
                        "  worst shape     1 at "));
  CHECK(has(result.out, "fluid/wall: 5 nodes, 4 lines\n"));
  CHECK(has(result.out, "  boundaries      x_min 5, x_max 5, y_min 4, y_max 4\n"));
  // Half squares of 0.4 m: 4 sqrt(3) A / sum l^2 = 4 sqrt(3) 0.08 / (4 * 0.16) = 0.866.
  CHECK(has(result.out, "structure/volume: 6 nodes, 4 triangles\n"));
  CHECK(has(result.out, "  each cell       0.08 m^2\n  worst shape     0.866 at "));
  CHECK(result.out == read_file(folder / "out/meshes.txt"));
}

TEST_CASE("the first state stands beside the meshes as the results of step 0, and nothing else")
{
  const RunFolder folder;

  const auto result = mesh(folder, MULLION_SOURCE_DIR "/configs/closed_piston.toml", {"run.name=live"});

  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  CHECK(fs::exists(folder / "out/results.xdmf"));
  CHECK(fs::exists(folder / "out/results/mesh.h5"));
  CHECK(fs::exists(folder / "out/results/000000000.h5"));
  CHECK(std::distance(fs::directory_iterator(folder / "out/results"), fs::directory_iterator()) == 2);
  CHECK_FALSE(fs::exists(folder / "out/history.csv"));
  CHECK_FALSE(fs::exists(folder / "out/run.json"));
  CHECK(has(read_file(folder / "out/results.xdmf"), "fluid/volume"));
  CHECK(folder.is_deserted_within(std::chrono::seconds(5)));
}

TEST_CASE("what mullion mesh cannot do is refused as run and check refuse it")
{
  const RunFolder folder;

  SUBCASE("a broken case: the list of its mistakes, word for word that of check")
  {
    const auto result = mesh(folder, plane_case, {"fluid.mehs=box:4x4", "structure.density=-1"});
    const auto check =
        folder.command({"check", plane_case, "--set", "fluid.mehs=box:4x4", "--set", "structure.density=-1"});

    CHECK(result.exit_code == 2);
    CHECK(result.err == check.err);
    CHECK(has(result.err, "2 mistakes"));
    CHECK(result.out == "");
    CHECK_FALSE(fs::exists(folder / "out"));
  }
  SUBCASE("a mesh that does not fit its boundaries: the module's own message")
  {
    const auto result = mesh(folder, plane_case, {"fluid.moving_wall=floor"});

    CHECK(result.exit_code == 2);
    CHECK(has(result.err, "mullion: error: module 'fluid' (euler, inline) failed in define"));
    CHECK(has(result.err, "the mesh has no boundary group \"floor\"; there are: x_min, x_max, y_min, y_max"));
  }
  SUBCASE("a folder that cannot be made")
  {
    std::ofstream(folder / "file") << "in the way";
    const auto result = mesh(folder, plane_case, {}, "file/out");

    CHECK(result.exit_code == 1);
    CHECK(has(result.err, "mullion: error: "));
    CHECK(has(result.err, (folder / "file").string()));
  }
  SUBCASE("the folder of a run, whose results would be gone")
  {
    fs::create_directory(folder / "out");
    std::ofstream(folder / "out/run.json") << "{}";
    const auto result = mesh(folder, plane_case, {});

    CHECK(result.exit_code == 2);
    CHECK(has(result.err, "holds the results of a run (run.json); give another folder with --out"));
  }
  SUBCASE("no case")
  {
    const auto result = folder.command({"mesh"});

    CHECK(result.exit_code == 2);
    CHECK(result.err == "mullion: error: mesh: no case given; expected mullion mesh CASE [options] (see mullion mesh "
                        "--help)\n");
  }
}
