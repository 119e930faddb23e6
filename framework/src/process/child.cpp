#include "process/child.hpp"

#include <mullion/sdk/error.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

namespace mullion::process {
namespace {

constexpr int cannot_start = 127; ///< as a shell says it

/// Between fork and exec: system calls only, another thread may have held any lock.
[[noreturn]] void become(char* const* arguments, const char* output, pid_t parent)
{
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(cannot_start); // it died before the line above
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGHUP, SIGTSTP, SIGCONT, SIGCHLD})
    ::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int in = ::open("/dev/null", O_RDONLY), out = ::open(output, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (in < 0 || out < 0) ::_exit(cannot_start);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(out, STDERR_FILENO);
  if (in > STDERR_FILENO) ::close(in);
  if (out > STDERR_FILENO) ::close(out);
  ::execv(arguments[0], arguments);
  ::_exit(cannot_start);
}

} // namespace

pid_t start_child(const std::vector<std::string>& command, const std::string& output)
{
  std::vector<char*> arguments;
  for (const auto& argument : command) arguments.push_back(const_cast<char*>(argument.c_str())); // exec's old type
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  MULLION_REQUIRE(pid >= 0, Errc::process, "cannot start {}: {}", command[0], std::strerror(errno));
  if (pid == 0) become(arguments.data(), output.c_str(), parent);
  ::setpgid(pid, pid); // whoever of the two is first
  return pid;
}

} // namespace mullion::process
