#include "study/study_file.hpp"

#include "io/hdf5_image.hpp"
#include "study/study_table.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace mullion;
using namespace mullion::study;

namespace {

const std::string head = "[study]\nname = \"s\"\ncase = \"../cli/good_case.toml\"\n";

/// A study that is right.
StudyFile parse(const std::string& text)
{
  auto result = parse_study(head + text, MULLION_SOURCE_DIR "/tests/unit/study.toml");
  REQUIRE(result.diagnostics.empty());
  return result.value;
}

std::vector<std::string> overrides(const StudyFile& study, std::size_t run)
{
  std::vector<std::string> all;
  for (const auto* setting : study.settings_of(run)) all.push_back(setting->override_text());
  return all;
}

std::vector<std::string> cells(const StudyFile& study)
{
  std::vector<std::string> all;
  for (const auto& point : study.axes.at(0).points) all.push_back(point.cells.at(0));
  return all;
}

using Texts = std::vector<std::string>;

} // namespace

TEST_CASE("a study without anything that varies is one run")
{
  const auto study = parse("");

  CHECK(study.name == "s");
  CHECK(study.case_file == MULLION_SOURCE_DIR "/tests/cli/good_case.toml"); // from the folder of the study file
  CHECK(study.placement == "inline");
  CHECK(study.keep == "history");
  CHECK(study.n_runs() == 1);
  CHECK(study.points_of(0).empty());
}

TEST_CASE("several [[vary]] make their product, and the last varies fastest")
{
  const auto study = parse("[[vary]]\nkey = \"a.x\"\nvalues = [1, 2]\n"
                           "[[vary]]\nkey = \"a.y\"\nvalues = [\"p\", \"q\", true]\n");

  CHECK(study.n_runs() == 6);
  CHECK(overrides(study, 0) == Texts{"a.x=1", "a.y=\"p\""});
  CHECK(overrides(study, 1) == Texts{"a.x=1", "a.y=\"q\""});
  CHECK(overrides(study, 5) == Texts{"a.x=2", "a.y=true"});
  CHECK(study.describe_run(4) == "a.x = 2, a.y = q");
  CHECK(study.axes[0].is_numeric == std::vector{true});
  CHECK(study.axes[1].is_numeric == std::vector{false});
}

TEST_CASE("a range meets both ends; its spacing is linear or logarithmic")
{
  CHECK(cells(parse("[[vary]]\nkey = \"a.x\"\nrange = { from = 0.0, to = 1.0, count = 5 }\n")) ==
        Texts{"0.0", "0.25", "0.5", "0.75", "1.0"});
  CHECK(cells(parse("[[vary]]\nkey = \"a.x\"\nrange = { from = 4.0, to = 0.25, count = 3, spacing = \"log\" }\n")) ==
        Texts{"4.0", "1.0", "0.25"});
}

TEST_CASE("a range of whole numbers stays whole where every value is")
{
  CHECK(cells(parse("[[vary]]\nkey = \"a.n\"\nrange = { from = 10, to = 40, count = 4 }\n")) ==
        Texts{"10", "20", "30", "40"});
  CHECK(cells(parse("[[vary]]\nkey = \"a.n\"\nrange = { from = 1, to = 2, count = 3 }\n")) ==
        Texts{"1.0", "1.5", "2.0"});
}

TEST_CASE("keys side by side vary together")
{
  const auto study = parse("[[vary]]\nkeys = [\"run.dt\", \"a.n\"]\nvalues = [[1e-5, 1], [2e-5, 2]]\n");

  CHECK(study.n_runs() == 2);
  CHECK(overrides(study, 1) == Texts{"run.dt=2e-05", "a.n=2"});
  CHECK(study.axes[0].columns == Texts{"run.dt", "a.n"});
}

TEST_CASE("a labelled point sets several keys, over those of [set], and measures of its own")
{
  const auto study = parse("[set]\n\"d.scheme\" = \"one\"\nd.order = 1\n"
                           "[[vary]]\nname = \"scheme\"\npoints = [ { label = \"A\" }, { label = \"B\", set = { "
                           "\"d.scheme\" = \"two\", \"d.beta\" = 0.5 }, measure = { window = 2.0 } } ]\n"
                           "[[measure]]\nname = \"r\"\nkind = \"envelope_rate\"\nquantity = \"q\"\nwindow = 1.0\n"
                           "[[measure]]\nname = \"l\"\nkind = \"last\"\nquantity = \"q\"\n");

  CHECK(overrides(study, 0) == Texts{"d.scheme=\"one\"", "d.order=1"});
  CHECK(overrides(study, 1) == Texts{"d.scheme=\"one\"", "d.order=1", "d.scheme=\"two\"", "d.beta=0.5"});
  CHECK(study.axes[0].keys == Texts{"d.scheme", "d.beta"});
  CHECK(study.axes[0].columns == Texts{"scheme"});
  CHECK(study.measures_of(0)[0].window == 1.0);
  CHECK(study.measures_of(1)[0].window == 2.0);
}

