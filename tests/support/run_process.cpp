#include "support/run_process.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace mullion::test {
namespace {

void require(int error, const char* what)
{
  if (error != 0) throw std::runtime_error(std::string(what) + ": " + std::strerror(error));
}

int memory_file(const char* name)
{
  const int fd = memfd_create(name, MFD_CLOEXEC);
  require(fd < 0 ? errno : 0, "memfd_create");
  return fd;
}

std::string contents(int fd)
{
  std::string text;
  char buffer[1 << 14];
  for (ssize_t n = 0; (n = pread(fd, buffer, sizeof buffer, static_cast<off_t>(text.size()))) > 0;)
    text.append(buffer, static_cast<std::size_t>(n));
  return text;
}

/// This process's environment with the overrides.
std::vector<std::string> environment(const ProcessOptions& options)
{
  std::vector<std::string> all;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const auto is_overridden = [&](const auto& pair) { return text.rfind(pair.first + "=", 0) == 0; };
    if (std::none_of(options.environment.begin(), options.environment.end(), is_overridden)) all.push_back(text);
  }
  for (const auto& [name, value] : options.environment) all.push_back(name + "=" + value);
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& texts)
{
  std::vector<char*> out;
  for (auto& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

} // namespace

Process::Process(const std::vector<std::string>& command, ProcessOptions options) : options_(std::move(options))
{
  out_ = memory_file("stdout");
  err_ = memory_file("stderr");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out_, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err_, STDERR_FILENO);
  if (!options_.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, options_.folder.c_str());

  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);

  auto arguments = command;
  auto variables = environment(options_);
  const int error = posix_spawnp(&pid_, command.at(0).c_str(), &actions, &attributes, pointers(arguments).data(),
                                 pointers(variables).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    close(out_);
    close(err_);
    require(error, command[0].c_str());
  }
  pidfd_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
}

Process::~Process()
{
  if (!is_reaped_) {
    kill_group();
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  for (const int fd : {pidfd_, out_, err_})
    if (fd >= 0) close(fd);
}

void Process::kill_group() { kill(-pid_, SIGKILL); }

void Process::send(int signal) const
{
  if (!is_reaped_) kill(pid_, signal);
}

bool Process::is_running() const
{
  pollfd end{pidfd_, POLLIN, 0};
  return !is_reaped_ && poll(&end, 1, 0) == 0;
}

std::string Process::out() const { return contents(out_); }
std::string Process::err() const { return contents(err_); }

ProcessResult Process::wait()
{
  if (is_reaped_) return result_;
  const auto deadline = std::chrono::steady_clock::now() + options_.timeout;
  pollfd end{pidfd_, POLLIN, 0};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    const int n = poll(&end, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (n > 0) break;
    if (n < 0 && errno == EINTR) continue;
    result_.has_timed_out = true;
    break;
  }
  kill_group(); // after a timeout the process; in any case what it left behind
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  is_reaped_ = true;
  if (WIFEXITED(status)) result_.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result_.signal = WTERMSIG(status);
  result_.out = out();
  result_.err = err();
  return result_;
}

ProcessResult run_process(const std::vector<std::string>& command, const ProcessOptions& options)
{
  return Process(command, options).wait();
}

} // namespace mullion::test
