// run_study(): reads, checks, takes over what an earlier study in the folder has finished, runs the rest, some at a
// time, and writes the table.
//
// Every run is a process of its own, `mullion run`, and dies with this one. All that must survive a kill stands in
// the folder: study.toml (whose folder it is) and a done.json per finished run.
#include <mullion/app/study.hpp>

#include "io/atomic_file.hpp"
#include "log/console.hpp"
#include "process/child.hpp"
#include "study/plan.hpp"
#include "study/run_result.hpp"
#include "study/study_folder.hpp"
#include "study/study_progress.hpp"
#include "study/study_table.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <set>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace mullion {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using study::RunResult;
using study::StudyFile;

constexpr std::size_t n_printed = 20;                     ///< rows of the table that a terminal shows
constexpr auto table_interval = std::chrono::seconds(10); ///< from one writing of the table to the next, on the way
/// One Ctrl-C can arrive twice (from the terminal and from a wrapper such as timeout): that is one request.
constexpr auto same_request = std::chrono::milliseconds(100);

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// ---- signals -----------------------------------------------------------------------------------------------------

/// Blocks what we wait for, and takes over the orphans of our children, as long as it lives.
class SignalScope {
public:
  SignalScope()
  {
    sigemptyset(&set_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCHLD}) sigaddset(&set_, signal);
    ::pthread_sigmask(SIG_BLOCK, &set_, &before_);
    ::prctl(PR_GET_CHILD_SUBREAPER, &was_subreaper_);
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  }
  ~SignalScope()
  {
    ::prctl(PR_SET_CHILD_SUBREAPER, was_subreaper_);
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  SignalScope(const SignalScope&) = delete;
  SignalScope& operator=(const SignalScope&) = delete;

  /// The next signal; 0 if none came within the time.
  [[nodiscard]] int wait(std::chrono::milliseconds patience) const
  {
    const timespec time{patience.count() / 1000, patience.count() % 1000 * 1'000'000};
    return std::max(0, ::sigtimedwait(&set_, nullptr, &time));
  }

private:
  sigset_t set_{}, before_{};
  int was_subreaper_ = 0;
};

// ---- the runs ----------------------------------------------------------------------------------------------------

class Runner {
public:
  Runner(const StudyFile& study, const study::Plan& plan, fs::path folder)
      : study_(study), plan_(plan), folder_(std::move(folder)), results_(plan.runs.size())
  {
  }
  ~Runner() { end_all(); }
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// What an earlier study in this folder has finished.
  void take_over(bool has_retry)
  {
    for (std::size_t r = 0; r < results_.size(); ++r) {
      auto result = study::read_result(folder_of(r), plan_.runs[r].fingerprint, measuring_of(r));
      std::error_code none;
      if (!result && fs::exists(folder_of(r) / "done.json", none)) ++n_outdated_;
      if (!result || (has_retry && result->outcome != "completed")) {
        waiting_.push_back(r);
        continue;
      }
      study::tidy(folder_of(r), *result, study_.keep);
      note(*result);
      results_[r] = std::move(result);
    }
    counts_.n_runs = results_.size();
    counts_.n_before = counts_.n_done;
    std::reverse(waiting_.begin(), waiting_.end()); // taken from the back
  }

  /// Run the others. @return the signal that ended it early, "" without one
  std::string run(std::size_t n_parallel)
  {
    const SignalScope signals;
    study::Progress progress;
    while (!children_.empty() || (!waiting_.empty() && stopped_by_.empty())) {
      while (children_.size() < n_parallel && !waiting_.empty() && stopped_by_.empty()) start_next();
      counts_.n_running = children_.size();
      progress.show(counts_);
      if (const int signal = signals.wait(std::chrono::milliseconds(100)); signal == SIGTSTP) pause();
      else if (signal != 0 && signal != SIGCHLD) stop(signal);
      reap();
      if (Clock::now() >= next_table_) {
        write_csv();
        next_table_ = Clock::now() + table_interval;
      }
    }
    end_all();
    log::show_progress("");
    return stopped_by_;
  }

  void write_csv() const
  {
    io::write_atomically(folder_ / "study.csv", study::csv_text(study::make_table(study_, results_)));
  }
  [[nodiscard]] const std::vector<std::optional<RunResult>>& results() const { return results_; }
  [[nodiscard]] const study::Counts& counts() const { return counts_; }
  /// Runs that were finished, but with another case, program or plug-in, or whose files have changed.
  [[nodiscard]] std::size_t n_outdated() const { return n_outdated_; }

private:
  struct Child {
    pid_t pid = 0;
    std::size_t run = 0;
  };

