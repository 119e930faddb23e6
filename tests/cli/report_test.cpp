// `mullion report`: the page and the plots of runs, good and bad, and of studies; in a browser, where there is one.
#include "support/browser.hpp"
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <string>
#include <vector>

using namespace mullion::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* closed_piston = MULLION_SOURCE_DIR "/configs/closed_piston.toml";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void write(const fs::path& file, const std::string& text)
{
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// The piston, inline, for 200 steps of 6.1 us.
ProcessResult run_piston(const RunFolder& folder)
{
  return folder.run({.file = closed_piston, .sets = {"run.end_time=1.2e-3", "output.every=0"}, .flags = {"--inline"}});
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at)
{
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = (value << 8) | static_cast<unsigned char>(bytes.at(i));
  return value;
}

/// Signature, a header chunk with a size that can be read, the end chunk.
void check_png(const fs::path& file)
{
  const auto bytes = read_file(file);
  REQUIRE_MESSAGE(bytes.size() > 2000, file.string()); // an empty drawing of 900 px is about 1 kB
  CHECK(bytes.starts_with("\x89PNG\r\n\x1a\n"));
  CHECK(bytes.substr(12, 4) == "IHDR");
  CHECK(big_endian(bytes, 16) == 900);
  CHECK(big_endian(bytes, 20) > 100);
  CHECK(bytes.substr(bytes.size() - 8, 4) == "IEND");
}

/// The page loads nothing and runs nothing, and shows every plot that lies beside it.
/// @return the page
std::string check_report(const fs::path& results, std::size_t n_plots)
{
  const auto html = read_file(results / "report/report.html");
  REQUIRE(html.starts_with("<!DOCTYPE html>"));
  CHECK_FALSE(has(html, "<script"));
  CHECK_FALSE(has(html, "<link"));
  CHECK_FALSE(has(html, "@import"));
  const std::regex address("https?://[^\"'<> ]*");
  for (auto at = std::sregex_iterator(html.begin(), html.end(), address); at != std::sregex_iterator(); ++at)
    CHECK_MESSAGE((at->str() == "http://www.w3.org/2000/svg" || at->str() == "http://www.w3.org/1999/xlink"),
                  "refers to ", at->str()); // the two XML namespaces

  std::size_t n_files = 0;
  std::error_code none; // a report without plots has no need of the folder
  for (const auto& entry : fs::directory_iterator(results / "report/plots", none)) {
    ++n_files;
    const auto name = entry.path().filename().string();
    CHECK_MESSAGE(has(html, "\"plots/" + name + "\""), "the page does not name ", name);
    if (entry.path().extension() == ".png") check_png(entry.path());
    else CHECK_MESSAGE(has(read_file(entry.path()), "</svg>"), name);
  }
  CHECK(n_files == 2 * n_plots);
  std::size_t n_figures = 0;
  for (auto at = html.find("<figure>"); at != std::string::npos; at = html.find("<figure>", at + 1)) ++n_figures;
  CHECK(n_figures == n_plots);
  return html;
}

/// The page in a browser that has no network, or a note that there is none.
void check_looks(const fs::path& results, const fs::path& scratch, std::size_t n_plots)
{
  if (!has_browser()) {
    MESSAGE("skipped 1 check in a browser: there is no chromium on the PATH (package chromium)");
    return;
  }
  const auto looks = look_at(results / "report/report.html", scratch);

  CHECK(looks.problems == "");
  CHECK(looks.n_loaded == 0);
  CHECK(looks.n_plots == static_cast<int>(n_plots));
  CHECK(looks.n_texts > 8 * looks.n_plots); // numbers and titles of the axes
}

/// A run's record with what a page could trip over: names with all that HTML, gnuplot and shells take for their own.
constexpr const char* odd_record = R"json({
 "name": "odd <b>run</b>", "outcome": "failed",
 "columns": {"s.wet.displacement_x.mean": "m", "s.wet.displacement_x.max": "m", "`touch hacked`": "m/s",
             "@x 'y' \"z\" $w {a_b^c} <i>": "m/s", "e.energy": "J", "one.two": "1"},
 "attempts": [
  {"outcome": "stopped", "error": "Ctrl-C", "start": "2024-05-01T12:00:00Z", "versions": {"mullion": "0.1.0"},
   "driver": "d", "modules": [], "restarted_from": "", "first_step": 0, "steps": 10, "simulated_time": 0.1,
   "wall_s": 1.0, "timings": [], "events": [], "files": []},
  {"outcome": "failed", "error": "module 'fluid' <died> & was buried", "start": "2024-05-01T13:00:00Z",
   "versions": {"mullion": "0.1.0"}, "driver": "d",
   "modules": [{"instance": "fluid", "kind": "fluid", "module": "f", "version": "1", "process": true}],
   "restarted_from": "checkpoint-10.h5", "first_step": 10, "steps": 5000, "simulated_time": 5.0, "wall_s": null,
   "timings": [{"who": "fluid", "call": "step", "count": 3, "wall_s": 3.0, "work_s": 1.0, "wait_s": 2.0}],
   "events": [{"step": 3, "what": "respawn", "instance": "fluid", "detail": "killed"}], "files": []}]})json";

