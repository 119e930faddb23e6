// What a coupled step costs with solvers that cost nothing: a 3-vector on N nodes each way, between two processes and
// inline, next to its floor in the same run: two processes, bare atomics, no copies, each side reads every value that
// it receives and writes every value that it owns. Also five processes on whatever cores there are, and the memory
// beyond the fields. Rounds are interleaved; medians of rounds and of their ratios.
//
//   build-dev/bench/coupled_step [--rounds R] [--largest N]
#include "mullion_run.hpp"
#include "shm/memory_object.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using mullion::bench::median;
namespace fs = std::filesystem;

void echo(const double* in, double* out, std::size_t n)
{
  for (std::size_t k = 0; k < n; ++k) out[k] = 0.5 * in[k] + 1.0;
}

/// Seconds per exchange of two processes over bare atomics.
double floor_step(std::size_t nodes, long steps)
{
  const std::size_t n = 3 * nodes, bytes = 4096 + 2 * ((n * 8 + 4095) / 4096) * 4096;
  const auto object = mullion::shm::create_object("floor", bytes);
  const auto map = mullion::shm::map_object(::getpid(), object.get(), mullion::shm::Access::read_write);
  auto* word = reinterpret_cast<std::atomic<long>*>(map.data);
  auto* a = reinterpret_cast<double*>(map.data + 4096);
  auto* b = a + (n * 8 + 4095) / 4096 * 512;
  std::fflush(stdout); // or the child prints it again
  const pid_t other = ::fork();
  if (other == 0) {
    for (long s = 0; s < steps; ++s) {
      while (word->load(std::memory_order_acquire) != 2 * s + 1) {
      }
      echo(a, b, n);
      word->store(2 * s + 2, std::memory_order_release);
    }
    ::_exit(0);
  }
  auto begin = Clock::now();
  for (long s = 0; s < steps; ++s) {
    if (s == 1) begin = Clock::now(); // the first touches the pages
    echo(b, a, n);
    word->store(2 * s + 1, std::memory_order_release);
    while (word->load(std::memory_order_acquire) != 2 * s + 2) {
    }
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  ::waitpid(other, nullptr, 0);
  return seconds / static_cast<double>(steps - 1);
}

/// Proportional set size of a process and all its descendants [bytes].
double pss_of_tree(pid_t root)
{
  double total = 0;
  std::vector<pid_t> todo{root};
  while (!todo.empty()) {
    const pid_t pid = todo.back();
    todo.pop_back();
    std::ifstream rollup(fmt::format("/proc/{}/smaps_rollup", pid));
    for (std::string line; std::getline(rollup, line);)
      if (line.rfind("Pss:", 0) == 0) total += std::strtod(line.c_str() + 4, nullptr) * 1024;
    std::error_code none;
    for (const auto& task : fs::directory_iterator(fmt::format("/proc/{}/task", pid), none)) {
      std::ifstream children(task.path() / "children");
      for (pid_t child = 0; children >> child;) todo.push_back(child);
    }
  }
  return total;
}

struct Run {
  double step_s = 0, pss = 0;
};

/// Run a case file for this many steps; what run.json says a step took.
Run mullion_step(const std::string& case_file, std::vector<std::string> sets, long steps, bool with_memory,
                 const std::string& plugin_path = mullion::bench::echo_plugins)
{
  sets.insert(sets.begin(), fmt::format("run.end_time={}.0", steps));
  Run run;
  const std::function<void(pid_t)> watch = [&](pid_t pid) { run.pss = std::max(run.pss, pss_of_tree(pid)); };
  const auto attempt =
      mullion::bench::mullion_run(case_file, sets, plugin_path, with_memory ? watch : std::function<void(pid_t)>{});
  run.step_s = attempt.at("wall_s").get<double>() / static_cast<double>(steps);
  return run;
}

} // namespace

int main(int argc, char** argv)
{
  int rounds = 7;
  long largest = 1'000'000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--largest") == 0) largest = std::atol(argv[i + 1]);
  }
  const auto file = fs::temp_directory_path() / fmt::format("mullion-bench-{}.toml", ::getpid());
  mullion::bench::write_echo_case({.name = "bench-coupled-step"}, file);
  fmt::print("{:>9} {:>12} {:>12} {:>8} {:>12} {:>8} {:>16}\n", "nodes", "floor", "two proc.", "/ floor", "inline",
             "/ floor", "memory - fields");
  for (const long nodes : {10L, 100L, 1000L, 10'000L, 100'000L, 1'000'000L}) {
    if (nodes > largest) break;
    const long steps = std::clamp(100'000'000L / (3 * nodes + 300), 40L, 100'000L);
    const std::vector<std::string> size{fmt::format("fluid.nodes={}", nodes), fmt::format("structure.nodes={}", nodes)};
    auto two = size;
    two.emplace_back("structure.process=true");
    std::vector<double> floors, pairs, inlines, pair_ratios, inline_ratios;
    for (int r = 0; r < rounds; ++r) {
      floors.push_back(floor_step(static_cast<std::size_t>(nodes), steps));
      pairs.push_back(mullion_step(file, two, steps, false).step_s);
      inlines.push_back(mullion_step(file, size, steps, false).step_s);
      pair_ratios.push_back(pairs.back() / floors.back());
      inline_ratios.push_back(inlines.back() / floors.back());
    }
    // fields: 2 modules x 2 levels x 3 doubles a node, and the reference coordinates and point elements
    const double fields = static_cast<double>(nodes) * (2 * 2 * 24 + 2 * (24 + 4));
    const double memory = mullion_step(file, two, steps * 3, true).pss - fields;
    fmt::print("{:>9} {:>9.2f} us {:>9.2f} us {:>8.2f} {:>9.2f} us {:>8.2f} {:>13.1f} MB\n", nodes,
               1e6 * median(floors), 1e6 * median(pairs), median(pair_ratios), 1e6 * median(inlines),
               median(inline_ratios), memory / 1e6);
    std::fflush(stdout);
  }
  fs::remove(file);
  std::vector<double> five;
  for (int r = 0; r < rounds; ++r)
    five.push_back(
        mullion_step(MULLION_SOURCE_DIR "/configs/closed_piston.toml",
                     {"run.dt=6e-6", "run.end_time=0.06", "output.every=0", "output.history=false", "expect=[]"}, 10000,
                     false, "")
            .step_s);
  fmt::print("\nclosed piston, five processes on {} cores, five calls a step: {:.1f} us a step\n",
             ::sysconf(_SC_NPROCESSORS_ONLN), 1e6 * median(five));
}
