#include "study/column_table.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace mullion;
using namespace mullion::study;

namespace {

std::string refusal_of(const std::string& text)
{
  try {
    (void)parse_columns(text, "file.csv");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a table of numbers is read column by column, to the same doubles")
{
  const auto table = parse_columns("step,time,a.b\n0,0,1e5\n1,0.1,-0.30000000000000004\n", "file.csv");

  CHECK(table.names == std::vector<std::string>{"step", "time", "a.b"});
  CHECK(table.column("time") == std::vector{0.0, 0.1});
  CHECK(table.column("a.b") == std::vector{1e5, -(0.1 + 0.2)});
  CHECK(!table.has("a"));
}

TEST_CASE("a header may be a comment, lines may be empty or comments, ends may be those of another system")
{
  const auto table = parse_columns("# t, u[m]\r\n# by hand\r\n\r\n0, 1\r\n1 ,2", "file.csv");

  CHECK(table.column("t") == std::vector{0.0, 1.0});
  CHECK(table.column("u[m]") == std::vector{1.0, 2.0});
}

TEST_CASE("what a diverging run writes is read: nan and infinities")
{
  const auto table = parse_columns("a,b,c\nnan,inf,-inf\n", "file.csv");

  CHECK(std::isnan(table.column("a")[0]));
  CHECK(std::isinf(table.column("b")[0]));
  CHECK(table.column("c")[0] < 0.0);
}

TEST_CASE("a table that is none is refused with the place")
{
  CHECK(refusal_of("") == "file.csv has no header; expected the names of its columns in the first line");
  CHECK(refusal_of("a,b\n1,2\n1,\n") == "file.csv:3: '' in column 'b' is no number");
  CHECK(refusal_of("a,b\n1,2x\n") == "file.csv:2: '2x' in column 'b' is no number");
  CHECK(refusal_of("a,b\n1\n") == "file.csv:2: 1 cells; expected 2 as in the header");
  CHECK(refusal_of("a,b\n1,2,3\n") == "file.csv:2: more cells than the 2 of the header");
}

TEST_CASE("a column that is not there is named with the nearest one")
{
  const auto table = parse_columns("time,wall.pressure\n", "file.csv");

  CHECK_THROWS_WITH_AS((void)table.column("wall.presure"),
                       "there is no column 'wall.presure'; did you mean 'wall.pressure'?", Error);
}
