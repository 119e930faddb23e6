// Run a program as a user would and look at what it printed and how it ended. Its output goes to memory files, not
// pipes: nobody has to drain them, and a grandchild that lives on cannot keep a test waiting for end-of-file.
//
// Every process gets a group of its own, and the whole group is killed when a test is done with it.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

namespace mullion::test {

struct ProcessOptions {
  std::vector<std::pair<std::string, std::string>> environment; ///< on top of this process's own
  std::string folder;                                           ///< to run in; "": this process's
  std::chrono::milliseconds timeout = std::chrono::seconds(60);
};

struct ProcessResult {
  int exit_code = -1; ///< -1: it did not exit
  int signal = 0;     ///< that ended it; SIGKILL after a timeout
  bool has_timed_out = false;
  std::string out, err;
};

class Process {
public:
  /// Start it; standard input is empty. @param command program (a path, or found on PATH) and arguments
  /// @throws std::runtime_error if it cannot be started
  explicit Process(const std::vector<std::string>& command, ProcessOptions options = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  void send(int signal) const; ///< to the process alone, not to its group
  [[nodiscard]] bool is_running() const;

  /// What it has printed so far.
  [[nodiscard]] std::string out() const;
  [[nodiscard]] std::string err() const;

  /// Wait for its end, at most for the timeout from now; then the group is killed.
  ProcessResult wait();

private:
  void kill_group();
  ProcessOptions options_;
  pid_t pid_ = 0;
  int pidfd_ = -1, out_ = -1, err_ = -1;
  bool is_reaped_ = false;
  ProcessResult result_;
};

/// Start, wait, and tell.
ProcessResult run_process(const std::vector<std::string>& command, const ProcessOptions& options = {});

} // namespace mullion::test
