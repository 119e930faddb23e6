// The results of a run as its readers see them: datasets, attributes, the two indices; the same bytes for the same
// outputs; disks that run full.
#include "io/results_writer.hpp"

#include "io/hdf5_image.hpp"
#include "scratch.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <map>
#include <memory>
#include <regex>

using namespace mullion;
using namespace mullion::io;
using mullion::testing::Scratch;
using mullion::testing::SmallRun;
namespace fs = std::filesystem;

namespace {

void write_run(const fs::path& out, const std::string& name, const std::vector<std::int64_t>& steps)
{
  const SmallRun run;
  ResultsWriter writer(out, name);
  writer.begin(run.mesh());
  for (const auto step : steps) writer.write(step, 1e-3 * static_cast<double>(step), run.fields());
  writer.finish();
}

std::map<std::string, std::string> all_files(const fs::path& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder)] = read_text(entry.path());
  return files;
}

/// An open results file of a run.
class Opened {
public:
  explicit Opened(const fs::path& path) : image_(read_checked(path)), reader_(image_, path.string()) {}
  const ImageReader* operator->() const { return &reader_; }

private:
  Bytes image_;
  ImageReader reader_;
};

} // namespace

TEST_CASE("a run of one name and of another write the same bytes")
{
  const Scratch one, other;

  write_run(one.path(), "one", {0, 10, 20});
  write_run(other.path(), "another-name", {0, 10, 20});

  const auto files = all_files(one.path());
  CHECK(files == all_files(other.path()));
  CHECK(files.size() == 6);
  CHECK(files.contains("results/000000010.h5"));
  for (const auto& [name, content] : files) CHECK(content.find("another-name") == std::string::npos);
}

TEST_CASE("an output holds its fields with unit and location, and step and time")
{
  const Scratch out;
  write_run(out.path(), "run", {30});

  const Opened file(out / "results/000000030.h5");

  CHECK(file->i64_attribute("/", "step") == 30);
  CHECK(file->f64_attribute("/", "time") == 1e-3 * 30.0);
  CHECK(file->f64("/fluid/volume/pane_0/pressure") == std::vector<double>{1e5, 1.5e5});
  CHECK(file->text_attribute("/fluid/volume/pane_0/pressure", "unit") == "Pa");
  CHECK(file->text_attribute("/fluid/volume/pane_0/pressure", "location") == "element");
  CHECK(file->text_attribute("/fluid/volume/pane_0/coordinates", "meaning") == "where the nodes are");
  CHECK(file->extents("/structure/plate/pane_4/stress") == Extents{4, 4});
  CHECK(file->f64("/structure/plate/pane_4/stress")[5] == 22.0); // element 1, component 1
  CHECK(file->text_attribute("/fluid/volume/pane_0/energy", "location") == "pane");
}

TEST_CASE("the geometry is the coordinates, else reference plus displacement, else the reference, "
          "in three components")
{
  const Scratch out;
  write_run(out.path(), "run", {1});

  const Opened file(out / "results/000000001.h5");

  CHECK(file->f64("/fluid/volume/pane_0/geometry") == std::vector<double>{0, 0, 0, 0.625, 0, 0, 1.25, 0, 0});
  CHECK(file->f64("/structure/plate/pane_4/geometry") ==
        std::vector<double>{0, 0, 0, 1.5, 0, 0, 1.5, 1.25, 0, 0, 1, 0, 2, 1, 0});
  CHECK(file->f64("/structure/solid/pane_1/geometry") == SmallRun().solid_x);
}

TEST_CASE("mesh.h5 holds reference coordinates, connectivity by block, and fixed fields")
{
  const Scratch out;
  write_run(out.path(), "run", {1});

  const Opened mesh(out / "results/mesh.h5");
  const std::string plate = "/structure/plate/pane_4/";

  CHECK(mesh->extents(plate + "reference_coordinates") == Extents{5, 2});
  CHECK(mesh->f64(plate + "reference_coordinates") == SmallRun().plate_x);
  CHECK(mesh->i32(plate + "connectivity_1") == std::vector<std::int32_t>{1, 4, 2});
  CHECK(mesh->text_attribute(plate + "connectivity_1", "element") == "triangle3");
  CHECK(mesh->i32(plate + "tag") == std::vector<std::int32_t>{7, 8, 9, 10});
  CHECK(mesh->i64_attribute("/structure/plate/pane_4", "n_elements") == 4);
  // XDMF: quadrilateral 5, triangle 4, polyline 2 and polyvertex 1 with their numbers of nodes
  CHECK(mesh->i32(plate + "topology") == std::vector<std::int32_t>{5, 0, 1, 2, 3, 4, 1, 4, 2, 2, 2, 0, 4, 1, 1, 3});
  // hexahedron 9, pyramid 7, wedge 8, tetrahedron 6
  CHECK(mesh->i32("/structure/solid/pane_1/topology") ==
        std::vector<std::int32_t>{9, 0, 1, 2, 3, 4, 5, 6, 7, 7, 4, 5, 6, 7, 8, 8, 1, 9, 5, 2, 10, 6, 6, 9, 11, 10, 5});
  CHECK_FALSE(mesh->has("/fluid/volume/pane_0/topology"));
}

