// What it costs to change a live run, for a module whose state has 1 MB to 1 GB: a death until it is noticed, until its
// step is done again by a new process; a swap until its first step is committed, in a process and inline; a checkpoint
// until it is on disk. Each beside its floor in the same run: the kernel's taking the process apart; an ordinary
// step, and what a restart cannot do without, attach and commit; a plain write and sync of the same bytes. All
// interleaved; medians of times and of the rounds' ratios.
//
//   build-dev/bench/swap [--rounds R] [--smallest MB] [--largest MB] [--folder DIR]
#include "live_run.hpp"

#include <mullion/app/live_runs.hpp>

#include <cstring>
#include <poll.h>
#include <sys/syscall.h>

namespace {

using Clock = std::chrono::steady_clock;
using mullion::bench::LiveRun;
using mullion::bench::median;
using mullion::bench::milliseconds;
using mullion::bench::milliseconds_since;
namespace fs = std::filesystem;
namespace shm = mullion::shm;

constexpr std::uint32_t structure = 1; ///< the second module of the case

constexpr const char* name = "bench-swap";

/// A live run of two modules whose steps cost next to nothing but the copy of a state of so many bytes, which the
/// structure has.
LiveRun start(const fs::path& base, std::size_t megabytes, bool in_processes)
{
  const auto folder = base / fmt::format("mullion-bench-{}", ::getpid());
  fs::create_directories(folder);
  mullion::bench::write_echo_case({.name = name,
                                   .in_processes = in_processes,
                                   .structure = fmt::format("module = \"store_structure\"\nmegabytes = {}", megabytes),
                                   .end_time = 1e9,
                                   .on_failure = in_processes ? "respawn" : "stop"},
                                  folder / "case.toml");
  return {name, {(folder / "case.toml").string()}, mullion::bench::echo_plugins, folder};
}

/// From the kill of a host: until the kernel has taken it apart, memory and all, as any onlooker learns; until the
/// orchestrator has reaped it; until its successor is being started; until the next commit [ms].
struct Recovery {
  double dead = 0, noticed = 0, answered = 0, done = 0;
};

Recovery kill_host(const LiveRun& run)
{
  const auto& record = run.control().modules[structure];
  const auto incarnation = record.incarnation;
  const volatile auto* seen = &record.incarnation;
  const auto pid = record.pid;
  const shm::Descriptor onlooker(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
  pollfd polled{onlooker.get(), POLLIN, 0};
  Recovery found;
  const auto begin = Clock::now();
  ::kill(pid, SIGKILL);
  ::poll(&polled, 1, -1);
  found.dead = milliseconds_since(begin);
  while (::kill(pid, 0) == 0) ::usleep(20);
  found.noticed = milliseconds_since(begin);
  while (*seen == incarnation) ::usleep(20);
  found.answered = milliseconds_since(begin);
  const auto epoch = run.control().epoch.load();
  while (run.control().epoch.load() == epoch) ::usleep(20);
  found.done = milliseconds_since(begin);
  return found;
}

double swap()
{
  return milliseconds([] { (void)mullion::swap_module(name, "structure", "store_structure", {}); });
}

/// One attach of the structure, as the run saw it, its mapping of the windows included [ms].
double attach(const LiveRun& run)
{
  const auto look = run.look();
  for (const auto& call : look.modules[structure].calls)
    if (call.call == "attach" && call.count > 0) return 1e3 * call.wall_s / static_cast<double>(call.count);
  throw std::runtime_error("the structure was never attached");
}

struct Samples {
  std::vector<double> step, dead, noticed, notice_ratio, answered, done, done_ratio, attach, swap, swap_ratio, in_line,
      plain, checkpoint, checkpoint_ratio;
};

void measure_in_processes(Samples& s, std::size_t megabytes, int rounds, const fs::path& base)
{
  const LiveRun run = start(base, megabytes, true);
  const std::vector<std::byte> bytes(megabytes * 1'000'000, std::byte{1});
  const int n_steps = megabytes < 100 ? 50 : 3;
  for (int r = 0; r < rounds; ++r) {
    run.wait_steps(2);
    s.step.push_back(milliseconds([&] { run.wait_steps(n_steps); }) / n_steps);
    const auto found = kill_host(run);
    s.dead.push_back(found.dead);
    s.noticed.push_back(found.noticed);
    s.notice_ratio.push_back(found.noticed / found.dead);
    s.answered.push_back(found.answered);
    s.done.push_back(found.done);
    s.attach.push_back(attach(run));
    s.done_ratio.push_back(found.done / (s.step.back() + s.attach.back()));
    run.wait_steps(2);
    s.swap.push_back(swap());
    s.swap_ratio.push_back(s.swap.back() / (s.step.back() + s.attach.back()));
    run.wait_steps(2);
    s.plain.push_back(milliseconds([&] { mullion::bench::write_plainly(run.folder() / "plain", bytes); }));
    s.checkpoint.push_back(milliseconds([] { (void)mullion::request_checkpoint(name); }));
    s.checkpoint_ratio.push_back(s.checkpoint.back() / s.plain.back());
  }
}

void measure_inline(Samples& s, std::size_t megabytes, int rounds, const fs::path& base)
{
  const LiveRun run = start(base, megabytes, false);
  for (int r = 0; r < rounds; ++r) {
    run.wait_steps(2);
    s.in_line.push_back(swap());
  }
}

} // namespace

int main(int argc, char** argv)
try {
  int rounds = 15;
  std::size_t smallest = 1, largest = 1000;
  fs::path base = fs::temp_directory_path();
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--smallest") == 0) smallest = static_cast<std::size_t>(std::atol(argv[i + 1]));
    if (std::strcmp(argv[i], "--largest") == 0) largest = static_cast<std::size_t>(std::atol(argv[i + 1]));
    if (std::strcmp(argv[i], "--folder") == 0) base = argv[i + 1];
  }
  ::setenv("MULLION_RUNTIME_DIR", fmt::format("/tmp/mullion-bench-rt-{}", ::getpid()).c_str(), 1);
  std::vector<std::pair<std::size_t, Samples>> sizes;
  for (std::size_t megabytes = smallest; megabytes <= largest; megabytes *= 10) {
    auto& s = sizes.emplace_back(megabytes, Samples{}).second;
    measure_in_processes(s, megabytes, rounds, base);
    measure_inline(s, megabytes, rounds, base);
  }
  fs::remove_all(std::getenv("MULLION_RUNTIME_DIR"));

