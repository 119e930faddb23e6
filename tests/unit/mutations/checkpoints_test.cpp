// Damaged checkpoints. A file that was altered is refused by its trailer, before the HDF5 library sees a byte of it:
// the library itself crashes or never ends on some altered files, which is why there is a trailer. Behind one that is
// right, what is said in the file may still be nonsense: then it is an error with a reason, or a checkpoint whose
// parts fit together. And the image itself may be garbled behind a right trailer: what becomes of the library then
// becomes of a child process.
#include "io/checkpoint.hpp"
#include "io/checkpoint_trial.hpp"
#include "io/xdmf_index.hpp"
#include "mutations.hpp"
#include "run/step_clock.hpp"
#include "unit/io/scratch.hpp"
#include "windows.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <sys/stat.h>
#include <vector>

using namespace mullion;
using namespace mullion::io;
using namespace mullion::testing;

namespace {

/// A checkpoint of real windows, with what it points to.
struct Sample {
  std::vector<std::vector<std::byte>> objects;
  Checkpoint checkpoint;

  Sample()
  {
    checkpoint.run_name = "wing";
    checkpoint.version = "0.1.0";
    checkpoint.build = "abc";
    checkpoint.case_text = "[run]\nname = \"wing\"\n";
    checkpoint.clock = {7, 0.65, 0.1, 6, 0, 0.6, 0.7, 0.0, 1, 1, 5, 16};
    checkpoint.plugins = {{"fluid", "fluid", "euler", "1.0", "00ff"}, {"driver", "driver", "css", "2.0", ""}};
    checkpoint.outputs = {{0, 5}, {0.0, 0.5}, {0, 1}, {"one", "two"}};
    for (const auto& window : planned_windows()) objects.push_back(window.write());
    for (const auto& object : objects) {
      shm::WindowHeader header;
      std::memcpy(&header, object.data(), sizeof header);
      const std::string name = header.name, instance = name.substr(0, name.find('/'));
      CheckpointWindow window{name, instance == "driver" ? "" : instance, header.n_slots, 1, {}, {}, {}};
      const std::span<const std::byte> all(object);
      window.head = all.first(header.slots_offset);
      for (std::uint32_t k = 1; k < header.n_slots; ++k)
        window.levels.push_back(all.subspan(header.slots_offset + k * header.slot_bytes, header.slot_bytes));
      checkpoint.windows.push_back(window);
    }
  }
};

enum class Kind { text, real, integer, reals, integers, integers_32, texts, bytes };

/// One attribute (`name` is given) or dataset of the file.
struct Item {
  std::string path, name;
  Kind kind{};
  std::string raw; ///< its values' bytes
  std::vector<std::string> list;
};

template <class T> std::string raw_of(const T* values, std::size_t n)
{
  return {reinterpret_cast<const char*>(values), n * sizeof(T)};
}

/// What a checkpoint consists of, in the order of docs/formats/checkpoint.md.
std::vector<Item> items_of(const Checkpoint& c)
{
  std::vector<Item> items;
  const auto text = [&](const std::string& path, const char* name, const std::string& value) {
    items.push_back({path, name, Kind::text, value, {}});
  };
  const auto integer = [&](const std::string& path, const char* name, std::int64_t value) {
    items.push_back({path, name, Kind::integer, raw_of(&value, 1), {}});
  };
  const auto real = [&](const char* name, double value) {
    items.push_back({"/clock", name, Kind::real, raw_of(&value, 1), {}});
  };
  const auto list = [&](const std::string& path, Kind kind, const auto& values) {
    items.push_back({path, "", kind, raw_of(values.data(), values.size()), {}});
  };
  integer("/", "checkpoint", 1);
  text("/", "run", c.run_name);
  text("/", "version", c.version);
  text("/", "build", c.build);
  text("/", "case", c.case_text);
  integer("/clock", "step", c.clock.step);
  real("time", c.clock.time);
  real("dt", c.clock.dt);
  integer("/clock", "grid", c.clock.grid);
  real("grid_time", c.clock.grid_time);
  real("next_time", c.clock.next_time);
  integer("/clock", "origin", c.clock.origin);
  real("origin_time", c.clock.origin_time);
  integer("/clock", "n_halvings", c.clock.n_halvings);
  integer("/clock", "n_parts", c.clock.n_parts);
  integer("/clock", "n_good", c.clock.n_good);
  integer("/clock", "patience", c.clock.patience);
  const auto column = [&](const char* path, std::string CheckpointPlugin::*member) {
    items.push_back({path, "", Kind::texts, "", {}});
    for (const auto& plugin : c.plugins) items.back().list.push_back(plugin.*member);
  };
  column("/plugins/instance", &CheckpointPlugin::instance);
  column("/plugins/kind", &CheckpointPlugin::kind);
  column("/plugins/name", &CheckpointPlugin::name);
  column("/plugins/version", &CheckpointPlugin::version);
  column("/plugins/build", &CheckpointPlugin::build);
  list("/outputs/steps", Kind::integers, c.outputs.steps);
  list("/outputs/times", Kind::reals, c.outputs.times);
  list("/outputs/layouts", Kind::integers, c.outputs.layouts);
  items.push_back({"/outputs/texts", "", Kind::texts, "", c.outputs.texts});
  for (std::size_t w = 0; w < c.windows.size(); ++w) {
    const auto group = fmt::format("/windows/{:02}", w);
    const auto& window = c.windows[w];
    text(group, "name", window.name);
    text(group, "instance", window.instance);
    integer(group, "n_slots", window.n_slots);
    integer(group, "working_slot", window.working_slot);
    std::vector<double> times;
    std::vector<std::int64_t> steps;
    std::vector<std::int32_t> iterations, kinds;
    for (const auto& stamp : window.stamps) {
      times.push_back(stamp.time);
      steps.push_back(stamp.step);
      iterations.push_back(stamp.iteration);
      kinds.push_back(stamp.kind);
    }
    list(group + "/stamp_times", Kind::reals, times);
    list(group + "/stamp_steps", Kind::integers, steps);
    list(group + "/stamp_iterations", Kind::integers_32, iterations);
    list(group + "/stamp_kinds", Kind::integers_32, kinds);
    list(group + "/head", Kind::bytes, window.head);
    for (std::size_t k = 0; k < window.levels.size(); ++k)
      list(fmt::format("{}/level_{}", group, k + 1), Kind::bytes, window.levels[k]);
  }
  return items;
}

template <class T> std::vector<T> values_of(const Item& item)
{
  std::vector<T> values(item.raw.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), item.raw.data(), values.size() * sizeof(T));
  return values;
}

