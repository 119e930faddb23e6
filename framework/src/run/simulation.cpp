// One run: case, session, the loop over coupling steps with its audits, results, and the end, good or bad.
#include <mullion/app/simulation.hpp>

#include "io/atomic_file.hpp"
#include "log/console.hpp"
#include "process/guard.hpp"
#include "process/run_socket.hpp"
#include "run/audit.hpp"
#include "run/commands.hpp"
#include "run/progress.hpp"
#include "run/recorder.hpp"
#include "run/session.hpp"
#include "run/summary.hpp"
#include "run/time_plan.hpp"

#include <mullion/sdk/error.hpp>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <unistd.h>

namespace mullion {
namespace {

namespace fs = std::filesystem;

void print_error(const std::string& text)
{
  log::show_progress("");
  std::fprintf(stderr, "mullion: error: %s\n", text.c_str());
}

/// 2 where the command or the case is wrong, 1 where the run failed.
int exit_code_of(Errc code) { return code == Errc::config || code == Errc::plugin ? 2 : 1; }

/// The steps of the run. @return why it ended early, or ""
std::string run_steps(const RunOptions& options, run::Session& session, process::Supervisor& supervisor,
                      run::TimePlan& plan, run::Recorder& recorder, run::Commands& commands)
{
  auto& control = session.control();
  run::Progress progress(control.n_steps);
  run::Audit audit;
  const auto attempt_once = [&](const TimeStep& step) {
    session.begin_attempt();
    try {
      session.run_driver(step);
      session.check_limits(step);
    } catch (const Error& error) {
      const auto& hint = session.wiring().divergence_hint;
      if (error.code() != Errc::numeric || hint.empty()) throw;
      throw Error(Errc::numeric, fmt::format("{} ({})", error.what(), hint));
    }
  };
  const std::function<void(const TimeStep&)> attempt = [&](const TimeStep& step) {
    try {
      attempt_once(step);
    } catch (const Error& error) {
      if (commands.take_back(step, error.what())) return attempt(step);
      if (session.the_case().on_failure != "respawn" || error.code() != Errc::process) throw;
      const auto respawned = session.recover();
      if (respawned.empty()) throw;
      log::warning("run", "{}; respawned {}, step {} is done again from the last commit", error.what(), respawned,
                   step.index);
      attempt_once(step); // the same failure again ends the run
    }
  };
  for (std::int64_t n = control.step + 1; n <= plan.n_steps(); ++n) {
    commands.at_boundary(plan);
    const auto step = plan.step(n);
    attempt(step);
    if (options.replay) {
      audit.keep(session);
      attempt(step);
      audit.compare(session, step, "the same instances (--replay)");
    }
    if (options.amnesia > 0 && n % options.amnesia == 0) {
      audit.keep(session);
      session.renew();
      attempt(step);
      audit.compare(session, step, "fresh processes and a new driver (--amnesia)");
    }
    session.commit(step);
    commands.committed(step);
    recorder.record(step);
    progress.show(step);
    if (supervisor.is_stopping() && n < plan.n_steps()) return supervisor.stop_reason();
  }
  return "";
}

int orchestrate(const RunOptions& options, shm::Control& control, int control_fd)
{
  auto the_case = read_case(options.case_file, options.case_options);
  if (!the_case.diagnostics.empty()) {
    std::fputs(describe(options.case_file, the_case.diagnostics).c_str(), stderr);
    return 2;
  }
  Case& c = the_case.value; // as it stands: a live run can be changed
  shm::copy_text(control.run_name, sizeof control.run_name, c.name, "run name");
  process::RunSocket socket(c.name, control.guard_pid);

  const fs::path out = options.out.empty() ? fs::path("out") / c.name : fs::path(options.out);
  process::Supervisor supervisor(control, control_fd);
  plugin::Catalogue catalogue;
  run::Recorder recorder(c, out, control);
  run::Session session(c, catalogue, control, supervisor, {options.replay, options.has_deadlines});
  run::Commands commands(c, session, supervisor, recorder);
  try {
    supervisor.serve(socket, [&](const auto& line, const auto& reply) { commands.answer(line, reply); });
    session.start_fresh();
    run::TimePlan plan(c, session.wiring().needs_constant_step);
    control.n_steps = plan.n_steps();
    control.state = shm::RunState::running;
    recorder.begin(session);
    log::info("run", "{}: {} steps of {} s, results in {}", c.name, plan.n_steps(), c.dt, out.string());
    const auto stopped_by = run_steps(options, session, supervisor, plan, recorder, commands);
    commands.finish();
    log::show_progress("");
    recorder.summarise_interface();
    session.shut_down();
    supervisor.unserve();
    recorder.finish(stopped_by.empty() ? "completed" : "stopped", stopped_by);
    if (options.has_summary) std::fputs(run::summary(recorder, stopped_by).c_str(), stdout);
    return 0;
  } catch (const std::exception& error) {
    log::show_progress("");
    commands.finish();
    supervisor.unserve();
    recorder.finish("failed", error.what());
    if (const auto text = session.post_mortem(); !text.empty()) io::write_atomically(out / "post-mortem.txt", text);
    throw;
  }
}

} // namespace

int run_case(const RunOptions& options)
{
  log::Level level{};
  MULLION_REQUIRE(log::parse_level(options.log_level, level), Errc::config,
                  "--log-level '{}': expected debug, info, warning, error or off", options.log_level);
  return process::run_guarded([&](shm::Control& control, int control_fd) {
    try {
      log::initialise(level, ::isatty(STDERR_FILENO) != 0);
      return orchestrate(options, control, control_fd);
    } catch (const Error& error) {
      print_error(error.what());
      return exit_code_of(error.code());
    } catch (const std::exception& error) {
      print_error(error.what());
      return 1;
    }
  });
}

} // namespace mullion
