// How a second terminal finds and talks to a live run: one Unix socket per run in the user's runtime folder, one
// line in, one line back. A lock file beside it, held while the run lives, makes its name unique; both files are
// leftovers without meaning once nobody holds the lock.
#pragma once

#include "shm/memory_object.hpp"

#include <functional>
#include <string>
#include <vector>

namespace mullion::process {

/// MULLION_RUNTIME_DIR, or mullion/ in XDG_RUNTIME_DIR, or /tmp/mullion-<uid>; made if need be.
/// @throws Error Errc::io if it belongs to another user or others may write to it
std::string runtime_folder();

class RunSocket {
public:
  /// Claim the name and listen. @throws Error Errc::config if a live run has it (with its pid)
  RunSocket(const std::string& run_name, pid_t pid);
  ~RunSocket();
  RunSocket(const RunSocket&) = delete;
  RunSocket& operator=(const RunSocket&) = delete;

  [[nodiscard]] int descriptor() const { return socket_.get(); }
  /// Accept one client of our user, read its line, answer, close. A slow or dying client is dropped.
  void answer_one(const std::function<std::string(const std::string&)>& answer);

private:
  std::string path_, lock_path_;
  shm::Descriptor lock_, socket_;
};

/// Names of the runs that are alive now, sorted; leftovers of dead ones are removed.
std::vector<std::string> live_runs();

/// Send one line to a live run and return its answer. @throws Error Errc::config: no such run, with the live ones
std::string ask_run(const std::string& run_name, const std::string& line);

/// Remove the leftovers of a run if it is dead.
void clean_up(const std::string& run_name);

} // namespace mullion::process