void put(ImageBuilder& image, const Item& item)
{
  const auto dataset = [&](const auto& values) {
    image.dataset(item.path, values.data(), {static_cast<std::int64_t>(values.size())});
  };
  const auto attribute = [&](auto value) {
    std::memcpy(&value, item.raw.data(), std::min(sizeof value, item.raw.size()));
    image.attribute(item.path, item.name, value);
  };
  if (!item.name.empty() && item.path != "/") image.group(item.path);
  switch (item.kind) {
  case Kind::text: return image.attribute(item.path, item.name, std::string_view(item.raw));
  case Kind::real: return attribute(0.0);
  case Kind::integer: return attribute(std::int64_t{0});
  case Kind::reals: return dataset(values_of<double>(item));
  case Kind::integers: return dataset(values_of<std::int64_t>(item));
  case Kind::integers_32: return dataset(values_of<std::int32_t>(item));
  case Kind::texts: return image.dataset(item.path, item.list);
  case Kind::bytes: return image.dataset(item.path, std::as_bytes(std::span(item.raw)));
  }
}

Image build(const std::vector<Item>& items)
{
  ImageBuilder image;
  std::set<std::string> there; // a name is there once
  for (const auto& item : items)
    if (there.insert(item.path + "@" + item.name).second) put(image, item);
  return image.take();
}

