#include "io/checkpoint.hpp"

#include "io/checkpoint_files.hpp"
#include "io/checkpoint_writer.hpp"
#include "scratch.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <span>

using namespace mullion;
using namespace mullion::io;
using mullion::testing::Scratch;

namespace {

namespace fs = std::filesystem;

Bytes some_bytes(std::size_t n, unsigned seed)
{
  Bytes bytes(n);
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::byte>((i * 7919 + seed) >> 3);
  return bytes;
}

/// Two windows, one with three slots, one without any level field; numbers that are easily lost.
Checkpoint small_checkpoint(std::vector<Bytes>& storage, std::int64_t step = 17)
{
  storage = {some_bytes(4096, 1), some_bytes(8192, 2), some_bytes(8192, 3), some_bytes(4096, 4)};
  Checkpoint checkpoint;
  checkpoint.run_name = "wing";
  checkpoint.version = "0.1.0";
  checkpoint.build = "abc";
  checkpoint.case_text = "[run]\nname = \"wing\" # Flügel\n";
  checkpoint.clock = {step, 0.1 + 0.2, 1e-300, 9, 4, -0.0, 5e-324, 1.0 / 3.0, 3, 5, 7, 16};
  checkpoint.plugins = {{"fluid", "fluid", "euler", "1.0", "00ff"}, {"driver", "driver", "css", "2.0", ""}};
  checkpoint.outputs = {{0, 10}, {0.0, 0.1}, {0, 1}, {"\x01 one \x02", "two"}};
  CheckpointWindow wall{"fluid/wall", "fluid", 3, 2, {}, storage[0], {storage[1], storage[2]}};
  for (int k = 0; k < MULLION_MAX_LEVELS; ++k) wall.stamps[k] = {0.1 * (17 - k), 17 - k, k, k % 2};
  wall.stamps[7].time = std::numeric_limits<double>::quiet_NaN();
  checkpoint.windows = {wall, {"driver/state", "", 2, 0, {}, storage[3], {{}}}};
  return checkpoint;
}

void write(const fs::path& folder, std::int64_t step)
{
  std::vector<Bytes> storage;
  write_atomically(folder / checkpoint_name(step), to_image(small_checkpoint(storage, step)), Trailer::checksum);
}

std::vector<std::int64_t> steps_in(const fs::path& folder)
{
  std::vector<std::int64_t> steps;
  for (const auto& file : list_checkpoints(folder)) steps.push_back(file.step);
  return steps;
}

} // namespace

TEST_CASE("a checkpoint reads back to the last bit")
{
  const Scratch folder;
  std::vector<Bytes> storage;
  const auto written = small_checkpoint(storage);
  write_atomically(folder / "a.h5", to_image(written), Trailer::checksum);

  const auto read = read_checkpoint(folder / "a.h5");

  CHECK(read.run_name == written.run_name);
  CHECK(read.version == written.version);
  CHECK(read.build == written.build);
  CHECK(read.case_text == written.case_text);
  CHECK(std::memcmp(&read.clock, &written.clock, sizeof read.clock) == 0); // all members have eight bytes
  REQUIRE(read.plugins.size() == 2);
  CHECK(read.plugins[0].build == "00ff");
  CHECK(read.plugins[1].instance == "driver");
  CHECK(read.outputs.steps == written.outputs.steps);
  CHECK(read.outputs.times == written.outputs.times);
  CHECK(read.outputs.layouts == written.outputs.layouts);
  CHECK(read.outputs.texts == written.outputs.texts);
  REQUIRE(read.windows.size() == 2);
  for (std::size_t w = 0; w < 2; ++w) {
    const auto &r = read.windows[w], &e = written.windows[w];
    CHECK(r.name == e.name);
    CHECK(r.instance == e.instance);
    CHECK(r.n_slots == e.n_slots);
    CHECK(r.working_slot == e.working_slot);
    CHECK(std::memcmp(r.stamps.data(), e.stamps.data(), sizeof e.stamps) == 0);
    CHECK(std::ranges::equal(r.head, e.head));
    REQUIRE(r.levels.size() == e.levels.size());
    for (std::size_t k = 0; k < e.levels.size(); ++k) CHECK(std::ranges::equal(r.levels[k], e.levels[k]));
  }
}

TEST_CASE("the bytes of a checkpoint depend on what is in it alone")
{
  std::vector<Bytes> one, other;
  const auto a = to_image(small_checkpoint(one)), b = to_image(small_checkpoint(other));
  CHECK(std::ranges::equal(std::span<const std::byte>(a), std::span<const std::byte>(b)));
}