/// 5000 rows: a spike, values that are not finite, a constant, a last line that is cut.
std::string odd_history()
{
  std::string text = "step,time,s.wet.displacement_x.mean,s.wet.displacement_x.max,`touch hacked`,"
                     "\"@x 'y' \"\"z\"\" $w {a_b^c} <i>\",e.energy,one.two,d.residual,empty\n";
  for (int i = 0; i < 5000; ++i) {
    const double t = 1e-3 * i;
    text += std::to_string(i) + "," + std::to_string(t) + "," + std::to_string(std::sin(t)) + "," +
            (i == 2500 ? "20" : std::to_string(1.0 + std::sin(t))) + "," + (i > 4000 ? "nan" : std::to_string(t)) + ",";
    text += std::to_string(std::cos(t)) + ",1000000." + std::to_string(i % 100) + ",3," +
            (i % 7 == 0 ? "0" : "1e-" + std::to_string(i % 12)) + ",\n";
  }
  return text + "5000,5.";
}

/// Three axes: two texts, six numbers over more than two decades, three numbers; a failed run, values with both signs,
/// values that are missing and have a bound.
void write_sample_study(const fs::path& folder)
{
  std::string table = "index,scheme,fluid.density,run.dt,outcome,lambda,lambda.residual,doubling,doubling.bound,"
                      "iterations,iterations.max,nothing,message\n";
  int index = 0;
  for (const std::string scheme : {"CSS", "\"GSS, <linear> \"\"x\"\"\""})
    for (const int density : {1, 10, 1000})
      for (const double dt : {1e-6, 1e-5, 2e-5, 1e-4, 2e-4, 1e-3}) {
        const double lambda = (scheme == "CSS" ? 1.0 : -0.5) * dt * 1e4 / density;
        const bool is_failed = density == 1 && dt == 1e-3, is_reached = lambda > 0.02;
        std::string row =
            std::to_string(index++) + "," + scheme + "," + std::to_string(density) + "," + std::to_string(dt) + ",";
        if (is_failed) row += "failed,,,,,,,,\"module 'fluid' failed: density is negative, step 17\"\n";
        else
          row += "completed," + std::to_string(lambda) + ",0.001," + (is_reached ? std::to_string(lambda) : "") + "," +
                 (is_reached ? "" : "0.02") + ",2.5,7,,\n";
        table += row;
      }
  write(folder / "study.csv", table);
  write(folder / "study.json", R"json({"name": "sample", "case": "../closed_piston.toml", "axes": [
    {"name": "scheme", "keys": ["driver.scheme", "driver.profile"], "labels": ["CSS", "GSS"]},
    {"name": "fluid.density", "keys": ["fluid.density"], "labels": null},
    {"name": "run.dt", "keys": ["run.dt"], "labels": null}], "measures": [
    {"name": "lambda", "kind": "growth_rate", "quantity": "structure.wet.displacement"},
    {"name": "doubling", "kind": "error_doubling", "quantity": "structure.wet.displacement"},
    {"name": "iterations", "kind": "iterations", "quantity": ""},
    {"name": "nothing", "kind": "last", "quantity": "x"}], "runs": 36, "failed": 2})json");
}

} // namespace

