// Tables: numbers, texts, nothing; quotes as in RFC 4180; lines that are cut short.
#include "report/csv_table.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace mullion;
using namespace mullion::report;

using Texts = std::vector<std::string>;
using Numbers = std::vector<double>;

TEST_CASE("a column of numbers is numbers, with nothing where nothing stands")
{
  const auto table = parse_csv("step,time,x\n0,0,-2.5e-07\n1,1e-05,\n2,2e-05,inf\n", "t", LastLine::whole);

  REQUIRE(table.columns.size() == 3);
  CHECK(table.n_rows == 3);
  CHECK(table.columns[0].name == "step");
  CHECK(table.find("time")->numbers == Numbers{0.0, 1e-5, 2e-5});
  const auto& x = table.find("x")->numbers;
  CHECK(x[0] == -2.5e-7);
  CHECK(std::isnan(x[1]));
  CHECK(std::isinf(x[2]));
  CHECK(table.find("y") == nullptr);
}

TEST_CASE("a column with one text is texts from its first line on")
{
  const auto table = parse_csv("a,b\n1,2\n,3\n1e5x,4\n", "t", LastLine::whole);

  CHECK(table.columns[0].is_text());
  CHECK(table.columns[0].texts == Texts{"1", "", "1e5x"});
  CHECK(table.columns[0].numbers.empty());
  CHECK_FALSE(table.columns[1].is_text());
  CHECK(table.columns[1].numbers == Numbers{2, 3, 4});
}

TEST_CASE("quotes enclose commas, quotes and line ends")
{
  const auto table =
      parse_csv("\"a,b\",message\r\n1,\"it said \"\"no\"\",\nand died\"\r\n2,\"\"\r\n", "t", LastLine::whole);

  CHECK(table.columns[0].name == "a,b");
  CHECK(table.columns[0].numbers == Numbers{1, 2});
  CHECK(table.columns[1].texts == Texts{"it said \"no\",\nand died", ""});
}

TEST_CASE("a last line without an end counts in a whole file and not in one that is being written")
{
  const std::string text = "a,b\n1,2\n3,4";

  CHECK(parse_csv(text, "t", LastLine::whole).n_rows == 2);
  CHECK(parse_csv(text, "t", LastLine::may_be_cut).n_rows == 1); // the 4 may have been going to be a 42
  CHECK(parse_csv("a,b\n1,2\n3", "t", LastLine::may_be_cut).n_rows == 1);
  CHECK(parse_csv("a,b\n", "t", LastLine::may_be_cut).n_rows == 0);
}

TEST_CASE("a damaged table is an error that names the line")
{
  const auto parse = [](const char* text) { (void)parse_csv(text, "study.csv", LastLine::whole); };

  CHECK_THROWS_WITH_AS(parse("a,b\n1,2\n\"x\ny\",1\n3\n"), "study.csv, line 5: 1 fields, but the header has 2", Error);
  CHECK_THROWS_WITH_AS(parse("a,b\n1,2,3\n"), "study.csv, line 2: 3 fields, but the header has 2", Error);
  CHECK_THROWS_WITH_AS(parse("a,b\n1,\"2\n3,4\n"), "study.csv, line 2: a quote is opened and never closed", Error);
  CHECK_THROWS_WITH_AS(parse(""), "study.csv: no header, expected the names of the columns", Error);
}
