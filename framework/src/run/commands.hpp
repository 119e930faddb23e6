// What a second terminal asks of a live run. Questions are answered by the supervisor's thread at once; what changes
// the run waits in a queue for the next step boundary, where the main thread does it, one thing at a time. The reply
// goes out when the outcome is known: for a swap, when the first step after it is committed, or was done again without.
// A candidate in a process attaches beside the run meanwhile; the boundary after that exchanges it.
//
// A line is a word, and behind a blank its arguments as JSON; a reply is JSON: {"ok": "what was done", "step": n}, or
// {"error": "why not", "code": n} with the number of an Errc.
#pragma once

#include "plugin/private_copy.hpp"
#include "process/run_socket.hpp"
#include "process/supervisor.hpp"
#include "run/recorder.hpp"
#include "run/session.hpp"
#include "run/step_clock.hpp"

#include <mullion/app/case_file.hpp>
#include <mullion/sdk/error.hpp>

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace mullion::run {

/// The two kinds of replies.
std::string reply_done(const std::string& what, std::int64_t step);
std::string reply_refused(Errc code, const std::string& why);

class Commands {
public:
  /// @param the_case  as it stands: what `set` and `swap` change is changed in it, its text included
  Commands(Case& the_case, Session& session, process::Supervisor& supervisor, Recorder& recorder)
      : case_(the_case), session_(session), supervisor_(supervisor), recorder_(recorder)
  {
  }

  // ---- the supervisor's thread ----
  void answer(const std::string& line, const process::Reply& reply);

  // ---- the main thread ----
  /// Between two steps: do what is asked for. The clock changes with run.end_time.
  void at_boundary(StepClock& clock)
  {
    if (session_.has_candidate() && session_.is_candidate_due()) exchange_candidate();
    if (has_pending_.load(std::memory_order_relaxed)) apply_pending(clock);
  }
  /// The step failed. @return was there a candidate on trial, which is taken back: then the step can be done again
  bool take_back(const TimeStep& step, const std::string& failure);
  /// The step was committed: a candidate on trial has passed.
  void committed(const TimeStep& step)
  {
    if (session_.has_trial()) keep(step);
  }
  /// No more steps: whoever waits learns it.
  void finish();

private:
  struct Pending {
    std::string what, arguments; ///< "swap", and JSON
    process::Reply reply;
  };
  /// What is on trial, and for whom.
  struct OnTrial {
    std::string what, instance, detail; ///< as run.json records them
    ModuleCase module;
    std::vector<ParameterValue> driver_parameters;
    process::Reply reply;
  };

  void apply_pending(StepClock& clock);
  void exchange_candidate();
  void apply(const Pending& command, StepClock& clock);
  void apply_swap(const Pending& command);
  void apply_set(const Pending& command, StepClock& clock);
  void set_run(const std::string& key, const std::string& value, StepClock& clock);
  void keep(const TimeStep& step);
  [[nodiscard]] std::string status() const;
  [[nodiscard]] std::string timings() const;
  /// By instance or kind. @throws Error Errc::config with the near name
  [[nodiscard]] std::uint32_t find_target(const std::string& name) const;

  Case& case_;
  Session& session_;
  process::Supervisor& supervisor_;
  Recorder& recorder_;
  plugin::PrivateCopies copies_;
  OnTrial on_trial_;

  std::mutex mutex_;
  std::deque<Pending> pending_;
  bool is_over_ = false;
  std::atomic<bool> has_pending_{false};
};

} // namespace mullion::run