  [[nodiscard]] fs::path folder_of(std::size_t run) const { return folder_ / "runs" / fmt::format("{}", run); }
  [[nodiscard]] study::Measuring measuring_of(std::size_t run) const
  {
    return {study_.measures_of(run), study_.measures_failed};
  }

  void note(const RunResult& result)
  {
    ++counts_.n_done;
    if (result.outcome != "completed") ++counts_.n_failed;
  }

  void start_next()
  {
    const auto r = waiting_.back();
    const auto& run = plan_.runs[r];
    const auto folder = folder_of(r);
    std::error_code none;
    fs::remove_all(folder, none); // whatever an unfinished run left must not be taken for this one's
    io::make_folder(folder);
    std::vector<std::string> command = {executable_,     "run",         study_.case_file, "--out",
                                        folder.string(), "--log-level", "error"};
    if (const auto flag = study::placement_flag(study_); !flag.empty()) command.push_back(flag);
    for (const auto& text : run.overrides) command.insert(command.end(), {"--set", text});
    children_.push_back({process::start_child(command, (folder / "output.txt").string()), r});
    waiting_.pop_back();
  }

  /// Take the results of those that have ended. Orphans of our children end here too.
  void reap()
  {
    for (;;) {
      int status = 0;
      const pid_t pid = ::waitpid(-1, &status, WNOHANG);
      if (pid <= 0) return;
      const auto child = std::find_if(children_.begin(), children_.end(), [&](const Child& c) { return c.pid == pid; });
      if (child == children_.end()) continue;
      const auto r = child->run;
      children_.erase(child);
      finish(r, status);
    }
  }

  void finish(std::size_t r, int status)
  {
    const auto folder = folder_of(r);
    auto result = study::collect(folder, status);
    if (!stopped_by_.empty() && result.outcome != "completed") return; // we ended it: it is done again next time
    const auto measuring = measuring_of(r);
    result.fingerprint = plan_.runs[r].fingerprint;
    study::measure(result, folder, measuring);
    study::write_result(folder, result, measuring);
    study::tidy(folder, result, study_.keep);
    note(result);
    const auto which = study_.axes.empty() ? "" : fmt::format(" ({})", study_.describe_run(r));
    if (result.outcome != "completed")
      log::warning("study", "run {}{} {}: {}", r, which, result.outcome, result.message);
    for (const auto& problem : result.problems)
      if (reported_.insert(problem).second) log::warning("study", "run {}{}: {}", r, which, problem);
    results_[r] = std::move(result);
  }

  void signal_all(int signal) const
  {
    for (const auto& child : children_) ::kill(child.pid, signal);
  }

  void stop(int signal)
  {
    const auto now = Clock::now();
    const std::string name = std::string("SIG") + ::sigabbrev_np(signal);
    if (stopped_by_.empty()) {
      stopped_by_ = name;
      stopped_at_ = now;
      log::warning("study",
                   "{}: {} runs end after the step at hand and are done again next time; once more ends them "
                   "at once",
                   name, children_.size());
      signal_all(SIGTERM);
    } else if (now - stopped_at_ > same_request) {
      log::warning("study", "{}: the runs are ended at once", name);
      signal_all(SIGKILL);
    }
  }

  /// Ctrl-Z: the runs, then we; `fg` wakes all.
  void pause() const
  {
    signal_all(SIGTSTP);
    ::raise(SIGSTOP);
    signal_all(SIGCONT);
  }

