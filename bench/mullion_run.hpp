// One `mullion run` of a benchmark, and what its run.json says.
#pragma once

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
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

/// @param watch  if given: called with the run's pid every 20 ms while it lasts
/// @returns the record of the run's only attempt; a run that fails ends the benchmark
inline nlohmann::json mullion_run(const std::string& case_file, const std::vector<std::string>& sets,
                                  const std::string& plugin_path, const std::function<void(pid_t)>& watch = {})
{
  const auto out = std::filesystem::temp_directory_path() / fmt::format("mullion-bench-{}", ::getpid());
  std::vector<std::string> words{
      MULLION_BUILD_DIR "/bin/mullion", "run", case_file, "--out", out.string(), "--log-level", "error"};
  for (const auto& set : sets) {
    words.emplace_back("--set");
    words.push_back(set);
  }
  std::fflush(stdout); // or the child prints it again
  const pid_t pid = ::fork();
  if (pid == 0) {
    if (!plugin_path.empty()) ::setenv("MULLION_PLUGIN_PATH", plugin_path.c_str(), 1);
    (void)!std::freopen("/dev/null", "w", stdout);
    std::vector<char*> arguments;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
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
