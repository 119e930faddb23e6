// What the benchmarks share: medians and times; one `mullion run` with what its run.json says; the case of two solvers
// that cost nothing; and a plain write to compare with.
#pragma once

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace mullion::bench {

inline double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

inline double milliseconds_since(std::chrono::steady_clock::time_point begin)
{
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

template <class Action> double milliseconds(Action&& action)
{
  const auto begin = std::chrono::steady_clock::now();
  action();
  return milliseconds_since(begin);
}

/// What any file costs: write and sync of these bytes.
inline void write_plainly(const std::filesystem::path& path, std::span<const std::byte> bytes)
{
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  for (std::size_t done = 0; done < bytes.size();) {
    const auto n = ::write(fd, bytes.data() + done, std::min<std::size_t>(bytes.size() - done, 1u << 30));
    if (n <= 0) {
      fmt::print(stderr, "cannot write {}\n", path.string());
      std::exit(1);
    }
    done += static_cast<std::size_t>(n);
  }
  ::fsync(fd);
  ::close(fd);
}

/// Two solvers that cost nothing, and the driver between them (bench/plugins).
struct EchoCase {
  std::string name; ///< of the run
  long nodes = 10;  ///< of the interface: a 3-vector each way on each
  bool in_processes = false;
  std::string structure = "module = \"echo_structure\""; ///< its module, and keys of its own
  double end_time = 1.0;                                 ///< steps
  const char* on_failure = "stop";
};

inline constexpr const char* echo_plugins = MULLION_BUILD_DIR "/bench/plugins";

inline void write_echo_case(const EchoCase& c, const std::filesystem::path& file)
{
  std::ofstream(file) << fmt::format(R"([run]
name = "{0}"
dt = 1.0
end_time = {1:.1f}
on_failure = "{2}"
[fluid]
module = "echo_fluid"
nodes = {3}
process = {4}
[structure]
{5}
nodes = {3}
process = {4}
[coupling]
interfaces = [["fluid.wall", "structure.wet"]]
[driver]
scheme = "echo"
[output]
history = false
)",
                                     c.name, c.end_time, c.on_failure, c.nodes, c.in_processes, c.structure);
}

/// Start `mullion run` with these words behind it, its standard output thrown away.
/// @param plugin_path  "": none besides the installed one
inline pid_t start_mullion_run(const std::vector<std::string>& words, const std::string& plugin_path)
{
  std::fflush(stdout); // or the child prints it again
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  if (!plugin_path.empty()) ::setenv("MULLION_PLUGIN_PATH", plugin_path.c_str(), 1);
  (void)!std::freopen("/dev/null", "w", stdout);
  auto all = words;
  all.insert(all.begin(), {MULLION_BUILD_DIR "/bin/mullion", "run"});
  std::vector<char*> arguments;
  for (auto& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(arguments[0], arguments.data());
  ::_exit(127);
}

/// @param watch  if given: called with the run's pid every 20 ms while it lasts
/// @returns the record of the run's only attempt; a run that fails ends the benchmark
inline nlohmann::json mullion_run(const std::string& case_file, const std::vector<std::string>& sets,
                                  const std::string& plugin_path, const std::function<void(pid_t)>& watch = {})
{
  const auto out = std::filesystem::temp_directory_path() / fmt::format("mullion-bench-{}", ::getpid());
  std::vector<std::string> words{case_file, "--out", out.string(), "--log-level", "error"};
  for (const auto& set : sets) {
    words.emplace_back("--set");
    words.push_back(set);
  }
  const pid_t pid = start_mullion_run(words, plugin_path);
  int status = 0;
  while (::waitpid(pid, &status, watch ? WNOHANG : 0) == 0) {
    watch(pid);
    ::usleep(20000);
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    fmt::print(stderr, "mullion run failed: {}\n", fmt::join(words, " "));
    std::exit(1);
  }
  auto attempt = nlohmann::json::parse(std::ifstream(out / "run.json")).at("attempts").back();
  std::filesystem::remove_all(out);
  return attempt;
}

} // namespace mullion::bench