  /// Nothing of the study lives on: neither runs, nor the remains of those that were killed.
  void end_all() noexcept
  {
    signal_all(SIGKILL);
    const auto give_up = Clock::now() + std::chrono::seconds(5);
    while (Clock::now() < give_up) {
      const pid_t ended = ::waitpid(-1, nullptr, WNOHANG);
      if (ended < 0) break; // no child is left
      if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    children_.clear();
  }

  const StudyFile& study_;
  const study::Plan& plan_;
  const fs::path folder_;
  const std::string executable_ = fs::read_symlink("/proc/self/exe").string();
  std::vector<std::optional<RunResult>> results_;
  std::vector<std::size_t> waiting_; ///< the next one at the back
  std::vector<Child> children_;
  study::Counts counts_;
  std::size_t n_outdated_ = 0;
  std::set<std::string> reported_; ///< problems of measures: the same in each run, as a rule
  std::string stopped_by_;
  Clock::time_point stopped_at_{}, next_table_ = Clock::now() + table_interval;
};

// ---- the end -----------------------------------------------------------------------------------------------------

StudyOutcome finish_study(const StudyFile& study, const Runner& runner, const fs::path& out,
                          const std::string& stopped_by, double wall_s)
{
  StudyOutcome outcome;
  outcome.n_runs = runner.results().size();
  outcome.interrupted_by = stopped_by;
  outcome.out = out.string();
  for (const auto& result : runner.results()) {
    if (!result) continue;
    if (result->outcome == "completed") ++outcome.n_completed;
    else if (result->outcome == "failed") ++outcome.n_failed;
    else ++outcome.n_stopped;
    if (result->outcome == "completed" && !result->problems.empty()) ++outcome.n_incomplete;
  }
  const auto table = study::make_table(study, runner.results());
  io::write_atomically(out / "study.csv", study::csv_text(table));
  io::write_atomically(out / "study.h5", study::hdf5_file(table), io::Trailer::checksum);
  io::write_atomically(out / "study.json", study::json_text(study, runner.results(), wall_s));

  auto& text = outcome.summary = study::printed(table, n_printed);
  text += fmt::format("study {}: {} of {} runs completed, {} failed", study.name, outcome.n_completed, outcome.n_runs,
                      outcome.n_failed);
  if (outcome.n_stopped > 0) text += fmt::format(", {} stopped", outcome.n_stopped);
  const auto n_done = runner.counts().n_done;
  if (n_done < outcome.n_runs) text += fmt::format(", {} not done", outcome.n_runs - n_done);
  if (runner.counts().n_before > 0) text += fmt::format(" ({} done before)", runner.counts().n_before);
  text += fmt::format(", in {:.1f} s{}\n", wall_s, stopped_by.empty() ? "" : ", ended by " + stopped_by);
  if (outcome.n_incomplete > 0)
    text += fmt::format("{} completed runs lack a measure; study.csv says why\n", outcome.n_incomplete);
  text += fmt::format("results in {}: study.csv, study.h5, study.json\n", out.string());
  return outcome;
}

} // namespace

StudyOutcome run_study(const StudyOptions& options)
{
  log::Level level{};
  MULLION_REQUIRE(log::parse_level(options.log_level, level), Errc::config,
                  "--log-level '{}': expected debug, info, warning, error or off", options.log_level);
  log::initialise(level, ::isatty(STDERR_FILENO) != 0);
  const auto begin = Clock::now();

  StudyOutcome wrong;
  const auto read = study::read_study(options.file);
  const StudyFile& study = read.value;
  wrong.diagnostics = read.diagnostics.sorted(options.file);
  if (!read.problem.empty()) wrong.diagnostics.push_back({options.file, read.problem});
  if (!wrong.diagnostics.empty()) return wrong;
  const auto plan = study::make_plan(study);
  wrong.diagnostics = plan.diagnostics;
  if (!wrong.diagnostics.empty()) return wrong;

  const fs::path out = options.out.empty() ? fs::path("out") / study.name : fs::path(options.out);
  study::check_folder(out, study); // before anything is made in it
  io::make_folder(out / "runs");
  const auto lock = study::lock_folder(out);
  study::check_folder(out, study); // another study may have been in it until now
  study::check_names(study);
  io::remove_stale_temporaries(out);
  io::write_atomically(out / "study.toml", study.text);

  Runner runner(study, plan, out);
  runner.take_over(options.has_retry);
  const auto n_parallel = options.n_parallel > 0 ? static_cast<unsigned>(options.n_parallel)
                                                 : std::max(1U, std::thread::hardware_concurrency());
  log::info("study", "{}: {} runs, {} done before, {} at a time, results in {}", study.name, plan.runs.size(),
            runner.counts().n_before, n_parallel, out.string());
  if (runner.counts().n_failed > 0)
    log::info("study", "{} of those done before failed or were stopped; --retry does them again",
              runner.counts().n_failed);
  if (runner.n_outdated() > 0)
    log::warning("study",
                 "{} of the finished runs must be done again: the case, mullion, a plug-in or their files changed",
                 runner.n_outdated());
  const auto stopped_by = runner.run(n_parallel);
  return finish_study(study, runner, out, stopped_by, seconds_since(begin));
}

} // namespace mullion
