#include "process/guard.hpp"

#include "io/run_record.hpp"
#include "process/run_socket.hpp"
#include "process/supervisor.hpp"
#include "shm/memory_object.hpp"

#include <mullion/sdk/error.hpp>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace mullion::process {
namespace {

sigset_t guard_signals()
{
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT, SIGCHLD}) sigaddset(&set, signal);
  return set;
}

/// Stop with the orchestrator on Ctrl-Z, so that the shell gets its prompt back; go on when it says so.
void stop_with(pid_t orchestrator)
{
  siginfo_t info{};
  ::waitid(P_PID, static_cast<id_t>(orchestrator), &info,
           WSTOPPED | WEXITED | WNOWAIT); // it stops its hosts, then itself
  sigset_t pending;                       // a SIGCONT that came meanwhile would not wake us from a stop after it
  ::sigpending(&pending);
  if (::sigismember(&pending, SIGCONT) == 0) ::kill(::getpid(), SIGSTOP);
  ::kill(orchestrator, SIGCONT);
}

/// Wait for the orchestrator, passing on signals. @return its wait status
int wait_for_orchestrator(pid_t orchestrator)
{
  const auto set = guard_signals();
  for (;;) {
    int status = 0;
    if (::waitpid(orchestrator, &status, WNOHANG) == orchestrator) return status;
    siginfo_t info{};
    const int signal = ::sigwaitinfo(&set, &info);
    if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP) ::kill(orchestrator, signal);
    if (signal == SIGTSTP) {
      ::kill(orchestrator, SIGTSTP);
      stop_with(orchestrator);
    }
  }
}

/// Hosts have become our children (we are a subreaper) and die with the orchestrator; make sure of it.
void end_hosts(const shm::Control& control)
{
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  for (;;) {
    const pid_t ended = ::waitpid(-1, nullptr, WNOHANG);
    if (ended < 0) return; // no child is left
    if (ended > 0) continue;
    if (std::chrono::steady_clock::now() > give_up) return;
    for (std::uint32_t m = 0; m < control.n_modules && m < shm::max_modules; ++m)
      if (const auto pid = control.modules[m].pid; pid > 0 && ::waitpid(pid, nullptr, WNOHANG) == 0)
        ::kill(pid, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// "inside module 'fluid' (its plug-in, inline), in step, step 17, t = 0.1 s", or where else the orchestrator was.
std::string last_call(const shm::Control& control)
{
  const auto& call = control.current;
  if (call.module >= control.n_modules || call.module >= shm::max_modules)
    return fmt::format("between calls, after step {} (t = {} s)", control.step.load(), control.time.load());
  const auto& module = control.modules[call.module];
  if (module.is_inline == 0)
    return fmt::format("while module '{}' ({}, process {}) was in {}, step {}, t = {} s", module.name, module.plugin,
                       module.pid, to_string(call.operation), call.step, call.time);
  return fmt::format(
      "inside module '{}' ({}, inline), in {}, step {}, t = {} s; run it with process = true to keep the "
      "others safe from it",
      module.name, module.plugin, to_string(call.operation), call.step, call.time);
}

} // namespace

int run_guarded(const Orchestrator& orchestrator)
{
  const auto object = shm::create_object("control", sizeof(shm::Control));
  auto writable = shm::map_object(::getpid(), object.get(), shm::Access::read_write);
  auto& control = *new (writable.data) shm::Control{};
  control.magic = shm::control_magic;
  control.version = shm::layout_version;
  control.bytes = sizeof(shm::Control);
  control.guard_pid = ::getpid();
  control.current.module = shm::no_module;

  const auto set = guard_signals();
  sigset_t before;
  ::sigprocmask(SIG_BLOCK, &set, &before);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t pid = ::fork();
  MULLION_REQUIRE(pid >= 0, Errc::process, "cannot start the orchestrator: {}", std::strerror(errno));
  if (pid == 0) {
    // A process group of its own: the terminal's signals come through the guard, once.
    ::setpgid(0, 0);
    ::prctl(PR_SET_CHILD_SUBREAPER, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != control.guard_pid) ::_exit(1);
    // SIGINT and its kin stay blocked until the supervisor takes them over.
    sigset_t not_ours;
    sigemptyset(&not_ours);
    for (const int signal : {SIGCONT, SIGCHLD}) sigaddset(&not_ours, signal);
    ::sigprocmask(SIG_UNBLOCK, &not_ours, nullptr);
    for (const int signal : {SIGPIPE, SIGXFSZ}) ::signal(signal, SIG_IGN); // they become errors with a message
    control.orchestrator_pid = ::getpid();
    const int code = orchestrator(control, object.get());
    control.state = shm::RunState::done;
    std::fflush(stdout);
    std::fflush(stderr);
    ::_exit(code);
  }
  ::setpgid(pid, pid); // whoever of the two is first
  writable = {};       // from here on we only read
  const auto readable = shm::map_object(::getpid(), object.get(), shm::Access::read_only);
  const auto& seen = *reinterpret_cast<const shm::Control*>(readable.data);

  const int status = wait_for_orchestrator(pid);
  end_hosts(seen);
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  const auto state = seen.state.load();
  if (WIFEXITED(status) && state == shm::RunState::done) return WEXITSTATUS(status);

  const bool is_interrupted = state == shm::RunState::interrupted;
  const auto message =
      is_interrupted
          ? fmt::format("run '{}': ended at once by a second signal, {}; the last rows of history.csv may be missing",
                        seen.run_name, last_call(seen))
          : fmt::format("run '{}': the orchestrator (process {}) {}, {}", seen.run_name, pid, describe_end(status),
                        last_call(seen)); // an exit() comes from a module as well
  std::fprintf(stderr, "%smullion: error: %s\n", ::isatty(STDERR_FILENO) ? "\r\x1b[K" : "", message.c_str());
  try {
    if (seen.run_name[0] != '\0') clean_up(seen.run_name);
    if (seen.outcome_file[0] != '\0')
      io::complete_after_crash(seen.outcome_file, is_interrupted ? "interrupted" : "died", message);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mullion: error: %s\n", error.what());
  }
  return 1;
}

} // namespace mullion::process