  fmt::print("| state | killed until dead | until noticed | / dead | until its successor is started "
             "|\n|---|---|---|---|---|\n");
  for (const auto& [megabytes, s] : sizes)
    fmt::print("| {} MB | {:.2f} ms | {:.2f} ms | {:.1f} | {:.2f} ms |\n", megabytes, median(s.dead), median(s.noticed),
               median(s.notice_ratio), median(s.answered));
  fmt::print(
      "\n| state | a step | attach | death until its step is done again | / (step + attach) | swap, in processes | "
      "/ (step + attach) | swap, inline |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [megabytes, s] : sizes)
    fmt::print("| {} MB | {:.3f} ms | {:.3f} ms | {:.2f} ms | {:.1f} | {:.2f} ms | {:.1f} | {:.2f} ms |\n", megabytes,
               median(s.step), median(s.attach), median(s.done), median(s.done_ratio), median(s.swap),
               median(s.swap_ratio), median(s.in_line));
  fmt::print("\n| state | plain write | checkpoint on request, on disk | / plain |\n|---|---|---|---|\n");
  for (const auto& [megabytes, s] : sizes)
    fmt::print("| {} MB | {:.1f} ms | {:.1f} ms | {:.2f} |\n", megabytes, median(s.plain), median(s.checkpoint),
               median(s.checkpoint_ratio));
} catch (const std::exception& error) {
  fmt::print(stderr, "swap: {}\n", error.what());
  return 1;
}