TEST_CASE("the look in a browser finds what is too wide, cut off, over each other or loaded")
{
  if (!has_browser()) {
    MESSAGE("skipped 1 check in a browser: there is no chromium on the PATH (package chromium)");
    return;
  }
  const RunFolder folder;
  write(folder / "page.html", R"html(<!DOCTYPE html><html><body>
    <p style="width: 3000px">wide</p><img src="http://example.org/x.png">
    <svg width="300" height="100"><text x="290" y="50">at the edge</text>
    <text x="10" y="50">first</text><text x="15" y="52">second</text><text x="10" y="80">third</text></svg>
    </body></html>)html");

  const auto looks = look_at(folder / "page.html", folder.path());

  CHECK(looks.n_plots == 1);
  CHECK(looks.n_texts == 4);
  CHECK(looks.n_loaded == 1);
  CHECK(has(looks.problems, "page: 30"));
  CHECK(has(looks.problems, "P beyond the page: wide"));
  CHECK(has(looks.problems, "cut off: at the edge"));
  CHECK(has(looks.problems, "over each other: first | second"));
  CHECK_FALSE(has(looks.problems, "third"));
}

// Seven quantities of the interface, energies and works, two pairs of ledger plots, total mass, applied load, impulse,
// timings: a column that comes or goes shows here.
constexpr std::size_t n_piston_plots = 17;

TEST_CASE("the report of a run is one page with its plots, and nothing on it is cut off")
{
  const RunFolder folder;
  REQUIRE(run_piston(folder).exit_code == 0);

  const auto result = folder.command({"report", "out"});

  REQUIRE(result.exit_code == 0);
  CHECK(result.err == "");
  CHECK(result.out == "out/report/report.html (17 plots)\n");
  const auto html = check_report(folder / "out", n_piston_plots);
  for (const char* text : {"<h1>Run closed-piston</h1>", "completed", "structure.wet.displacement [m]", "time [s]",
                           "structure.wet.velocity [m/s]", "change of ", "wall time [s]", "wall time per step",
                           "youngs_modulus = 2800000", "elastic_bar", "initial state"})
    CHECK_MESSAGE(has(html, text), text);
  check_looks(folder / "out", folder.path(), n_piston_plots);
}

TEST_CASE("the report of a moving plane mesh shows its fields and its displacement, and residuals over decades")
{
  const RunFolder folder;
  // lifted by up to 0.0009765625 * 4 m * 2 = 7.8125 mm, of a mesh 4 m long: too little to be seen
  write(folder / "case.toml", "[run]\nname = \"waving\"\nend_time = 2.0\ndt = 1.0\n"
                              "[fluid]\nmodule = \"waving_fluid\"\namplitude = 0.0009765625\n"
                              "[driver]\nscheme = \"uncoupled\"\n[output]\nevery = 1\n");
  const auto run = folder.run({.file = (folder / "case.toml").string(), .sets = {}, .flags = {"--inline"}});
  REQUIRE_MESSAGE(run.exit_code == 0, run.err);

  const auto result = folder.command({"report", "out"});

  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  CHECK(result.out == "out/report/report.html (6 plots)\n"); // four pictures, the residual, the timings
  const auto html = check_report(folder / "out", 6);
  for (const char* text :
       {"<h2>Fields</h2>", "The last output, of step 2, t = 2 s", "<h3>fluid.volume: pressure at t = 2 s</h3>",
        "<h3>fluid.volume: magnitude of velocity at t = 2 s</h3>", "<h3>fluid.volume: displacement at t = 2 s</h3>",
        "drawn 50 times as large</h3>", "<h2>Residuals</h2>"})
    CHECK_MESSAGE(has(html, text), text);
  CHECK(has(html, "src=\"data:image/png;base64,iVBORw0KGgo")); // the signature of PNG in base 64
  const auto pressure = read_file(folder / "out/report/plots/fluid_volume-pressure.svg");
  std::size_t n_cells = 0;
  for (auto at = pressure.find("<polygon fill"); at != std::string::npos; at = pressure.find("<polygon fill", at + 1))
    ++n_cells;
  CHECK(n_cells >= 4 + 8); // a row of quadrilaterals, a row of triangles; those of the colour bar
  const auto residual = read_file(folder / "out/report/plots/Residuals-solver_residual.svg");
  for (const char* tick : {">1<", ">0.1<", ">0.01<"}) CHECK_MESSAGE(has(residual, tick), "no tick at ", tick);
  CHECK_FALSE(has(residual, ">0.4<")); // where a linear axis has one
}

