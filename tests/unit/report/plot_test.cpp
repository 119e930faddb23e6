// Plots as text: ranges, formats, quoting, data.
#include "report/plot.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace mullion::report;

TEST_CASE("an axis is a little wider than its values")
{
  CHECK(axis_range({2, 4, 3}, false, 0.5) == "[1:5]");
  CHECK(axis_range({2, 4, 3}, false, 0.0) == "[2:4]");
  CHECK(axis_range({1, 100}, true, 0.5) == "[0.1:1000]");
}

TEST_CASE("an axis of equal values, of nearly equal ones and of none has room around them")
{
  CHECK(axis_range({5, 5}, false, 0.1) == "[4.5:5.5]");
  CHECK(axis_range({-5}, false, 0.1) == "[-5.5:-4.5]");
  CHECK(axis_range({0, 0}, false, 0.1) == "[-1:1]");
  CHECK(axis_range({}, false, 0.1) == "[-1:1]");
  CHECK(axis_range({8, 8}, true, 0.1) == "[4:16]");
  CHECK(axis_range({}, true, 0.1) == "[0.1:10]");
  CHECK(axis_range({1e5, 1e5 * (1 + 1e-12)}, false, 0.1).starts_with("[89999.99")); // round-off
}

TEST_CASE("the numbers at an axis have as many digits as tell them apart")
{
  CHECK(axis_format({0, 1}) == "%h");
  CHECK(axis_format({99500, 100000}) == "%h");
  CHECK(axis_format({250000, 250000.1}) == "%.9g"); // ticks of 0.02, or 2.5e5 / 1e-1 = 2.5e6: 7 digits and two more
  CHECK(axis_format({3, 3}) == "%h");
}

TEST_CASE("a text of a script cannot end its quotes")
{
  CHECK(quote("a'b") == "'a''b'");
  CHECK(quote("x\ny\\n") == "'x y\\n'");
  CHECK(quote("") == "''");
}

TEST_CASE("file names are letters, digits, minus and underscore")
{
  CHECK(file_name("../a b/c.d-1") == "a_b_c_d-1");
  CHECK(file_name("..") == "plot");
  CHECK(file_name(std::string(300, 'x')).size() == 80);
}

TEST_CASE("bars are stacked in the data, and what is not finite is missing")
{
  Plot bars;
  bars.shape = Shape::bars;
  bars.labels = {"first"};
  bars.curves = {{"work", {2}, {0}}, {"waiting", {1}, {0}}};
  CHECK(plot_data(bars) == "1 0 0 2 -0.35 0.35\n\n\n2.5 0 2 3 -0.35 0.35\n\n\n");

  Plot lines;
  lines.curves = {{"x", {0, 1, 2}, {5, std::numeric_limits<double>::infinity(), 1e305}}};
  CHECK(plot_data(lines) == "0 5\n1 NaN\n2 NaN\n\n\n");
}

TEST_CASE("a script draws the plot as SVG and PNG, with a legend only where it tells something")
{
  Plot plot;
  plot.name = "velocity";
  plot.x.label = "time [s]";
  plot.curves = {{"a", {0, 1}, {0, 1}}};
  const auto one = plot_script(plot);
  plot.curves.push_back({"b", {0, 1}, {0, 1}});
  const auto two = plot_script(plot);

  CHECK(one.find("set output 'velocity.svg'") != std::string::npos);
  CHECK(one.find("set output 'velocity.png'") != std::string::npos);
  CHECK(one.find("set xlabel 'time [s]'") != std::string::npos);
  CHECK(one.find("unset key") != std::string::npos);
  CHECK(two.find("unset key") == std::string::npos);
}
