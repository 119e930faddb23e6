// One run: case or checkpoint, session, the loop over coupling steps with its audits, results, and the end, good or
// bad.
#include <mullion/app/simulation.hpp>

#include "io/atomic_file.hpp"
#include "log/console.hpp"
#include "process/run_socket.hpp"
#include "run/audit.hpp"
#include "run/commands.hpp"
#include "run/progress.hpp"
#include "run/recorder.hpp"
#include "run/recovery.hpp"
#include "run/restart.hpp"
#include "run/session.hpp"
#include "run/step_clock.hpp"
#include "run/summary.hpp"
#include "run/under_guard.hpp"

#include <mullion/sdk/error.hpp>

#include <cstdio>
#include <filesystem>
#include <optional>

namespace mullion {
namespace {

/// The steps of the run. @return why it ended early, or ""
std::string run_steps(const RunOptions& options, run::Session& session, process::Supervisor& supervisor,
                      run::StepClock& clock, run::Recorder& recorder, run::Commands& commands)
{
  const auto& the_case = session.the_case();
  run::Progress progress(session.control().n_steps);
  run::Audit audit;
  run::Recovery recovery(session, recorder, commands);
  std::string stopped_by;
  const auto attempt = [&](const TimeStep& step) {
    recovery.attempt(step);
    if (options.replay) {
      audit.keep(session);
      recovery.attempt(step);
      audit.compare(session, step, "the same instances (--replay)");
    }
    if (options.amnesia > 0 && step.index % options.amnesia == 0) {
      audit.keep(session);
      session.renew();
      recovery.attempt(step);
      audit.compare(session, step, "fresh processes and a new driver (--amnesia)");
    }
  };
  for (;;) {
    commands.at_boundary(clock);
    if (clock.is_at_end()) break;
    const auto step = clock.next();
    try {
      attempt(step);
    } catch (const Error& error) {
      const bool may_halve = error.code() == Errc::numeric && the_case.on_divergence == "halve_dt";
      if (!may_halve || !clock.halve(the_case.max_halvings)) throw;
      session.quiesce();
      recorder.note(step.index, "halve_dt", "", error.what());
      log::warning("run", "{}; step {} is done again with dt = {} s", error.what(), step.index, clock.next().dt);
      continue;
    }
    session.commit(step);
    commands.committed(step);
    clock.advance();
    session.control().n_steps = clock.n_steps();
    recovery.forget();
    recorder.record(step);
    progress.show(step);
    if (supervisor.is_stopping() && !clock.is_at_end()) {
      stopped_by = supervisor.stop_reason();
      break;
    }
  }
  recovery.between_steps([&] { recorder.summarise_interface(); });
  recovery.between_steps([&] { recorder.ask_functions(); });
  return stopped_by;
}

/// Bring the session to life. A module that dies meanwhile gets a second chance, from the very beginning, where
/// deaths are mended at all.
void start(run::Session& session, const run::Restart* restart)
{
  const auto bring_to_life = [&] {
    if (restart != nullptr) session.start_from(restart->checkpoint, restart->changed);
    else session.start_fresh();
  };
  try {
    bring_to_life();
  } catch (const Error& error) {
    if (error.code() != Errc::process || session.the_case().on_failure != "respawn") throw;
    log::warning("run", "{}; the start-up is done again from the beginning", error.what());
    session.forget_start();
    bring_to_life();
  }
}

int orchestrate(const RunOptions& options, shm::Control& control, int control_fd)
{
  auto begin = run::begin_of(options);
  if (!begin.the_case.diagnostics.empty()) {
    const auto& file = options.case_file.empty() ? options.restart : options.case_file;
    std::fputs(describe(file, begin.the_case.diagnostics).c_str(), stderr);
    return 2;
  }
  Case& c = begin.the_case.value; // as it stands: a live run can be changed
  const auto* restart = begin.restart ? &*begin.restart : nullptr;
  shm::copy_text(control.run_name, sizeof control.run_name, c.name, "run name");
  process::RunSocket socket(c.name, control.guard_pid);

  process::Supervisor supervisor(control, control_fd);
  plugin::Catalogue catalogue;
  run::Recorder recorder(c, begin.out, control, restart);
  run::Session session(c, catalogue, control, supervisor, {options.replay, options.has_deadlines});
  run::Commands commands(c, session, supervisor, recorder);
  std::optional<run::StepClock> clock;
  try {
    supervisor.serve(socket, [&](const auto& line, const auto& reply) { commands.answer(line, reply); });
    start(session, restart);
    const bool needs_constant_step = session.wiring().needs_constant_step;
    if (restart != nullptr) clock.emplace(c, needs_constant_step, restart->checkpoint.clock);
    else clock.emplace(run::TimePlan(c, needs_constant_step));
    control.n_steps = clock->n_steps();
    control.state = shm::RunState::running;
    recorder.begin(session, *clock);
    if (restart != nullptr)
      log::info("run", "goes on from {}: step {}, t = {} s", restart->file.string(), clock->step(), clock->time());
    log::info("run", "{}: {} steps of {} s, results in {}", c.name, clock->n_steps(), c.dt, begin.out.string());
    const auto stopped_by = run_steps(options, session, supervisor, *clock, recorder, commands);
    commands.finish();
    log::show_progress("");
    if (!stopped_by.empty() || c.checkpoint_every > 0) recorder.save_last_commit();
    session.shut_down();
    supervisor.unserve();
    recorder.finish(stopped_by.empty() ? "completed" : "stopped", stopped_by);
    if (options.has_summary) std::fputs(run::summary(recorder, stopped_by).c_str(), stdout);
    return 0;
  } catch (const std::exception& error) {
    log::show_progress("");
    commands.finish();
    supervisor.unserve();
    recorder.save_last_commit();
    recorder.finish("failed", error.what());
    if (const auto text = session.post_mortem(); !text.empty())
      io::write_atomically(begin.out / "post-mortem.txt", text);
    throw;
  }
}

} // namespace

int run_case(const RunOptions& options)
{
  return run::under_guard(options.log_level, [&](shm::Control& control, int control_fd) {
    return orchestrate(options, control, control_fd);
  });
}

} // namespace mullion