TEST_CASE("a report again leaves no plot of the one before")
{
  const RunFolder folder;
  REQUIRE(run_piston(folder).exit_code == 0);
  write(folder / "out/report/plots/old.svg", "<svg></svg>");
  write(folder / "out/report/plots/old.png", "old");

  REQUIRE(folder.command({"report", "out"}).exit_code == 0);

  check_report(folder / "out", n_piston_plots); // it would name neither
}

TEST_CASE("a failed run with odd names, a spike and values that are not finite has a whole report")
{
  const RunFolder folder;
  write(folder / "out/run.json", odd_record);
  write(folder / "out/history.csv", odd_history());
  write(folder / "out/case.toml", "# <script>alert(1)</script>\n");

  const auto result = folder.command({"report", "out"});

  REQUIRE(result.exit_code == 0);
  CHECK(result.out == "out/report/report.html (6 plots)\n");
  const auto html = check_report(folder / "out", 6);
  CHECK(has(html, "<h1>Run odd &lt;b&gt;run&lt;/b&gt;</h1>"));
  CHECK(has(html, "<div class=\"error\">module &#39;fluid&#39; &lt;died&gt; &amp; was buried</div>"));
  CHECK(has(html, "checkpoint-10.h5"));
  CHECK(has(html, "Ctrl-C"));
  CHECK(has(html, "respawn"));
  CHECK(has(html, "# &lt;script&gt;alert(1)"));
  CHECK(has(html, "5000 steps, thinned out"));
  CHECK(has(html, "Columns of history.csv without a finite number: empty"));
  CHECK(has(html, "999 values are not finite"));   // steps 4001 to 4999
  CHECK(has(html, "715 values are not positive")); // steps 0, 7, …, 4998
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    CHECK_MESSAGE(entry.path().filename() != "hacked", "a name of a column was run as a command");
  check_looks(folder / "out", folder.path(), 6);
}

TEST_CASE("a run without history, with a part of one, or still under way has a report that says so")
{
  const RunFolder folder;
  const auto report = [&](const char* history) {
    write(folder / "out/run.json", R"({"name": "early", "outcome": "running", "attempts": [{"outcome": "running"}]})");
    fs::remove(folder / "out/history.csv");
    if (history != nullptr) write(folder / "out/history.csv", history);
    const auto result = folder.command({"report", "out"});
    CHECK_MESSAGE(result.exit_code == 0, result.err);
    return read_file(folder / "out/report/report.html");
  };

  const auto none = report(nullptr);
  CHECK(has(none, "There is no history.csv"));
  CHECK(has(none, "<p class=\"outcome running\">running</p>"));
  CHECK(has(none, "The run goes on, or ended without anyone left to say how"));
  CHECK(has(report(""), "history.csv is empty"));
  CHECK(has(report("step,ti"), "history.csv has no whole header"));
  CHECK(has(report("step,time,a.b\n"), "history.csv has a header and no rows"));
  CHECK(has(report("step,time\n0,0\n"), "history.csv has no columns but step and time"));
  CHECK(has(report("step,time,a.b\n0,0,1\n1,0.1"), "<figure>")); // one row
  CHECK(has(report("step,time,a.b\n0,0,nan\n1,0.1,nan\n"), "without a finite number: a.b"));
}

TEST_CASE("the report of a study draws each measure over the numbers that vary most, and lists all runs")
{
  const RunFolder folder;
  write_sample_study(folder / "study");

  const auto result = folder.command({"report", "study"});

  REQUIRE(result.exit_code == 0);
  CHECK(result.err == "");
  CHECK(result.out == "study/report/report.html (3 plots)\n");
  const auto html = check_report(folder / "study", 3);
  CHECK(has(html, "34 of 36 runs completed, 2 failed"));
  CHECK(has(html, ">run.dt<"));                                                         // the axis
  CHECK(has(html, "CSS, fluid.density = 10<"));                                         // a curve
  CHECK(has(html, "GSS, &lt;linear&gt; &quot;x&quot;"));                                // a label in the table
  CHECK(has(html, "bound, where there is no value"));                                   // of the doubling time
  CHECK(has(html, "<p>nothing: last of x: no run has a value.</p>"));                   // of a column without any
  CHECK(has(html, "module &#39;fluid&#39; failed: density is negative, step 17</td>")); // why a run has no value
  std::size_t n_failed = 0;
  for (auto at = html.find("<tr class=\"failed\">"); at != std::string::npos;
       at = html.find("<tr class=\"failed\">", at + 1))
    ++n_failed;
  CHECK(n_failed == 2);
  check_looks(folder / "study", folder.path(), 3);
}

