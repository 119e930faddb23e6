// A run that a benchmark watches and disturbs while it goes on; it ends with the object.
#pragma once

#include "mullion_run.hpp"

#include "shm/control.hpp"
#include "shm/memory_object.hpp"

#include <mullion/app/inspect.hpp>
#include <mullion/sdk/error.hpp>

#include <csignal>
#include <stdexcept>

namespace mullion::bench {

class LiveRun {
public:
  /// @param words   of `mullion run`, the case file first
  /// @param folder  made here and removed at the end; results go there
  LiveRun(std::string name, std::vector<std::string> words, const std::string& plugin_path,
          std::filesystem::path folder)
      : name_(std::move(name)), folder_(std::move(folder))
  {
    std::filesystem::create_directories(folder_);
    words.insert(words.end(),
                 {"--set", "run.name=" + name_, "--out", (folder_ / "out").string(), "--log-level", "off"});
    pid_ = start_mullion_run(words, plugin_path);
    for (int i = 0; i < 120'000 && ::waitpid(pid_, nullptr, WNOHANG) == 0; ++i) {
      try {
        if (look().step > 2) break;
      } catch (const Error&) { // not yet
      }
      ::usleep(1000);
    }
    // The control object, as an onlooker maps it: what is polled costs the run nothing.
    const auto run = look();
    for (const auto& entry : std::filesystem::directory_iterator(fmt::format("/proc/{}/fd", run.orchestrator))) {
      std::error_code closed_meanwhile;
      if (std::filesystem::read_symlink(entry, closed_meanwhile).string().find("mullion:control") != std::string::npos)
        mapping_ = shm::map_object(static_cast<pid_t>(run.orchestrator), std::stoi(entry.path().filename()),
                                   shm::Access::read_only);
    }
    if (mapping_.data == nullptr) throw std::runtime_error("the run did not start");
  }
  ~LiveRun()
  {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
    std::filesystem::remove_all(folder_);
  }
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] RunLook look() const { return look_at_run(name_); }
  [[nodiscard]] const shm::Control& control() const { return *reinterpret_cast<const shm::Control*>(mapping_.data); }
  void wait_steps(std::int64_t n) const
  {
    const auto end = control().step + n;
    while (control().step < end) {
      if (::kill(pid_, 0) != 0 || control().state.load() != shm::RunState::running)
        throw std::runtime_error("the run ended before the benchmark did");
      ::usleep(20);
    }
  }

private:
  std::string name_;
  std::filesystem::path folder_;
  pid_t pid_ = 0;
  shm::Mapping mapping_;
};

} // namespace mullion::bench
