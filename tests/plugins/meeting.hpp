// Two solvers that meet in every step: each leaves a file that says it is there, and waits for the other's. They only
// get on if they are at work at the same time.
#pragma once

#include <mullion/sdk/module.hpp>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace mullion::test {

struct MeetingOptions {
  std::string folder;
  double patience = 10.0;
  static constexpr auto table()
  {
    return std::tuple{
        required_parameter("folder", &MeetingOptions::folder, "", "where the files lie"),
        parameter("patience", &MeetingOptions::patience, "s", "how long to wait for the other one", above(0.0))};
  }
};

/// @throws Error the other one didn't come
inline void meet(const MeetingOptions& options, const std::string& self, const std::string& other, const TimeStep& step)
{
  namespace fs = std::filesystem;
  const auto file = [&](const std::string& who) {
    return fs::path(options.folder) / fmt::format("{}.{}.{}", who, step.index, step.iteration);
  };
  std::ofstream(file(self)).put('\n');
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.patience);
  while (!fs::exists(file(other))) {
    MULLION_REQUIRE(std::chrono::steady_clock::now() < deadline, Errc::numeric,
                    "the {} waited for {} s in step {}, iteration {}, and the {} did not come", self, options.patience,
                    step.index, step.iteration, other);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

} // namespace mullion::test
