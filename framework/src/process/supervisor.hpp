// The thread that lives as long as the orchestrator and does what must not wait for a coupling step: spawns hosts
// (PDEATHSIG fires when the forking *thread* ends), drains their output, notices deaths through pidfds, reacts to
// signals, and serves the run's socket.
//
// The main thread asks it to spawn and retire and reads flags; it never touches windows.
#pragma once

#include "process/run_socket.hpp"
#include "shm/control.hpp"
#include "shm/memory_object.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace mullion::process {

/// A host process. `is_dead` is set, with everything else final, once it was reaped.
struct Host {
  std::uint32_t module = 0, incarnation = 0;
  std::string name;
  pid_t pid = 0;
  shm::Descriptor pidfd, out, err, reply_object;
  shm::Mapping reply_mapping; ///< read-only here: the host is its one writer
  std::atomic<bool> is_dead{false};
  int wait_status = 0;
  std::string partial_out, partial_err;

  [[nodiscard]] const shm::Reply& reply() const { return *reinterpret_cast<const shm::Reply*>(reply_mapping.data); }
  /// The last lines that it printed, at most 50, oldest first.
  [[nodiscard]] std::vector<std::string> tail() const;
  void remember(std::string line);

private:
  mutable std::mutex mutex_;
  std::deque<std::string> tail_;
};

class Supervisor {
public:
  /// Blocks the signals that it handles in the calling thread (and so in all that it starts).
  Supervisor(shm::Control& control, int control_fd);
  /// Kills what is left of the hosts.
  ~Supervisor();

  /// Start a host for a module. @throws Error Errc::process
  std::shared_ptr<Host> spawn(std::uint32_t module);
  /// Kill and reap; returns when that is done.
  void kill(Host& host);
  /// Wait for a host that was asked to quit; kill it after `patience`.
  void join(Host& host, std::chrono::milliseconds patience);

  /// Why the run shall end at the next step boundary ("SIGINT", "mullion stop"); "" if it shall not.
  [[nodiscard]] std::string stop_reason() const;
  [[nodiscard]] bool is_stopping() const { return is_stopping_.load(std::memory_order_relaxed); }
  void request_stop(const std::string& reason);

  /// Of the control object, in this process.
  [[nodiscard]] int control_fd() const { return control_fd_; }

  /// How long the run stood still under Ctrl-Z; deadlines don't count that time.
  [[nodiscard]] std::chrono::nanoseconds paused() const;

  /// Serve the run's socket; `answer` is called in the supervisor's thread, which must not wait for anything there.
  void serve(RunSocket& socket, Answer answer);
  void unserve(); ///< before what `answer` refers to goes

private:
  void loop();
  void run_tasks();
  void do_in_thread(std::function<void()> task);
  void start_process(Host& host);
  void drain(Host& host);
  void reap(Host& host);
  void on_signal();
  void pause_all();

  shm::Control& control_;
  int control_fd_;
  std::string host_path_;
  shm::Descriptor wake_, signals_;
  std::mutex mutex_;
  std::deque<std::packaged_task<void()>> tasks_;
  bool is_over_ = false;
  std::vector<std::shared_ptr<Host>> hosts_; ///< supervisor thread only
  std::atomic<bool> is_stopping_{false};
  mutable std::mutex reason_mutex_;
  std::string reason_;
  std::chrono::steady_clock::time_point first_stop_signal_{};
  std::atomic<std::int64_t> paused_ns_{0}, pause_begin_ns_{0}; ///< begin 0: not paused
  RunSocket* socket_ = nullptr;                                ///< supervisor thread only
  Answer answer_;
  std::thread thread_; ///< last: starts when everything else stands
};

/// "was killed by signal 9 (SIGKILL)" or "exited with code 3".
std::string describe_end(int wait_status);

} // namespace mullion::process
