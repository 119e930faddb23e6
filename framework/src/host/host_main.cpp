// The host: a lean process that carries one module. It maps the control object read-only, its own windows and its
// reply object read-write, everything else read-only, and answers one request after another. While it is parked,
// because another carrier of its module is on trial, its own windows are read-only too.
//
// When the orchestrator dies the kernel kills us (PDEATHSIG); when we die the orchestrator learns it from a pidfd.
// Our standard output and error are pipes that the orchestrator drains; a line that starts with \1 and a digit is
// a log line of that level.
#include "module/module_runtime.hpp"
#include "shm/control.hpp"
#include "shm/wait.hpp"
#include "shm/window_map.hpp"

#include <mullion/sdk/error.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <execinfo.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace {

using namespace mullion;

const shm::WindowMap* fault_windows = nullptr; // for the fault handler only

void write_log(std::uint32_t level, const std::string& text)
{
  std::string out;
  std::size_t start = 0;
  while (start <= text.size()) {
    const auto end = std::min(text.find('\n', start), text.size());
    out += fmt::format("\1{}{}\n", level, text.substr(start, end - start));
    start = end + 1;
  }
  std::fflush(stdout);
  for (std::size_t sent = 0; sent < out.size();) {
    const auto n = ::write(STDERR_FILENO, out.data() + sent, out.size() - sent);
    if (n <= 0) return;
    sent += static_cast<std::size_t>(n);
  }
}

/// Say where we fault, then die of the same signal.
void on_fault(int signal, siginfo_t* info, void*)
{
  const char* window = fault_windows != nullptr ? fault_windows->window_at(info->si_addr) : nullptr;
  if (signal == SIGSEGV && window != nullptr) {
    const char prefix[] = "\0014a write into the read-only window ";
    (void)!::write(STDERR_FILENO, prefix, sizeof prefix - 1);
    (void)!::write(STDERR_FILENO, window, std::strlen(window));
    (void)!::write(STDERR_FILENO, ", which another party owns\n", 27);
  }
  void* frames[32];
  ::backtrace_symbols_fd(frames, ::backtrace(frames, 32), STDERR_FILENO);
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

void install_fault_handler()
{
  void* frame[1];
  ::backtrace(frame, 1); // loads libgcc now: the handler may not
  static char stack[64 * 1024];
  const stack_t alternative{stack, 0, sizeof stack};
  ::sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_sigaction = on_fault;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_RESETHAND;
  for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

class Host {
public:
  Host(const shm::Control& control, shm::Reply& reply, std::uint32_t module, std::uint32_t incarnation)
      : control_(control), record_(control.modules[module]), reply_(reply), incarnation_(incarnation), module_(module),
        windows_(control, false), runtime_(windows_, module, write_log)
  {
    windows_.allow(module_);
    fault_windows = &windows_;
  }

  void serve()
  {
    for (auto seen = reply_.word.load();;) {
      const auto& request = record_.request;
      const auto is_new = [&] {
        return request.word.load(std::memory_order_acquire) != seen && request.incarnation == incarnation_;
      };
      shm::wait_for(request.word, reply_.asleep, true, is_new, [] { return false; });
      seen = request.word.load(std::memory_order_acquire);
      if (request.operation == shm::Operation::quit) return;
      if (request.operation == shm::Operation::attach_beside) {
        attach_beside(seen);
        continue;
      }
      answer(request.operation, request);
      std::fflush(stdout);
      shm::publish(reply_.word, seen, control_.orchestrator_asleep);
    }
  }

private:
  /// The first answer frees the request slot, in which the carrier at work is called from then on: nothing is read from
  /// it any more.
  void attach_beside(std::uint32_t number)
  {
    windows_.forbid(module_);
    shm::publish(reply_.word, number, control_.orchestrator_asleep);
    answer(shm::Operation::attach, record_.request);
    reply_.results[0] = runtime_.has_attached_to_levels() ? 1.0 : 0.0;
    std::fflush(stdout);
    shm::publish(reply_.word, number ^ shm::attached_beside, control_.orchestrator_asleep);
  }

  void answer(shm::Operation operation, const shm::Request& request)
  {
    const auto begin = std::chrono::steady_clock::now();
    reply_.status = MULLION_OK;
    try {
      dispatch(operation, request);
    } catch (const Error& error) {
      fail(static_cast<std::int32_t>(error.code()), error.what());
    } catch (const std::exception& error) {
      fail(static_cast<std::int32_t>(Errc::internal), error.what());
    }
    reply_.work_ns = static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - begin).count());
  }

  void dispatch(shm::Operation operation, const shm::Request& request)
  {
    using shm::Operation;
    switch (operation) {
    case Operation::create: return runtime_.create();
    case Operation::define:
      defined_ = runtime_.define(request.step);
      reply_.n_windows = 0;
      for (const auto& window : defined_) {
        auto& out = reply_.windows[reply_.n_windows++];
        shm::copy_text(out.name, sizeof out.name, window.name, "window name");
        out.fd = window.object.get();
        out.bytes = window.mapping.bytes;
        out.n_slots = window.view.header().n_slots;
      }
      return;
    case Operation::attach:
      defined_.clear(); // the orchestrator has adopted them by now
      return runtime_.attach();
    case Operation::start: return runtime_.start(request.step);
    case Operation::seal: return runtime_.seal();
    case Operation::step:
    case Operation::call: return runtime_.run(request, reply_.results);
    case Operation::park: return windows_.forbid(module_);
    case Operation::resume: return windows_.allow(module_);
    case Operation::none:
    case Operation::attach_beside:
    case Operation::quit: break;
    }
    throw Error(Errc::internal, fmt::format("unknown request {}", static_cast<int>(operation)));
  }

  void fail(std::int32_t status, const std::string& text)
  {
    reply_.status = status;
    const auto n = std::min(text.size(), sizeof reply_.error - 1);
    std::memcpy(reply_.error, text.data(), n);
    reply_.error[n] = '\0';
  }

  const shm::Control& control_;
  const shm::ModuleRecord& record_;
  shm::Reply& reply_;
  std::uint32_t incarnation_, module_;
  shm::WindowMap windows_;
  module::ModuleRuntime runtime_;
  std::vector<module::ModuleRuntime::Defined> defined_;
};

} // namespace

int main(int argc, char** argv)
{
  if (argc != 6) {
    std::fprintf(stderr, "mullion-host is started by 'mullion run', not by hand\n");
    return 2;
  }
  const auto orchestrator = static_cast<pid_t>(std::atol(argv[1]));
  const auto control_fd = std::atoi(argv[2]), reply_fd = std::atoi(argv[3]);
  const auto module = static_cast<std::uint32_t>(std::atol(argv[4]));
  const auto incarnation = static_cast<std::uint32_t>(std::atol(argv[5]));

  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != orchestrator) return 1; // it died before the line above
  for (const int signal : {SIGINT, SIGHUP, SIGTSTP, SIGPIPE}) ::signal(signal, SIG_IGN);
  install_fault_handler();
  std::setvbuf(stdout, nullptr, _IOLBF, 1 << 16);

  try {
    const auto control = shm::map_object(orchestrator, control_fd, shm::Access::read_only);
    const auto reply = shm::map_object(orchestrator, reply_fd, shm::Access::read_write);
    Host host(shm::checked_control(control.data, control.bytes), *reinterpret_cast<shm::Reply*>(reply.data), module,
              incarnation);
    host.serve();
  } catch (const std::exception& error) {
    write_log(MULLION_ERROR, error.what());
    return 1;
  }
  return 0;
}