TEST_CASE("every dataset that results.xdmf names exists and has the extents it says")
{
  const Scratch out;
  write_run(out.path(), "run", {0, 7});
  const auto text = read_text(out / "results.xdmf");
  const std::regex item(R"re(<DataItem Dimensions="([0-9 ]+)" NumberType="(\w+)"[^>]*>([^<:]+):([^<]+)</DataItem>)re");
  std::map<std::string, std::unique_ptr<Opened>> files;

  int n_items = 0;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), item); it != std::sregex_iterator(); ++it) {
    auto& file = files[(*it)[3]];
    if (file == nullptr) file = std::make_unique<Opened>(out / (*it)[3].str());
    const std::string path = (*it)[4];
    REQUIRE((*file)->has(path));
    std::string extents;
    for (const auto n : (*file)->extents(path)) extents += (extents.empty() ? "" : " ") + std::to_string(n);
    CHECK(extents == (*it)[1].str());
    if ((*it)[2] == "Int") CHECK_NOTHROW((void)(*file)->i32(path));
    else CHECK_NOTHROW((void)(*file)->f64(path));
    ++n_items;
  }

  // per output: 3 topologies, 3 geometries, 1 fixed field, 3 + 2 + 1 fields
  CHECK(n_items == 2 * 13);
  CHECK(files.size() == 3);
  CHECK(text.find("driver/state") == std::string::npos); // a grid without nodes is no grid
}

TEST_CASE("results.h5 links to the outputs and lists their steps and times")
{
  const Scratch out;
  write_run(out.path(), "run", {0, 7});

  const Opened index(out / "results.h5");

  CHECK(index->names("/") == std::vector<std::string>{"000000000", "000000007", "mesh", "steps", "times"});
  CHECK(index->i64("/steps") == std::vector<std::int64_t>{0, 7});
  CHECK(index->f64("/times") == std::vector<double>{0.0, 1e-3 * 7.0});
}

TEST_CASE("a run that goes on in the same folder ends with the index of one that never stopped")
{
  const Scratch whole, parts;
  write_run(whole.path(), "run", {0, 10, 20, 30});
  const SmallRun run;
  OutputList at_step_15;
  {
    ResultsWriter writer(parts.path(), "run");
    writer.begin(run.mesh());
    for (const std::int64_t step : {0, 10, 20}) { // 20 lies behind the checkpoint of step 15
      if (step == 20) at_step_15 = writer.outputs();
      writer.write(step, 1e-3 * static_cast<double>(step), run.fields());
    }
  }
  REQUIRE(fs::exists(parts / "results/000000020.h5"));

  ResultsWriter writer(parts.path(), "run");
  writer.go_on_from(at_step_15);
  CHECK(!fs::exists(parts / "results/000000020.h5"));
  CHECK(writer.has_output(10));
  CHECK(!writer.has_output(20));
  writer.begin(run.mesh());
  writer.write(20, 1e-3 * 20.0, run.fields());
  writer.write(30, 1e-3 * 30.0, run.fields());
  writer.finish();

  CHECK(all_files(parts.path()) == all_files(whole.path()));
}

TEST_CASE("nodes without elements are shown as points, whether there are blocks or not")
{
  const Scratch out;
  const SmallRun run;
  const PaneData cloud{7, 1, 3, 0, run.column_x.data(), {}, {}};
  auto empty_block = cloud;
  empty_block.id = 8;
  empty_block.blocks = {{MULLION_LINE2, 2, 0, nullptr}};

  ResultsWriter writer(out.path(), "run");
  writer.begin({{"probe/points", {cloud, empty_block}}});
  writer.write(0, 0.0, {{"probe/points", {cloud, empty_block}}});
  writer.finish();

  const Opened mesh(out / "results/mesh.h5");
  const auto text = read_text(out / "results.xdmf");
  for (const std::string pane : {"/probe/points/pane_7", "/probe/points/pane_8"}) {
    CHECK(mesh->i32(pane + "/topology") == std::vector<std::int32_t>{0, 1, 2});
    CHECK(text.find("mesh.h5:" + pane + "/topology") != std::string::npos);
  }
}