void mutate_items(std::vector<Item>& items, Random& random)
{
  auto& item = items[random.below(items.size())];
  const auto another_kind = [&](Kind first, Kind last) {
    const auto n = static_cast<std::size_t>(last) - static_cast<std::size_t>(first) + 1;
    return static_cast<Kind>(static_cast<std::size_t>(first) + random.below(n));
  };
  switch (random.below(8)) {
  case 0: items.erase(items.begin() + (&item - items.data())); return;
  case 1: { // the value of another one
    const auto& other = items[random.below(items.size())];
    item.raw = other.raw;
    item.list = other.list;
    return;
  }
  case 2:
    item.kind = item.name.empty() ? another_kind(Kind::reals, Kind::bytes) : another_kind(Kind::text, Kind::integer);
    return;
  case 3:
    if (item.list.empty()) return mutate(item.raw, 0, item.raw.size(), random);
    if (random.below(2) == 0) item.list.erase(item.list.begin() + static_cast<std::ptrdiff_t>(random.below(2)));
    else item.list.insert(item.list.end(), random.below(40), "more");
    return;
  case 4: { // a window under another number: a gap, or one of two counts
    const auto windows = std::string("/windows/0");
    if (item.path.starts_with(windows)) item.path[windows.size()] = static_cast<char>('0' + random.below(10));
    return;
  }
  default: // wrong values, most of them numbers
    if (!item.list.empty()) mutate(item.list[0], 0, item.list[0].size(), random);
    else if (random.below(2) == 0) mutate(item.raw, 0, item.raw.size(), random);
    else {
      const auto value = random.one_of(forgotten_numbers);
      const auto at = 8 * random.below(std::max<std::size_t>(item.raw.size() / 8, 1));
      if (at + 8 <= item.raw.size()) std::memcpy(item.raw.data() + at, &value, 8);
    }
  }
}

/// Without a sync and a rename: nothing here is worth keeping.
void write_plainly(const std::filesystem::path& file, std::span<const std::byte> bytes)
{
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

Bytes with_trailer(std::span<const std::byte> content)
{
  Bytes bytes(content.begin(), content.end());
  const std::uint64_t numbers[] = {content.size(), crc64(content)};
  const auto add = [&](const void* from, std::size_t n) {
    const auto* const first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + n);
  };
  add(numbers, sizeof numbers);
  add("MULLTRL1", 8);
  return bytes;
}

/// Do its parts fit together, and does what goes on from it say what is wrong, or do it?
void use(const Checkpoint& checkpoint)
{
  for (const auto& window : checkpoint.windows) {
    REQUIRE(window.n_slots >= 2);
    REQUIRE(window.n_slots <= MULLION_MAX_LEVELS + 1);
    REQUIRE(window.working_slot < window.n_slots);
    REQUIRE(window.levels.size() == window.n_slots - 1);
    const auto slot_bytes = window.levels.front().size();
    std::vector<std::byte> object(window.head.begin(), window.head.end()); // as a session restores it
    for (const auto& level : window.levels) {
      REQUIRE(level.size() == slot_bytes);
      object.insert(object.end(), level.begin(), level.end());
    }
    object.resize(object.size() + slot_bytes);
    object.shrink_to_fit();
    (void)is_refused(object, window.name);
  }
  try {
    XdmfIndex index;
    index.restore(checkpoint.outputs);
    CHECK(index.outputs().size() == checkpoint.outputs.steps.size());
  } catch (const Error& error) {
    CHECK(std::string(error.what()).find("layout") != std::string::npos);
  }
  try {
    Case c;
    c.end_time = 1.0;
    c.dt = 0.1;
    run::StepClock clock(c, false, checkpoint.clock);
    CHECK(std::isfinite(clock.time()));
    CHECK(clock.n_steps() >= clock.step());
    if (!clock.is_at_end()) CHECK(std::isfinite(clock.next().end));
    clock.advance();
  } catch (const Error& error) {
    const std::string text = error.what(); // the checkpoint's clock, or the case's times
    CHECK_MESSAGE((text.find("checkpoint") != std::string::npos || text.find("run.") != std::string::npos), text);
  }
}

void damage_files(std::uint64_t count)
{
  const Scratch folder;
  const auto file = folder / "a.h5";
  const auto whole = with_trailer(to_image(Sample().checkpoint));
  write_plainly(file, whole);
  REQUIRE_NOTHROW((void)read_checkpoint(file));

  for_each_mutation(count, [&](Random& random) {
    auto bytes = whole;
    const auto trailer = whole.size() - trailer_bytes;
    mutate(bytes, random.below(4) == 0 ? trailer : 0, bytes.size(), random);
    if (bytes == whole) return;
    write_plainly(file, bytes);
    std::string text;
    try {
      (void)read_checkpoint(file);
    } catch (const Error& error) {
      CHECK(error.code() == Errc::io);
      text = error.what();
    }
    CHECK_MESSAGE(text.starts_with(file.string() + " "), text);
    CHECK_MESSAGE(text.find("trailer") != std::string::npos, text);
  });
}

