#include "io/checkpoint.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cmath>

namespace mullion::io {
namespace {

constexpr std::int64_t format_version = 1;

std::string window_group(std::size_t index) { return fmt::format("/windows/{:02}", index); }

template <class T> Extents length_of(const T& list) { return {static_cast<std::int64_t>(list.size())}; }

void write_clock(ImageBuilder& image, const CheckpointClock& clock)
{
  image.group("/clock");
  const auto put = [&](const char* name, auto value) { image.attribute("/clock", name, value); };
  put("step", clock.step);
  put("time", clock.time);
  put("dt", clock.dt);
  put("grid", clock.grid);
  put("grid_time", clock.grid_time);
  put("next_time", clock.next_time);
  put("origin", clock.origin);
  put("origin_time", clock.origin_time);
  put("n_halvings", clock.n_halvings);
  put("n_parts", clock.n_parts);
  put("n_good", clock.n_good);
  put("patience", clock.patience);
}

CheckpointClock read_clock(const ImageReader& image)
{
  CheckpointClock clock;
  constexpr std::int64_t most =
      1'000'000'000'000'000; // a run has fewer steps (run/time_plan.hpp): sums cannot overflow
  const auto integer = [&](const char* name, std::int64_t& value) {
    value = image.i64_attribute("/clock", name);
    MULLION_REQUIRE(0 <= value && value <= most, Errc::io, "its clock's {} is {}, expected 0 to {}", name, value, most);
  };
  const auto real = [&](const char* name, double& value) {
    value = image.f64_attribute("/clock", name);
    MULLION_REQUIRE(std::isfinite(value), Errc::io, "its clock's {} is {}, expected a finite number", name, value);
  };
  integer("step", clock.step);
  real("time", clock.time);
  real("dt", clock.dt);
  integer("grid", clock.grid);
  real("grid_time", clock.grid_time);
  real("next_time", clock.next_time);
  integer("origin", clock.origin);
  real("origin_time", clock.origin_time);
  integer("n_halvings", clock.n_halvings);
  integer("n_parts", clock.n_parts);
  integer("n_good", clock.n_good);
  integer("patience", clock.patience);
  return clock;
}

void write_window(ImageBuilder& image, const std::string& group, const CheckpointWindow& window)
{
  image.group(group);
  image.attribute(group, "name", window.name);
  image.attribute(group, "instance", window.instance);
  image.attribute(group, "n_slots", std::int64_t{window.n_slots});
  image.attribute(group, "working_slot", std::int64_t{window.working_slot});
  std::vector<double> times;
  std::vector<std::int64_t> steps;
  std::vector<std::int32_t> iterations, kinds;
  for (const auto& stamp : window.stamps) {
    times.push_back(stamp.time);
    steps.push_back(stamp.step);
    iterations.push_back(stamp.iteration);
    kinds.push_back(stamp.kind);
  }
  image.dataset(group + "/stamp_times", times.data(), length_of(times));
  image.dataset(group + "/stamp_steps", steps.data(), length_of(steps));
  image.dataset(group + "/stamp_iterations", iterations.data(), length_of(iterations));
  image.dataset(group + "/stamp_kinds", kinds.data(), length_of(kinds));
  image.dataset(group + "/head", window.head);
  for (std::size_t k = 0; k < window.levels.size(); ++k)
    image.dataset(fmt::format("{}/level_{}", group, k + 1), window.levels[k]);
}

CheckpointWindow read_window(const ImageReader& image, const std::string& group, std::vector<Bytes>& storage)
{
  CheckpointWindow window;
  window.name = image.text_attribute(group, "name");
  window.instance = image.text_attribute(group, "instance");
  const auto n_slots = image.i64_attribute(group, "n_slots"), working = image.i64_attribute(group, "working_slot");
  MULLION_REQUIRE(2 <= n_slots && n_slots <= MULLION_MAX_LEVELS + 1 && 0 <= working && working < n_slots, Errc::io,
                  "its window {} has {} slots and works in slot {}", window.name, n_slots, working);
  window.n_slots = static_cast<std::uint32_t>(n_slots);
  window.working_slot = static_cast<std::uint32_t>(working);
  const auto times = image.f64(group + "/stamp_times");
  const auto steps = image.i64(group + "/stamp_steps");
  const auto iterations = image.i32(group + "/stamp_iterations"), kinds = image.i32(group + "/stamp_kinds");
  MULLION_REQUIRE(times.size() == MULLION_MAX_LEVELS && steps.size() == times.size() &&
                      iterations.size() == times.size() && kinds.size() == times.size(),
                  Errc::io, "its window {} has {} stamps, expected {}", window.name, times.size(), MULLION_MAX_LEVELS);
  for (std::size_t k = 0; k < times.size(); ++k) window.stamps[k] = {times[k], steps[k], iterations[k], kinds[k]};
  const auto keep = [&](const std::string& path) -> std::span<const std::byte> {
    return storage.emplace_back(image.bytes(path)); // a vector that moves keeps its bytes where they are
  };
  window.head = keep(group + "/head");
  for (std::int64_t k = 1; k < n_slots; ++k) {
    window.levels.push_back(keep(fmt::format("{}/level_{}", group, k)));
    MULLION_REQUIRE(window.levels.back().size() == window.levels.front().size(), Errc::io,
                    "its window {} has levels of {} and {} bytes", window.name, window.levels.front().size(),
                    window.levels.back().size());
  }
  return window;
}

Checkpoint from_image(const ImageReader& image)
{
  const auto found = image.i64_attribute("/", "checkpoint");
  MULLION_REQUIRE(found == format_version, Errc::io, "its format is number {}, this Mullion reads number {}", found,
                  format_version);
  Checkpoint checkpoint;
  checkpoint.run_name = image.text_attribute("/", "run");
  checkpoint.version = image.text_attribute("/", "version");
  checkpoint.build = image.text_attribute("/", "build");
  checkpoint.case_text = image.text_attribute("/", "case");
  checkpoint.clock = read_clock(image);

  const auto instances = image.texts("/plugins/instance"), kinds = image.texts("/plugins/kind"),
             names = image.texts("/plugins/name"), versions = image.texts("/plugins/version"),
             builds = image.texts("/plugins/build");
  for (const auto* list : {&kinds, &names, &versions, &builds})
    MULLION_REQUIRE(list->size() == instances.size(), Errc::io,
                    "it lists {} instances with {} kinds, {} names, {} versions and {} builds of plug-ins",
                    instances.size(), kinds.size(), names.size(), versions.size(), builds.size());
  for (std::size_t i = 0; i < instances.size(); ++i)
    checkpoint.plugins.push_back({instances[i], kinds[i], names[i], versions[i], builds[i]});

  auto& outputs = checkpoint.outputs;
  outputs.steps = image.i64("/outputs/steps");
  outputs.times = image.f64("/outputs/times");
  outputs.layouts = image.i64("/outputs/layouts");
  outputs.texts = image.texts("/outputs/texts");

  for (std::size_t w = 0; image.has(window_group(w)); ++w)
    checkpoint.windows.push_back(read_window(image, window_group(w), checkpoint.storage));
  return checkpoint;
}

} // namespace

Image to_image(const Checkpoint& checkpoint)
{
  ImageBuilder image;
  image.attribute("/", "checkpoint", format_version);
  image.attribute("/", "run", checkpoint.run_name);
  image.attribute("/", "version", checkpoint.version);
  image.attribute("/", "build", checkpoint.build);
  image.attribute("/", "case", checkpoint.case_text);
  write_clock(image, checkpoint.clock);

  std::vector<std::string> instances, kinds, names, versions, builds;
  for (const auto& plugin : checkpoint.plugins) {
    instances.push_back(plugin.instance);
    kinds.push_back(plugin.kind);
    names.push_back(plugin.name);
    versions.push_back(plugin.version);
    builds.push_back(plugin.build);
  }
  image.dataset("/plugins/instance", instances);
  image.dataset("/plugins/kind", kinds);
  image.dataset("/plugins/name", names);
  image.dataset("/plugins/version", versions);
  image.dataset("/plugins/build", builds);

  const auto& outputs = checkpoint.outputs;
  image.dataset("/outputs/steps", outputs.steps.data(), length_of(outputs.steps));
  image.dataset("/outputs/times", outputs.times.data(), length_of(outputs.times));
  image.dataset("/outputs/layouts", outputs.layouts.data(), length_of(outputs.layouts));
  image.dataset("/outputs/texts", outputs.texts);

  for (std::size_t w = 0; w < checkpoint.windows.size(); ++w)
    write_window(image, window_group(w), checkpoint.windows[w]);
  return image.take();
}

Checkpoint read_checkpoint(const std::filesystem::path& file)
{
  const auto bytes = read_checked(file);
  try {
    return from_image(ImageReader(bytes, file.string()));
  } catch (const std::exception& error) {
    throw Error(Errc::io, fmt::format("{} is no checkpoint that can be read: {}", file.string(), error.what()));
  }
}

} // namespace mullion::io
