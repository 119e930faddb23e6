#include "io/checkpoint_trial.hpp"

#include "io/checkpoint.hpp"
#include "shm/memory_object.hpp"

#include <mullion/sdk/error.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <poll.h>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace mullion::io {
namespace {

using Clock = std::chrono::steady_clock;

/// The child: an empty answer is a good one; what is wrong with the file otherwise.
[[noreturn]] void read_and_tell(const std::filesystem::path& file, int answer)
{
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGABRT}) ::signal(signal, SIG_DFL);
  if (const int null = ::open("/dev/null", O_WRONLY); null >= 0) ::dup2(null, STDERR_FILENO); // the library's own words
  std::string problem;
  try {
    (void)read_checkpoint(file);
  } catch (const std::exception& error) {
    problem = error.what();
  }
  for (std::size_t sent = 0; sent < problem.size();) {
    const auto n = ::write(answer, problem.data() + sent, problem.size() - sent);
    if (n <= 0) ::_exit(1);
    sent += static_cast<std::size_t>(n);
  }
  ::_exit(0); // without the exit handlers of the process that this is a copy of
}

std::chrono::milliseconds patience_for(const std::filesystem::path& file)
{
  std::error_code ignored;
  const auto bytes = std::filesystem::file_size(file, ignored);
  return std::chrono::seconds(30) + std::chrono::milliseconds(ignored ? 0 : bytes / 20'000);
}

/// Read until the writer's end closes. @return false: it did not in time
bool read_all(int pipe, Clock::time_point end, std::string& text)
{
  char buffer[4096];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    pollfd polled{pipe, POLLIN, 0};
    if (::poll(&polled, 1, static_cast<int>(left)) <= 0) continue; // EINTR, or time to look at the clock
    const auto n = ::read(pipe, buffer, sizeof buffer);
    if (n == 0) return true;
    if (n > 0) text.append(buffer, static_cast<std::size_t>(n));
  }
}

} // namespace

void try_checkpoint(const std::filesystem::path& file, std::optional<std::chrono::milliseconds> patience)
{
  int ends[2];
  MULLION_REQUIRE(::pipe2(ends, O_CLOEXEC) == 0, Errc::process, "cannot make a pipe to try {}: {}", file.string(),
                  std::strerror(errno));
  const shm::Descriptor from_child(ends[0]);
  shm::Descriptor to_parent(ends[1]);
  const auto limit = patience.value_or(patience_for(file));
  const pid_t child = ::fork();
  MULLION_REQUIRE(child >= 0, Errc::process, "cannot start a process to try {}: {}", file.string(),
                  std::strerror(errno));
  if (child == 0) read_and_tell(file, to_parent.get());
  to_parent = {};

  std::string problem;
  const bool has_ended = read_all(from_child.get(), Clock::now() + limit, problem);
  if (!has_ended) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  MULLION_REQUIRE(has_ended, Errc::io,
                  "{} is no checkpoint that can be read: its checksum is right, and reading it did not come to an end "
                  "within {} s",
                  file.string(), std::chrono::duration<double>(limit).count());
  MULLION_REQUIRE(!WIFSIGNALED(status), Errc::io,
                  "{} is no checkpoint that can be read: its checksum is right, and the process that tried to read it "
                  "was killed by signal {} (SIG{})",
                  file.string(), WTERMSIG(status), ::sigabbrev_np(WTERMSIG(status)));
  MULLION_REQUIRE(problem.empty(), Errc::io, "{}", problem);
  MULLION_REQUIRE(WIFEXITED(status) && WEXITSTATUS(status) == 0, Errc::io,
                  "{} is no checkpoint that can be read: the process that tried it exited with code {}", file.string(),
                  WEXITSTATUS(status));
}

} // namespace mullion::io