/// Garbled images with trailers that are right: the child process meets what they do, and what passes it can be read.
void damage_images(std::uint64_t count)
{
  const Scratch folder;
  const auto file = folder / "a.h5";
  const auto image = to_image(Sample().checkpoint);
  const std::span<const std::byte> all = image;
  const Bytes whole(all.begin(), all.end());
  write_plainly(file, with_trailer(whole));
  REQUIRE_NOTHROW(try_checkpoint(file));

  std::uint64_t n_refused = 0;
  for_each_mutation(count, [&](Random& random) {
    auto bytes = whole;
    for (auto n = 1 + random.below(8); n > 0; --n) mutate(bytes, 0, bytes.size(), random);
    write_plainly(file, with_trailer(bytes));
    try {
      // A sound file of this size takes some milliseconds; where a busy machine takes longer one more is refused.
      try_checkpoint(file, std::chrono::seconds(2));
    } catch (const Error& error) {
      CHECK(error.code() == Errc::io);
      const std::string text = error.what();
      CHECK_MESSAGE(text.starts_with(file.string() + " is no checkpoint that can be read: "), text);
      return void(++n_refused);
    }
    use(read_checkpoint(file));
  });
  CHECK(n_refused > 0);
}

/// @returns why the file of these items is refused; "": it is not
std::string refusal(const std::vector<Item>& items, const std::filesystem::path& file)
{
  write_plainly(file, with_trailer(build(items)));
  try {
    use(read_checkpoint(file));
  } catch (const Error& error) {
    CHECK(error.code() == Errc::io);
    return error.what();
  }
  return "";
}

void damage_contents(std::uint64_t count)
{
  const Scratch folder;
  const auto file = folder / "a.h5";
  const Sample sample;
  const auto whole = items_of(sample.checkpoint);
  REQUIRE(refusal(whole, file) == "");

  std::uint64_t n_refused = 0, n_accepted = 0;
  for_each_mutation(count, [&](Random& random) {
    auto items = whole;
    for (auto n = 1 + random.below(8); n > 0; --n) mutate_items(items, random);
    const auto text = refusal(items, file);
    if (text.empty()) return void(++n_accepted);
    ++n_refused;
    CHECK_MESSAGE(text.starts_with(file.string() + " is no checkpoint that can be read: "), text);
    for (const char* vague : {"vector", "basic_string", "bad_alloc", "stod"}) // what the standard library says
      CHECK_MESSAGE(text.find(vague) == std::string::npos, text);
  });
  CHECK(n_refused > 0);
  CHECK(n_accepted > 0);
}

} // namespace

TEST_CASE("the parts of a checkpoint that are damaged here are those of its file")
{
  const Sample sample;
  const auto expected = to_image(sample.checkpoint), found = build(items_of(sample.checkpoint));
  CHECK(std::ranges::equal(std::span<const std::byte>(expected), std::span<const std::byte>(found)));
}

TEST_CASE("a damaged checkpoint file is refused by its trailer") { damage_files(300); }

TEST_CASE("a checkpoint with damaged contents is refused with the reason, or its parts fit together")
{
  damage_contents(300);
}

TEST_CASE(
    "a checkpoint whose image is garbled behind a right trailer is refused, whatever the HDF5 library makes of it")
{
  damage_images(300);
}

TEST_CASE("a child process that tries a checkpoint and does not come to an end is killed, with a message")
{
  const Scratch folder;
  const auto file = folder / "a.h5";
  REQUIRE(::mkfifo(file.c_str(), 0600) == 0); // nobody ever writes into it: opening it to read never ends

  std::string text;
  try {
    try_checkpoint(file, std::chrono::milliseconds(50));
  } catch (const Error& error) {
    text = error.what();
  }

  CHECK(text.ends_with("reading it did not come to an end within 0.05 s"));
}

TEST_SUITE("full")
{
  TEST_CASE("10,000 checkpoints with garbled images are refused, whatever the HDF5 library makes of them")
  {
    damage_images(10'000);
  }

  TEST_CASE("10,000 damaged checkpoint files are refused by their trailers") { damage_files(10'000); }
  TEST_CASE("10,000 checkpoints with damaged contents are refused with the reason, or their parts fit together")
  {
    damage_contents(10'000);
  }
}
