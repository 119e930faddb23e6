// A coupling step that is done until it succeeds or must fail: after the death of a host, with on_failure = "respawn",
// everything goes back to the last commit, the host is started anew, and the step is done again. What fails twice in
// the same way in one step would fail for ever: it ends the run.
#pragma once

#include "run/commands.hpp"
#include "run/recorder.hpp"
#include "run/session.hpp"

#include <functional>
#include <set>
#include <string>

namespace mullion::run {

class Recovery {
public:
  Recovery(Session& session, Recorder& recorder, Commands& commands)
      : session_(session), recorder_(recorder), commands_(commands)
  {
  }

  /// Begin the attempt from the last commit and have the driver do the step, as often as it takes.
  /// @throws Error what ends the step
  void attempt(const TimeStep& step);
  /// The step is committed: what failed in it counts no more.
  void forget() { deaths_.clear(); }
  /// Do something between steps that calls modules; after a death of a host once more.
  void between_steps(const std::function<void()>& action);

private:
  void attempt_once(const TimeStep& step);
  /// @throws Error the one given, if that must not be mended
  void recover(const Error& error, std::int64_t step, const std::string& then);

  static constexpr std::size_t most_deaths = 20; ///< in one step, each of another kind
  Session& session_;
  Recorder& recorder_;
  Commands& commands_;           ///< a candidate on trial is taken back before anything else is mended
  std::set<std::string> deaths_; ///< in the step at hand
};

} // namespace mullion::run
