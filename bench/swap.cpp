// What it costs to change a live run: a death until it is noticed, until its step is done again by a new process; a
// swap until its first step is committed, in a process and inline, with small and with large windows. And the two
// things that make it possible: a commit, and re-arming a window, beside a plain copy of its bytes. Medians.
//
//   build-dev/bench/swap [--rounds R] [--largest NODES]
#include "mullion_run.hpp"

#include "shm/levels.hpp"
#include "shm/memory_object.hpp"
#include "shm/window_layout.hpp"

#include <mullion/app/inspect.hpp>
#include <mullion/app/live_runs.hpp>
#include <mullion/sdk/error.hpp>

#include <chrono>
#include <csignal>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace {

using Clock = std::chrono::steady_clock;
using mullion::bench::median;
namespace fs = std::filesystem;
namespace shm = mullion::shm;

double milliseconds_since(Clock::time_point begin)
{
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// A live run of two modules whose steps cost next to nothing; it ends with this object.
class LiveRun {
public:
  LiveRun(long nodes, bool in_processes)
      : folder_(fs::temp_directory_path() / fmt::format("mullion-bench-{}", ::getpid()))
  {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "case.toml") << fmt::format(R"([run]
name = "bench-swap"
dt = 1.0
end_time = 1e9
on_failure = "{1}"
[fluid]
module = "echo_fluid"
nodes = {0}
process = {2}
[structure]
module = "echo_structure"
nodes = {0}
process = {2}
[coupling]
interfaces = [["fluid.wall", "structure.wet"]]
[driver]
scheme = "echo"
[output]
history = false
)",
                                                        nodes, in_processes ? "respawn" : "stop", in_processes);
    std::fflush(stdout);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::setenv("MULLION_PLUGIN_PATH", MULLION_BUILD_DIR "/bench/plugins", 1);
      (void)!std::freopen("/dev/null", "w", stdout);
      ::chdir(folder_.c_str());
      ::execl(MULLION_BUILD_DIR "/bin/mullion", "mullion", "run", "case.toml", "--log-level", "off", nullptr);
      ::_exit(127);
    }
    for (int i = 0; i < 10'000; ++i) {
      try {
        if (mullion::look_at_run(name).step > 2) break;
      } catch (const mullion::Error&) { // not yet
      }
      ::usleep(1000);
    }
    // The control object, as an onlooker maps it: what is polled below costs the run nothing.
    const auto run = mullion::look_at_run(name);
    for (const auto& entry : fs::directory_iterator(fmt::format("/proc/{}/fd", run.orchestrator)))
      if (fs::read_symlink(entry).string().find("mullion:control") != std::string::npos)
        mapping_ = shm::map_object(static_cast<pid_t>(run.orchestrator), std::stoi(entry.path().filename()),
                                   shm::Access::read_only);
    if (mapping_.data == nullptr) throw std::runtime_error("the run did not start");
  }
  ~LiveRun()
  {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
    fs::remove_all(folder_);
  }
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  [[nodiscard]] const shm::Control& control() const { return *reinterpret_cast<const shm::Control*>(mapping_.data); }
  void wait_steps(std::int64_t n) const
  {
    const auto end = control().step + n;
    while (control().step < end) ::usleep(100);
  }
  static constexpr const char* name = "bench-swap";

private:
  fs::path folder_;
  pid_t pid_ = 0;
  shm::Mapping mapping_;
};

struct Recovery {
  double noticed_ms = 0, done_ms = 0;
};

/// Kill a module's host; how long until its successor is being started, and until the next commit.
Recovery kill_host(const LiveRun& run, std::uint32_t module)
{
  const auto& record = run.control().modules[module];
  const auto incarnation = record.incarnation;
  const volatile auto* seen = &record.incarnation;
  const auto begin = Clock::now();
  ::kill(record.pid, SIGKILL);
  while (*seen == incarnation) ::usleep(20);
  const auto epoch = run.control().epoch.load();
  Recovery found{milliseconds_since(begin), 0};
  while (run.control().epoch.load() == epoch) ::usleep(20);
  found.done_ms = milliseconds_since(begin);
  return found;
}