TEST_CASE("a file that is altered anywhere is refused")
{
  const Scratch folder;
  write(folder.path(), 1);
  const auto file = folder / checkpoint_name(1);
  const auto good = read_text(file);
  for (std::size_t i = 0; i < good.size(); i += 997) { // every region of it
    auto bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    write_atomically(file, bad);
    CHECK_THROWS_AS((void)read_checkpoint(file), Error);
  }
  for (const std::size_t size : {std::size_t{0}, std::size_t{24}, good.size() / 2, good.size() - 1}) {
    write_atomically(file, std::string_view(good).substr(0, size));
    CHECK_THROWS_AS((void)read_checkpoint(file), Error);
  }
}

TEST_CASE("a sound file with nonsense in it is refused")
{
  const Scratch folder;
  std::vector<Bytes> storage;
  const auto refuse = [&](auto&& change) {
    auto checkpoint = small_checkpoint(storage);
    change(checkpoint);
    write_atomically(folder / "a.h5", to_image(checkpoint), Trailer::checksum);
    CHECK_THROWS_AS((void)read_checkpoint(folder / "a.h5"), Error);
  };
  refuse([](Checkpoint& c) { c.windows[0].n_slots = 1; });
  refuse([](Checkpoint& c) { c.windows[0].n_slots = 5; }); // more than there are levels
  refuse([](Checkpoint& c) { c.windows[0].n_slots = 1000; });
  refuse([](Checkpoint& c) { c.windows[0].working_slot = 3; });
  refuse([](Checkpoint& c) { c.windows[0].levels[1] = c.windows[0].levels[1].subspan(1); });
}

TEST_CASE("checkpoints are listed by step, newest first, and nothing else is taken for one")
{
  const Scratch folder;
  for (const char* name :
       {"checkpoint-000000002.h5", "checkpoint-000000010.h5", "checkpoint-1000000000.h5", "checkpoint-7.h5",
        "checkpoint-00000000x.h5", "checkpoint-000000003.h5.tmp-4711", "checkpoint-.h5", "results.h5"})
    std::ofstream(folder / name) << "x";

  CHECK(steps_in(folder.path()) == std::vector<std::int64_t>{1000000000, 10, 2});
  CHECK(list_checkpoints(folder / "nowhere").empty());
}

TEST_CASE("the newest good checkpoint is found behind bad ones, with what is wrong with these")
{
  const Scratch folder;
  for (const std::int64_t step : {1, 2, 3}) write(folder.path(), step);
  fs::resize_file(folder / checkpoint_name(3), 1000);
  std::vector<std::string> problems;

  const auto found = newest_good_checkpoint(folder.path(), &problems);

  REQUIRE(found);
  CHECK(found->step == 2);
  REQUIRE(problems.size() == 1);
  CHECK(problems[0].find("does not end with Mullion's trailer") != std::string::npos);
  CHECK(!newest_good_checkpoint(folder / "nowhere"));
}

TEST_CASE("the writer keeps the newest ones, in the order in which they came")
{
  const Scratch folder;
  std::vector<std::int64_t> reported;
  {
    std::vector<Bytes> storage;
    CheckpointWriter writer(folder.path(), 2, [&](std::int64_t step, const std::string& problem) {
      CHECK(problem == "");
      reported.push_back(step);
    });
    for (const std::int64_t step : {5, 10, 15, 20})
      writer.submit(step, to_image(small_checkpoint(storage, step)), {},
                    [&](std::int64_t s, const std::string&) { CHECK(s == reported.back()); });
    writer.wait();
    CHECK(writer.last_step() == 20);
  }
  CHECK(reported == std::vector<std::int64_t>{5, 10, 15, 20});
  CHECK(steps_in(folder.path()) == std::vector<std::int64_t>{20, 15});
}

TEST_CASE("a checkpoint that fails, or what it waits for, is reported, leaves nothing, and removes no older one")
{
  const Scratch folder;
  write(folder.path(), 1);
  std::vector<std::string> problems;
  std::vector<Bytes> storage;
  CheckpointWriter writer(folder.path(), 1, [&](std::int64_t, const std::string& problem) {
    if (!problem.empty()) problems.push_back(problem);
  });

  writer.submit(2, to_image(small_checkpoint(storage, 2)), [] { throw Error(Errc::io, "no results"); });
  writer.wait();

  CHECK(problems == std::vector<std::string>{"no results"});
  CHECK(writer.last_step() == -1);
  CHECK(steps_in(folder.path()) == std::vector<std::int64_t>{1});
  writer.submit(3, to_image(small_checkpoint(storage, 3)), {}); // the next one may succeed
  writer.wait();
  CHECK(steps_in(folder.path()) == std::vector<std::int64_t>{3});
}

TEST_CASE("what lies behind a step is removed, what lies before stays")
{
  const Scratch folder;
  for (const std::int64_t step : {1, 2, 3}) write(folder.path(), step);

  remove_checkpoints_after(folder.path(), 2);

  CHECK(steps_in(folder.path()) == std::vector<std::int64_t>{2, 1});
}
