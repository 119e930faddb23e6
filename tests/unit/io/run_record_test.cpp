// run.json: there and back, appending attempts, and what the guard does after a crash.
#include "io/run_record.hpp"

#include "io/atomic_file.hpp"
#include "scratch.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <limits>

using namespace mullion;
using namespace mullion::io;
using mullion::testing::Scratch;

namespace {

RunRecord some_record()
{
  Attempt attempt;
  attempt.versions = {{"mullion", "0.1.0"}, {"hdf5", "1.10.8"}};
  attempt.start = "2024-05-01T12:00:00Z";
  attempt.modules = {{"fluid", "fluid", "euler_1d", "0.1", true},
                     {"structure", "structure", "elastic_bar", "0.1", false}};
  attempt.driver = "cibc";
  attempt.steps = 100;
  attempt.simulated_time = 0.1;
  attempt.wall_s = 1.0 / 3.0;
  attempt.functions = {{"structure.frequency(1)", 41.25}};
  attempt.timings = {{"fluid", "step", 100, 1.5, 1.25, 0.25}};
  attempt.events = {{50, "swap", "structure", "elastic_bar -> rigid"}};
  attempt.files = {"history.csv", "results.xdmf"};
  return {"closed-piston", "running", {{"structure.wet.velocity", "m/s"}, {"driver.iterations", "1"}}, {attempt}};
}

} // namespace

TEST_CASE("a run's record comes back as it was written")
{
  const Scratch scratch;
  const auto written = some_record();

  write_run_record(scratch / "run.json", written);
  const auto record = read_run_record(scratch / "run.json");

  REQUIRE(record.has_value());
  CHECK(record->name == "closed-piston");
  CHECK(record->columns == written.columns); // in order
  REQUIRE(record->attempts.size() == 1);
  const auto& attempt = record->attempts[0];
  CHECK(attempt.versions == written.attempts[0].versions); // in order
  CHECK(attempt.modules[0].is_process);
  CHECK(attempt.modules[1].module == "elastic_bar");
  CHECK(attempt.simulated_time == 0.1);
  CHECK(attempt.wall_s == 1.0 / 3.0);
  CHECK(attempt.functions == std::vector<std::pair<std::string, double>>{{"structure.frequency(1)", 41.25}});
  CHECK(attempt.timings[0].work_s == 1.25);
  CHECK(attempt.events[0].detail == "elastic_bar -> rigid");
  CHECK(attempt.files == written.attempts[0].files);

  const auto text = read_text(scratch / "run.json");
  write_run_record(scratch / "again.json", *record);
  CHECK(read_text(scratch / "again.json") == text);
}

TEST_CASE("a restart appends an attempt to the record")
{
  const Scratch scratch;
  write_run_record(scratch / "run.json", some_record());

  auto record = read_run_record(scratch / "run.json").value();
  record.attempts.push_back({});
  record.attempts.back().restarted_from = "checkpoint-50.h5";
  write_run_record(scratch / "run.json", record);

  CHECK(read_run_record(scratch / "run.json")->attempts.size() == 2);
  CHECK_FALSE(read_run_record(scratch / "none.json").has_value());
}

TEST_CASE("numbers that are not finite and texts that are not UTF-8 do not break the record")
{
  const Scratch scratch;
  auto written = some_record();
  written.attempts[0].simulated_time = std::numeric_limits<double>::quiet_NaN();
  written.attempts[0].error = "garbage \xff from a module";

  write_run_record(scratch / "run.json", written);
  const auto record = read_run_record(scratch / "run.json").value();

  CHECK(std::isnan(record.attempts[0].simulated_time));
  CHECK(record.attempts[0].error.find("from a module") != std::string::npos);
}

TEST_CASE("the guard completes the record of a run that died, and no other")
{
  const Scratch scratch;
  const auto path = (scratch / "run.json").string();
  write_run_record(path, some_record());

  complete_after_crash(path, "failed", "the orchestrator was killed by signal 9");
  complete_after_crash(path, "failed", "a second message");

  const auto record = read_run_record(path).value();
  CHECK(record.outcome == "failed");
  CHECK(record.attempts[0].outcome == "failed");
  CHECK(record.attempts[0].error == "the orchestrator was killed by signal 9");
  CHECK(record.attempts[0].steps == 100);
}

TEST_CASE("the guard makes a record where a run died before it wrote one")
{
  const Scratch scratch;
  const auto path = (scratch / "run.json").string();

  complete_after_crash(path, "failed", "died at the start");

  CHECK(read_run_record(path)->attempts.at(0).error == "died at the start");
}

TEST_CASE("a file that is not a record is an error that names it")
{
  const Scratch scratch;
  for (const char* content : {"", "{", "[1]", "{\"name\": 3, \"outcome\": \"x\"}"}) {
    std::ofstream(scratch / "run.json", std::ios::trunc) << content;
    CHECK_THROWS_WITH_AS((void)read_run_record(scratch / "run.json"), doctest::Contains("run.json is not the record"),
                         Error);
  }
}

TEST_CASE("the time of a start is UTC in ISO 8601")
{
  const auto now = utc_now();

  CHECK(now.size() == 20);
  CHECK(now[10] == 'T');
  CHECK(now.back() == 'Z');
}
