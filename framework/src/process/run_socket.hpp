// How a second terminal finds and talks to a live run: one Unix socket per run in the user's runtime folder, one
// line in, one line back. A lock file beside it, held while the run lives, makes its name unique; both files are
// leftovers without meaning once nobody holds the lock.
//
// The run's side never waits for a client: every descriptor is non-blocking, one that sends or reads too slowly is
// dropped, and the death of a client changes nothing.
#pragma once

#include "shm/memory_object.hpp"

#include <poll.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace mullion::process {

/// MULLION_RUNTIME_DIR, or mullion/ in XDG_RUNTIME_DIR, or /tmp/mullion-<uid>; made if need be.
/// @throws Error Errc::io if it belongs to another user or others may write to it
std::string runtime_folder();

/// The way back to one client: call it once, from any thread, at once or when the outcome is known. A client that has
/// gone meanwhile gets nothing, and nobody minds.
using Reply = std::function<void(const std::string& text)>;

/// What a run does with a line; called by the thread that serves.
using Answer = std::function<void(const std::string& line, Reply reply)>;

class RunSocket {
public:
  /// Claim the name and listen. @throws Error Errc::config if a live run has it (with its pid)
  RunSocket(const std::string& run_name, pid_t pid);
  ~RunSocket();
  RunSocket(const RunSocket&) = delete;
  RunSocket& operator=(const RunSocket&) = delete;

  /// What a poll has to watch, and for how long at most [ms] (-1: no limit).
  void watch(std::vector<pollfd>& polled) const;
  [[nodiscard]] int patience() const;
  /// Accept clients of our user, read and answer their lines, send what is due, drop who is too slow. Never blocks.
  void serve(const Answer& answer);

private:
  using Clock = std::chrono::steady_clock;
  struct Outbox;
  struct Client {
    std::uint64_t number = 0;
    shm::Descriptor socket;
    std::string in, out; ///< the line so far; what is still to be sent
    enum class State { reading, waiting, sending } state = State::reading;
    Clock::time_point deadline; ///< to send the line, or to take the answer
  };

  void accept_clients();
  void read_line_of(Client& client, const Answer& answer);
  void start_sending(Client& client, const std::string& text);
  void send_to(Client& client);

  std::string path_, lock_path_;
  shm::Descriptor lock_, socket_;
  std::vector<Client> clients_;
  std::uint64_t n_clients_ = 0;
  std::shared_ptr<Outbox> outbox_; ///< replies from other threads; they may outlive us
};

/// Names of the runs that are alive now, sorted; leftovers of dead ones are removed.
std::vector<std::string> live_runs();

/// Send one line to a live run and return its answer.
/// @param patience  how long to wait for it; 0: as long as the run lives
/// @throws Error Errc::config: no such run, with the live ones; Errc::process: it ended, or did not answer in time
std::string ask_run(const std::string& run_name, const std::string& line,
                    std::chrono::seconds patience = std::chrono::seconds(5));

/// Remove the leftovers of a run if it is dead.
void clean_up(const std::string& run_name);

} // namespace mullion::process
