// The text of a case after a live run was changed: what a restart would read.
#include "config/case_edit.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace mullion;

namespace {

const std::string text = R"([run]
name = "a"
end_time = 1.0

[structure]
module = "bar"
process = true
density = 2700.0
elements = 10

[driver]
scheme = "css"
)";

} // namespace

TEST_CASE("another plug-in in a case keeps its place and loses the keys of the one before it")
{
  const auto edited = config::edit_plugin(
      text, "structure", "module", "shell",
      {{"thickness", 0.25, true}, {"layers", std::int64_t{3}, false}, {"reference_pressure", 1e5, true}});

  CHECK(edited == R"([run]
name = "a"
end_time = 1.0

[structure]
module = "shell"
process = true
thickness = 0.25

[driver]
scheme = "css"
)");
}

TEST_CASE("other parameters of the same plug-in are changed where they stand, and new ones come behind")
{
  const auto edited = config::edit_plugin(
      text, "structure", "module", "bar",
      {{"density", 5400.0, true}, {"elements", std::int64_t{10}, true}, {"far_end", std::string("free"), true}});

  CHECK(edited == R"([run]
name = "a"
end_time = 1.0

[structure]
module = "bar"
process = true
density = 5400.0
elements = 10
far_end = "free"

[driver]
scheme = "css"
)");
}

TEST_CASE("one key of a table is set, and the table is made where there is none")
{
  const auto later = config::edit_key(text, "run", {"end_time", 2.5, true});
  const auto with_output = config::edit_key(text, "output", {"every", std::int64_t{5}, true});

  CHECK(later.find("end_time = 2.5\n") != std::string::npos);
  CHECK(later.find("end_time = 1.0") == std::string::npos);
  CHECK(with_output == text + "\n[output]\nevery = 5\n");
}