double swap(const std::string& target, const std::string& plugin)
{
  const auto begin = Clock::now();
  (void)mullion::swap_module(LiveRun::name, target, plugin, {});
  return milliseconds_since(begin);
}

/// A window with one carried vector on so many nodes, in two slots.
void levels(long nodes, int rounds)
{
  shm::WindowPlan plan;
  plan.name = "fluid/volume";
  plan.dimension = 3;
  plan.panes.push_back({0, nodes, 0, nullptr, nullptr, 0, 3});
  shm::FieldPlan field;
  field.name = "velocity";
  field.unit = "m/s";
  field.components = 3;
  field.entities = nodes;
  plan.fields.push_back(field);
  const auto bytes = shm::window_bytes(plan);
  const auto object = shm::create_object(plan.name, bytes);
  const auto mapping = shm::map_object(::getpid(), object.get(), shm::Access::read_write);
  shm::write_window(plan, mapping.data, mapping.bytes);
  const shm::WindowView view(mapping.data, mapping.bytes, plan.name);
  const auto control = std::make_unique<shm::Control>();
  control->n_windows = 1;
  shm::initialise_levels(*control, 0, 2, 0.0, 1.0);
  std::vector<char> from(static_cast<std::size_t>(nodes) * 24, 'a'), to(from.size(), 'b');

  std::vector<double> arm, copy, commit;
  const int repeats = static_cast<int>(std::max(1L, 10'000'000 / (24 * nodes + 1000)));
  const auto measure = [&](std::vector<double>& out, auto&& body) {
    const auto begin = Clock::now();
    for (int i = 0; i < repeats; ++i) body();
    out.push_back(1e3 * milliseconds_since(begin) / repeats);
  };
  for (int r = 0; r < rounds; ++r) {
    measure(arm, [&] { shm::arm(view, control->table(control->epoch).windows[0]); });
    measure(copy, [&] { std::memcpy(to.data(), from.data(), to.size()); });
    measure(commit, [&] {
      control->working[0].is_written = 1;
      shm::commit(*control);
    });
  }
  fmt::print("{:>9} {:>10.3f} us {:>10.3f} us {:>10.3f} us\n", nodes, median(arm), median(copy), median(commit));
}

} // namespace

int main(int argc, char** argv)
{
  int rounds = 15;
  long largest = 1'000'000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--largest") == 0) largest = std::atol(argv[i + 1]);
  }
  ::setenv("MULLION_RUNTIME_DIR", fmt::format("/tmp/mullion-bench-rt-{}", ::getpid()).c_str(), 1);
  fmt::print("{:>9} {:>14} {:>16} {:>18} {:>14}\n", "nodes", "death noticed", "step done again", "swap, in processes",
             "swap, inline");
  for (const long nodes : {10L, 1000L, 100'000L, 1'000'000L}) {
    if (nodes > largest) break;
    std::vector<double> noticed, done, in_process, in_line;
    {
      const LiveRun run(nodes, true);
      for (int r = 0; r < rounds; ++r) {
        run.wait_steps(5);
        const auto found = kill_host(run, static_cast<std::uint32_t>(r % 2));
        noticed.push_back(found.noticed_ms);
        done.push_back(found.done_ms);
        run.wait_steps(5);
        in_process.push_back(swap(r % 2 == 0 ? "fluid" : "structure", r % 2 == 0 ? "echo_fluid" : "echo_structure"));
      }
    }
    {
      const LiveRun run(nodes, false);
      for (int r = 0; r < rounds; ++r) {
        run.wait_steps(5);
        in_line.push_back(swap(r % 2 == 0 ? "fluid" : "structure", r % 2 == 0 ? "echo_fluid" : "echo_structure"));
      }
    }
    fmt::print("{:>9} {:>11.2f} ms {:>13.2f} ms {:>15.2f} ms {:>11.2f} ms\n", nodes, median(noticed), median(done),
               median(in_process), median(in_line));
    std::fflush(stdout);
  }
  fmt::print("\n{:>9} {:>13} {:>13} {:>13}\n", "nodes", "re-arm", "plain copy", "commit");
  for (const long nodes : {10L, 1000L, 100'000L, 1'000'000L}) levels(nodes, rounds);
  fs::remove_all(std::getenv("MULLION_RUNTIME_DIR"));
}
