// [output] functions as text: calls, numbers, and what is no call.
#include "config/function_calls.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace mullion::config;

TEST_CASE("calls are split at semicolons, their numbers at commas")
{
  const auto found =
      parse_function_calls(" structure.frequency( 1 ); solid-2.radiation_rate(2, 1.25, -1e2,0.5) ;fluid.max_dt()");

  CHECK(found.complaint == "");
  REQUIRE(found.calls.size() == 3);
  CHECK(found.calls[0].instance == "structure");
  CHECK(found.calls[0].function == "frequency");
  CHECK(found.calls[0].arguments == std::vector<double>{1.0});
  CHECK(found.calls[0].text == "structure.frequency( 1 )"); // as it stands: a study asks for it by this text
  CHECK(found.calls[1].instance == "solid-2");
  CHECK(found.calls[1].arguments == std::vector<double>{2.0, 1.25, -100.0, 0.5});
  CHECK(found.calls[2].arguments.empty());
  CHECK(parse_function_calls("  ").calls.empty());
}

TEST_CASE("what is no call is told with its text")
{
  for (const std::string wrong :
       {"structure.frequency", "frequency(1)", "structure.frequency(1", "structure.frequency(one)",
        "structure.frequency(1,)", "structure.frequency(nan)", "structure.frequency(1) 2"}) {
    const auto found = parse_function_calls("fluid.max_dt(); " + wrong);
    CHECK(found.calls.empty());
    CHECK(found.complaint ==
          "\"" + wrong + "\" is no call; expected module.function(number, …), with ';' between several");
  }
  CHECK(parse_function_calls("fluid.max_dt();").complaint.starts_with("\"\" is no call"));
}