TEST_CASE("a reference is read from beside the study file, its times made seconds, by point where a point says so")
{
  const auto study = parse(
      "[[vary]]\nname = \"p\"\npoints = [ { label = \"A\" }, { label = \"B\", measure = { time_scale = 0.5 } } ]\n"
      "[[measure]]\nname = \"e\"\nkind = \"reference_error\"\nquantity = \"q\"\n"
      "file = \"../cli/broken_studies/reference.csv\"\ntime_column = \"t\"\nvalue_column = \"pressure\"\n"
      "time_scale = 2.0\nscale = 3.0\n");

  CHECK(study.measures_of(0)[0].reference_times == std::vector{0.0, 2.0});
  CHECK(study.measures_of(0)[0].reference_values == std::vector{1.0, 2.0});
  CHECK(study.measures_of(1)[0].reference_times == std::vector{0.0, 0.5});
  CHECK(study.measures_of(1)[0].scale == 3.0);
  CHECK(definition_of(study.measures_of(0)[0]) != definition_of(study.measures_of(1)[0]));
}

TEST_CASE("studies are told apart by what their runs depend on, not by their measures")
{
  const std::string vary = "[[vary]]\nkey = \"a.x\"\nvalues = [1, 2]\n";
  const std::string last = "[[measure]]\nname = \"l\"\nkind = \"last\"\nquantity = \"q\"\n";
  const std::string none = "keep = \"none\"\n";

  CHECK(difference(parse(vary), parse(vary + last)) == "");
  CHECK(difference(parse(vary), parse("[[vary]]\nkey = \"a.x\"\nvalues = [1, 3]\n")) ==
        "\n  [[vary]] 1: there { key = \"a.x\", values = [1, 2] }, here { key = \"a.x\", values = [1, 3] }");
  CHECK(difference(parse(vary), parse("")) == "\n  [[vary]] 1: there { key = \"a.x\", values = [1, 2] }, here absent");
  // nothing is left to measure anew
  CHECK(difference(parse(none + vary), parse(none + vary + last)) ==
        "\n  [[measure]] 1: there absent, here { name = \"l\", kind = \"last\", quantity = \"q\" }");
}

TEST_CASE("the table has a row per finished run, in their order, and its texts are quoted as CSV wants")
{
  const auto study = parse("[[vary]]\nkey = \"a.x\"\nvalues = [0.1, 1e-7, 3]\n"
                           "[[measure]]\nname = \"d\"\nkind = \"error_doubling\"\nquantity = \"q\"\nwindow = 1.0\n");
  std::vector<std::optional<RunResult>> results(3);
  results[0] = RunResult{};
  results[0]->outcome = "completed";
  results[0]->values = {0.1 + 0.2, std::nullopt};
  results[2] = RunResult{};
  results[2]->outcome = "failed";
  results[2]->message = "module 'a', \"b\"";

  const auto table = make_table(study, results);

  CHECK(csv_text(table) == "index,a.x,outcome,d,d.bound,message\n"
                           "0,0.1,completed,0.30000000000000004,,\n"
                           "2,3,failed,,,\"module 'a', \"\"b\"\"\"\n");
  const auto image = hdf5_file(table);
  const io::ImageReader file(image, "study.h5");
  CHECK(file.f64("/a.x") == std::vector{0.1, 3.0});
  CHECK(file.f64("/d")[0] == 0.1 + 0.2);
  CHECK(std::isnan(file.f64("/d")[1]));
  CHECK(file.texts("/outcome") == Texts{"completed", "failed"});
  CHECK(file.text_attribute("/d", "kind") == "error_doubling");
  CHECK(file.text_attribute("/d.bound", "unit") == "1/s");
  CHECK(printed(table, 1) == "index  a.x  outcome    d    d.bound\n"
                             "0      0.1  completed  0.3\n"
                             "… 1 more\n");
}

TEST_CASE("a [[plot]] names columns, their product, and the axis that makes the curves")
{
  const std::string axes = "[[vary]]\nkey = \"a.x\"\nvalues = [1, 2]\n[[vary]]\nname = \"scheme\"\n"
                           "points = [{ label = \"A\", set = { \"a.y\" = 1 } }]\n";

  const auto plots = parse(axes + "[[plot]]\ntitle = \"T\"\ny = \"p.q * r.s\"\n"
                                  "[[plot]]\ntitle = \"U\"\ny = \"p.q\"\ncurves = \"a.x\"\ny_label = \"q [m]\"\n")
                         .plots;

  REQUIRE(plots.size() == 2);
  CHECK(plots[0].factors() == Texts{"p.q", "r.s"});
  CHECK(plots[0].y_label == "p.q * r.s");
  CHECK(plots[0].curves == "scheme"); // the last axis
  CHECK(plots[1].factors() == Texts{"p.q"});
  CHECK(plots[1].curves == "a.x");
  CHECK(plots[1].y_label == "q [m]");
}

TEST_CASE("a [[plot]] that nobody can draw is refused with its place")
{
  const auto mistakes = [](const std::string& plot) {
    const auto result = parse_study(head + "[[vary]]\nkey = \"a.x\"\nvalues = [1, 2]\n" + plot,
                                    MULLION_SOURCE_DIR "/tests/unit/study.toml");
    return result.diagnostics.size();
  };
  CHECK(mistakes("[[plot]]\ntitle = \"T\"\ny = \"q\"\n") == 0);
  CHECK(mistakes("[[plot]]\ntitle = \"T\"\n") == 1);                                // no y
  CHECK(mistakes("[[plot]]\ntitle = \"T\"\ny = \"q *\"\n") == 1);                   // half a product
  CHECK(mistakes("[[plot]]\ntitle = \"T\"\ny = \"q\"\ncurves = \"schem\"\n") == 1); // no such axis
  CHECK(mistakes("[[plot]]\ntitle = \"T\"\ny = \"q\"\nnormalise = \"maximum\"\n") == 1);
  CHECK(mistakes("plot = 3\n") == 1);
}