TEST_CASE("a study over labels alone has a row for each of them")
{
  const RunFolder folder;
  write(folder / "study/study.csv",
        "index,scheme,outcome,lambda\n0,CSS,completed,0.1\n1,a long label,completed,-0.2\n");
  write(folder / "study/study.json", R"json({"name": "labels", "case": "a.toml",
    "axes": [{"name": "scheme", "keys": ["driver.scheme"], "labels": ["CSS", "a long label"]}],
    "measures": [{"name": "lambda", "kind": "growth_rate", "quantity": "q"}], "runs": 2, "failed": 0})json");

  REQUIRE(folder.command({"report", "study"}).exit_code == 0);

  const auto svg = read_file(folder / "study/report/plots/lambda.svg");
  CHECK(has(svg, "a long label"));
  CHECK(has(svg, ">lambda<"));
  check_report(folder / "study", 1);
}

TEST_CASE("without gnuplot there is one message that names the package")
{
  const RunFolder folder;
  REQUIRE(run_piston(folder).exit_code == 0);
  fs::create_directory(folder / "bin");

  const auto result = run_process({MULLION_BUILD_DIR "/bin/mullion", "report", (folder / "out").string()},
                                  {.environment = {{"PATH", (folder / "bin").string()}}, .folder = ""});

  CHECK(result.exit_code == 1);
  CHECK(result.out == "");
  CHECK(result.err == "mullion: error: a report is drawn by gnuplot, which is not on the PATH; install the package "
                      "gnuplot-nox\n");
  CHECK_FALSE(fs::exists(folder / "out/report"));
}

TEST_CASE("a gnuplot that fails is one message with what it said")
{
  const RunFolder folder;
  REQUIRE(run_piston(folder).exit_code == 0);
  write(folder / "bin/gnuplot", "#!/bin/sh\necho 'no such terminal' >&2\nexit 3\n");
  fs::permissions(folder / "bin/gnuplot", fs::perms::owner_all);

  const auto result = run_process({MULLION_BUILD_DIR "/bin/mullion", "report", (folder / "out").string()},
                                  {.environment = {{"PATH", (folder / "bin").string()}}, .folder = ""});

  CHECK(result.exit_code == 1);
  CHECK(result.err == "mullion: error: gnuplot failed with exit code 3: no such terminal\n");
}

TEST_CASE("a folder that holds no results, and results that are damaged, are errors")
{
  const RunFolder folder;
  fs::create_directory(folder / "empty");
  write(folder / "bad/run.json", R"({"name": "bad", "outcome": "completed", "attempts": []})");
  write(folder / "bad/history.csv", "step,time,a\n0,0\n1,1,1\n");
  write(folder / "bad_study/study.json", "{}");
  write(folder / "bad_study/study.csv", "index\n0\n");
  struct Wrong {
    std::vector<std::string> arguments;
    int exit_code;
    std::string message;
  };
  const std::vector<Wrong> wrongs = {
      {{"report"}, 2, "report: no folder given; expected mullion report DIR (see mullion report --help)"},
      {{"report", "nowhere"}, 2, "nowhere is no folder; expected the results of a run or a study"},
      {{"report", "empty"}, 2, "empty holds neither run.json nor study.json; expected the results of a run or a study"},
      {{"report", "bad"}, 1, "bad/history.csv, line 2: 2 fields, but the header has 3"}};
  for (const auto& wrong : wrongs) {
    const auto result = folder.command(wrong.arguments);

    CHECK(result.exit_code == wrong.exit_code);
    CHECK(result.err == "mullion: error: " + wrong.message + "\n");
  }
  const auto study = folder.command({"report", "bad_study"});
  CHECK(study.exit_code == 1);
  CHECK(study.err.starts_with("mullion: error: bad_study/study.json does not describe a study: "));
}