TEST_CASE("after a flush the indices name all outputs so far")
{
  const Scratch out;
  const SmallRun run;
  ResultsWriter writer(out.path(), "run");
  writer.begin(run.mesh());
  for (const std::int64_t step : {1, 2, 3}) writer.write(step, 0.1, run.fields());

  writer.flush();

  CHECK(Opened(out / "results.h5")->i64("/steps") == std::vector<std::int64_t>{1, 2, 3});
  CHECK(writer.wait_for_outputs());
}

TEST_CASE("outputs whose files went away are not kept, and a damaged list is refused")
{
  const Scratch out;
  write_run(out.path(), "run", {0, 10, 20});
  fs::remove(out / "results/000000010.h5");
  const OutputList list{{0, 10, 20}, {0.0, 0.01, 0.02}, {0, 0, 0}, {"layout"}};

  ResultsWriter writer(out.path(), "run");
  writer.go_on_from(list);

  CHECK(writer.outputs().steps == std::vector<std::int64_t>{0, 20});
  CHECK_THROWS_WITH(ResultsWriter(out.path(), "run").go_on_from({{0}, {0.0}, {1}, {"layout"}}),
                    "the output of step 0 has layout 1 of 1");
  CHECK_THROWS_WITH(ResultsWriter(out.path(), "run").go_on_from({{0, 1}, {0.0}, {0}, {"layout"}}),
                    "a list of outputs has 2 steps, 1 times and 1 layouts");
}

TEST_CASE("a result file that is there already is replaced")
{
  const Scratch out;
  make_folder(out / "results");
  std::ofstream(out / "results/000000001.h5") << "something else";

  write_run(out.path(), "run", {1});

  CHECK(Opened(out / "results/000000001.h5")->i64_attribute("/", "step") == 1);
}

TEST_CASE("results that cannot be written are an error at the next call, and the index names only "
          "what is there")
{
  const Scratch out;
  const int child = ::fork(); // a process of its own: the limit holds for all its threads
  if (child == 0) {
    int code = 10;
    try {
      const SmallRun run;
      std::vector<double> many(20000, 1.0);
      auto fields = run.fields();
      ResultsWriter writer(out.path(), "run");
      writer.begin(run.mesh());
      writer.write(1, 0.1, fields);
      fields[0].panes[0].fields.push_back({"wide", "1", {}, MULLION_PANE, 20000, 1, many.data(), nullptr});
      const rlimit limit{50000, 50000};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      writer.write(2, 0.2, fields);
      code = 11;
      try {
        writer.write(3, 0.3, run.fields());
      } catch (const Error& error) {
        const std::string text = error.what();
        const bool is_clear = error.code() == Errc::io && text.find("run 'run': cannot write") == 0 &&
                              text.find("results/000000002.h5") != std::string::npos;
        code = is_clear ? 0 : 12;
      }
      writer.finish();
    } catch (...) {
      code = 13;
    }
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);

  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  CHECK(Opened(out / "results.h5")->i64("/steps") == std::vector<std::int64_t>{1});
  CHECK_FALSE(fs::exists(out / "results/000000002.h5"));
}

TEST_CASE("a folder that cannot be made fails at the start")
{
  const Scratch out;
  std::ofstream(out / "results") << "a file";

  ResultsWriter writer(out.path(), "run");

  CHECK_THROWS_WITH_AS(writer.begin(SmallRun().mesh()), doctest::Contains("results"), Error);
}

TEST_CASE("fields that do not fit their pane, and panes that are not in the mesh, are refused")
{
  const Scratch out;
  const SmallRun run;
  ResultsWriter writer(out.path(), "run");
  writer.begin(run.mesh());
  auto short_field = run.fields(), renamed = run.fields(), unknown = run.fields();
  short_field[0].panes[0].fields[1].entities = 1;
  renamed[0].panes[0].fields[1].name = "geometry";
  unknown[0].panes[0].id = 5;

  CHECK_THROWS_WITH_AS(writer.write(1, 0.1, short_field), doctest::Contains("pressure has 1 entries"), Error);
  CHECK_THROWS_WITH_AS(writer.write(1, 0.1, renamed), doctest::Contains("geometry"), Error);
  CHECK_THROWS_WITH_AS(writer.write(1, 0.1, unknown), doctest::Contains("pane_5"), Error);
  writer.write(1, 0.1, run.fields()); // and the writer is none the worse
  writer.finish();
  CHECK(Opened(out / "results.h5")->i64("/steps") == std::vector<std::int64_t>{1});
}
