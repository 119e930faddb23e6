// `mullion run --restart` as a user meets it: which checkpoint is taken, which is refused and why, what may differ from
// the case that made it.
#include "support/history.hpp"
#include "support/run_case.hpp"

#include "io/atomic_file.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_files.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

using namespace mullion;

namespace {

namespace fs = std::filesystem;

/// 40 steps of a small piston, inline, with a checkpoint every 10.
test::CaseRun piston(const std::vector<std::string>& sets = {}, std::vector<std::string> flags = {})
{
  test::CaseRun run{.file = MULLION_SOURCE_DIR "/configs/closed_piston.toml"};
  run.sets = {
      "run.end_time=2.4377976008801763e-4", "fluid.cells=20",           "structure.elements=10", "output.every=10",
      "output.checkpoint_every=10",         "output.keep_checkpoints=0"};
  run.sets.insert(run.sets.end(), sets.begin(), sets.end());
  flags.emplace_back("--inline");
  run.flags = std::move(flags);
  return run;
}

/// With the results of the whole run in `whole`, and those of one that ended at step 30 in `out`.
struct Piston {
  test::RunFolder folder;

  Piston()
  {
    auto whole = piston();
    whole.out = "whole";
    REQUIRE(folder.run(whole).exit_code == 0);
    cut(30);
  }
  void cut(std::int64_t step) const
  {
    fs::remove_all(folder / "out");
    fs::copy(folder / "whole", folder / "out", fs::copy_options::recursive);
    io::remove_checkpoints_after(folder / "out", step);
  }
  [[nodiscard]] fs::path checkpoint(std::int64_t step) const { return folder / "out" / io::checkpoint_name(step); }
  [[nodiscard]] test::ProcessResult restart(const std::string& from, const std::vector<std::string>& sets = {}) const
  {
    return folder.run(piston(sets, {"--restart", from}));
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void check_refused(const test::ProcessResult& result, const std::vector<std::string>& parts)
{
  CHECK(result.exit_code == 2);
  CHECK(has(result.err, "mullion: error: "));
  for (const auto& part : parts) CHECK_MESSAGE(has(result.err, part), part, " in ", result.err);
}

void alter(const fs::path& file, const std::function<void(std::string&)>& change)
{
  auto content = test::read_file(file);
  change(content);
  io::write_atomically(file, content);
}

} // namespace

TEST_CASE("a damaged or foreign checkpoint is refused with the reason, and the newest good one is named")
{
  const Piston run;
  const auto newest = run.checkpoint(30);
  const std::string good = "; the newest good one is out/checkpoint-000000020.h5";
  struct Damage {
    const char* reason;
    std::function<void(std::string&)> change;
  };
  const auto mesh = test::read_file(run.folder / "out/results/mesh.h5");
  const Damage damages[] = {
      {"does not end with Mullion's trailer: it was truncated", [](auto& text) { text.resize(text.size() / 2); }},
      {"does not end with Mullion's trailer: it was truncated", [](auto& text) { text.clear(); }},
      {"was altered: its trailer says checksum", [](auto& text) { text[text.size() / 3] ^= 1; }},
      {"does not end with Mullion's trailer", [](auto& text) { text = "[run]\nname = \"a\"\n"; }},
      {"is no checkpoint that can be read", [&](auto& text) { text = mesh; }},
  };
  for (const auto& damage : damages) {
    CAPTURE(damage.reason);
    run.cut(30);
    alter(newest, damage.change);

    const auto by_name = run.restart("out/checkpoint-000000030.h5");
    const auto history = test::read_file(run.folder / "out/history.csv");
    const auto latest = run.restart("latest");

    check_refused(by_name, {"--restart: out/checkpoint-000000030.h5 ", damage.reason, good});
    CHECK(history == test::read_file(run.folder / "whole/history.csv")); // nothing was touched
    CHECK_MESSAGE(latest.exit_code == 0, latest.err);
    CHECK(has(latest.err, damage.reason));
    CHECK(has(latest.err, "out/checkpoint-000000020.h5 is taken instead"));
    CHECK(test::difference(run.folder / "out", run.folder / "whole") == "");
  }
}

TEST_CASE("without a checkpoint, or without a sound one, --restart says what to do")
{
  const Piston run;
  check_refused(run.restart("out/checkpoint-000000035.h5"),
                {"cannot open out/checkpoint-000000035.h5", "; the newest good one is out/checkpoint-000000030.h5"});
  for (const auto& file : io::list_checkpoints(run.folder / "out"))
    alter(file.path, [](auto& text) { text.resize(100); });
  check_refused(run.restart("latest"), {"--restart latest: no checkpoint in out is sound: "});
  check_refused(run.restart("out/checkpoint-000000010.h5"), {"; there is no good one in out"});
  run.cut(0);
  check_refused(run.restart("latest"),
                {"--restart latest: there is no checkpoint in out; run without --restart to begin"});
  check_refused(run.folder.command({"run", "--restart", "latest"}),
                {"--restart latest looks in the results folder; give it with --out, or the case"});
}

TEST_CASE("changed physics are refused, all of them at once, unless named with --set")
{
  const Piston run;
  auto edited = piston({}, {"--restart", "latest"}); // the file itself differs: 20 cells and 10 elements came by --set
  std::erase_if(edited.sets, [](const std::string& set) { return set.starts_with("structure.elements"); });

  check_refused(run.folder.run(edited), {"it was made by another case: structure.elements is 80 and was 10; a change "
                                         "that is meant is named with --set"});
  const auto softer = run.restart("latest", {"structure.youngs_modulus=2.7e6"});
  CHECK_MESSAGE(softer.exit_code == 0, softer.err);
  const auto before = test::read_file(run.folder / "whole/history.csv");
  const auto after = test::read_file(run.folder / "out/history.csv");
  CHECK(after.substr(0, after.find("\n31,")) == before.substr(0, before.find("\n31,"))); // up to the checkpoint
  CHECK(after != before);
}

TEST_CASE("what would not fit into the windows is refused even if it is named")
{
  const Piston run;
  check_refused(run.restart("latest", {"fluid.cells=30"}),
                {"the checkpoint does not fit: window fluid/", "with the new parameters of module 'fluid'"});
  check_refused(run.restart("latest", {"driver.scheme=gss"}), {"the checkpoint does not fit: window "});
  check_refused(run.restart("latest", {"run.end_time=1e-5"}), {"behind run.end_time = 1e-05 s; expected a later end"});
  CHECK(test::read_file(run.folder / "out/history.csv") == test::read_file(run.folder / "whole/history.csv"));
}

TEST_CASE("a finished run goes on to a later end, with another step too")
{
  const Piston run;
  run.cut(40);
  const auto later = run.restart("latest", {"run.end_time=3.656696401320265e-4"}); // 60 steps
  CHECK_MESSAGE(later.exit_code == 0, later.err);
  auto whole = piston({"run.end_time=3.656696401320265e-4"});
  whole.out = "longer";
  REQUIRE(run.folder.run(whole).exit_code == 0);
  CHECK(test::difference(run.folder / "out", run.folder / "longer") == "");

  run.cut(40);
  const auto finer = run.restart("latest", {"run.end_time=3.656696401320265e-4", "run.dt=3.0472470011002205e-6"});

  CHECK_MESSAGE(finer.exit_code == 0, finer.err);
  CHECK(test::last_step(run.folder / "out") == 40 + 40);
  const auto times = test::read_history(run.folder / "out/history.csv").at("time");
  CHECK(times.back() == 3.656696401320265e-4);
}

TEST_CASE("a new run in a folder removes the checkpoints of the old one, and keeps as many of its own as asked")
{
  const Piston run;
  REQUIRE(run.folder.run(piston({"output.keep_checkpoints=2", "run.end_time=1.8283482006601324e-4"})).exit_code == 0);
  const auto files = io::list_checkpoints(run.folder / "out");
  REQUIRE(files.size() == 2);
  CHECK(files[0].step == 30);
  CHECK(files[1].step == 20);
}

TEST_CASE("a run goes on in another folder, which then holds the rest")
{
  const Piston run;
  auto elsewhere = piston({}, {"--restart", "out/checkpoint-000000030.h5"});
  elsewhere.out = "rest";

  CHECK(run.folder.run(elsewhere).exit_code == 0);

  const auto rest = test::read_history(run.folder / "rest/history.csv");
  const auto whole = test::read_history(run.folder / "whole/history.csv");
  CHECK(rest.at("step").front() == 30);
  for (const auto& [column, values] : whole) CHECK(std::vector(values.begin() + 30, values.end()) == rest.at(column));
  CHECK(test::read_file(run.folder / "rest/results/000000040.h5") ==
        test::read_file(run.folder / "whole/results/000000040.h5"));
}
