#include "process/supervisor.hpp"

#include "log/console.hpp"
#include "process/run_socket.hpp"
#include "process/self.hpp"
#include "shm/wait.hpp"

#include <mullion/sdk/error.hpp>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace mullion::process {
namespace {

constexpr std::size_t tail_lines = 50;
constexpr std::size_t longest_line = 8192;
/// One Ctrl-C can arrive twice (from the terminal and from a wrapper such as timeout): that is one request.
constexpr std::chrono::milliseconds same_request{100};

sigset_t handled_signals()
{
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGTSTP}) sigaddset(&set, signal);
  return set;
}

std::int64_t now_ns() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

/// A line of a host: a log line if it starts with \1 and a level.
void log_line(Host& host, const std::string& line)
{
  auto level = log::Level::info;
  std::string_view text = line;
  if (text.size() >= 2 && text[0] == '\1' && '0' <= text[1] && text[1] <= '4') {
    level = log::level_of(static_cast<std::uint32_t>(text[1] - '0'));
    text.remove_prefix(2);
  }
  log::write(level, host.name, text);
  host.remember(std::string(text));
}

/// Read what is there; true while the pipe is open.
bool drain_pipe(Host& host, shm::Descriptor& pipe, std::string& partial)
{
  char buffer[65536];
  while (pipe.is_open()) {
    const auto n = ::read(pipe.get(), buffer, sizeof buffer);
    if (n < 0) return errno == EAGAIN || errno == EINTR;
    if (n == 0) {
      pipe = {};
      break;
    }
    partial.append(buffer, static_cast<std::size_t>(n));
    std::size_t start = 0;
    for (auto end = partial.find('\n'); end != std::string::npos; end = partial.find('\n', start)) {
      log_line(host, partial.substr(start, end - start));
      start = end + 1;
    }
    partial.erase(0, start);
    for (; partial.size() > longest_line; partial.erase(0, longest_line))
      log_line(host, partial.substr(0, longest_line));
  }
  if (!partial.empty()) log_line(host, partial);
  partial.clear();
  return false;
}

} // namespace

std::vector<std::string> Host::tail() const
{
  const std::lock_guard lock(mutex_);
  return {tail_.begin(), tail_.end()};
}

void Host::remember(std::string line)
{
  const std::lock_guard lock(mutex_);
  tail_.push_back(std::move(line));
  if (tail_.size() > tail_lines) tail_.pop_front();
}

std::string describe_end(int status)
{
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const char* name = ::sigabbrev_np(signal);
    return fmt::format("was killed by signal {} (SIG{})", signal, name != nullptr ? name : "?");
  }
  return fmt::format("exited with code {}", WEXITSTATUS(status));
}

Supervisor::Supervisor(shm::Control& control, int control_fd)
    : control_(control), control_fd_(control_fd), host_path_(host_executable()),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))
{
  const auto set = handled_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = shm::Descriptor(::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK));
  MULLION_REQUIRE(wake_.is_open() && signals_.is_open(), Errc::process, "cannot start the supervisor: {}",
                  std::strerror(errno));
  thread_ = std::thread([this] { loop(); });
}

Supervisor::~Supervisor()
{
  do_in_thread([this] {
    for (auto& host : hosts_) ::kill(host->pid, SIGKILL);
    for (auto& host : hosts_) reap(*host);
    hosts_.clear();
    is_over_ = true;
  });
  thread_.join();
}

void Supervisor::do_in_thread(std::function<void()> task)
{
  std::packaged_task<void()> packaged(std::move(task));
  auto done = packaged.get_future();
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(packaged));
  }
  const std::uint64_t one = 1;
  (void)!::write(wake_.get(), &one, sizeof one);
  done.get();
}

void Supervisor::run_tasks()
{
  std::uint64_t count = 0;
  (void)!::read(wake_.get(), &count, sizeof count);
  for (;;) {
    std::packaged_task<void()> task;
    {
      const std::lock_guard lock(mutex_);
      if (tasks_.empty()) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task();
  }
}

void Supervisor::loop()
{
  while (!is_over_) {
    std::vector<pollfd> polled{{wake_.get(), POLLIN, 0}, {signals_.get(), POLLIN, 0}};
    const std::size_t first_host = polled.size();
    for (const auto& host : hosts_) {
      polled.push_back({host->pidfd.get(), POLLIN, 0});
      polled.push_back({host->out.get(), POLLIN, 0});
      polled.push_back({host->err.get(), POLLIN, 0});
    }
    if (socket_ != nullptr) socket_->watch(polled);
    const int patience = socket_ != nullptr ? socket_->patience() : -1;
    if (::poll(polled.data(), polled.size(), patience) < 0) continue; // EINTR
    const auto polled_hosts = hosts_;                                 // tasks below may change the list
    for (std::size_t h = 0; h < polled_hosts.size(); ++h) {
      auto& host = *polled_hosts[h];
      const auto* events = &polled[first_host + 3 * h];
      if (events[1].revents != 0 || events[2].revents != 0) drain(host);
      if (events[0].revents != 0) reap(host);
    }
    std::erase_if(hosts_, [](const auto& host) { return host->is_dead.load(); });
    if (polled[1].revents != 0) on_signal();
    if (socket_ != nullptr) socket_->serve(answer_);
    if (polled[0].revents != 0) run_tasks();
  }
}

// ---- hosts ---------------------------------------------------------------------------------------------------

std::shared_ptr<Host> Supervisor::spawn(std::uint32_t module)
{
  auto& record = control_.modules[module];
  auto host = std::make_shared<Host>();
  host->module = module;
  host->name = record.name;
  host->incarnation = ++record.incarnation;
  host->reply_object = shm::create_object(host->name + ".reply", sizeof(shm::Reply));
  {
    const auto writable = shm::map_object(::getpid(), host->reply_object.get(), shm::Access::read_write);
    auto& reply = *reinterpret_cast<shm::Reply*>(writable.data);
    reply.magic = shm::reply_magic;
    reply.incarnation = host->incarnation;
    reply.word.store(record.request.word.load()); // whatever was asked of an earlier host is not for this one
  }
  host->reply_mapping = shm::map_object(::getpid(), host->reply_object.get(), shm::Access::read_only);
  record.reply_fd = host->reply_object.get();
  do_in_thread([&] {
    start_process(*host);
    hosts_.push_back(host);
  });
  record.pid = host->pid;
  return host;
}

void Supervisor::start_process(Host& host)
{
  int out[2], err[2];
  MULLION_REQUIRE(::pipe2(out, O_CLOEXEC) == 0 && ::pipe2(err, O_CLOEXEC) == 0, Errc::process,
                  "cannot make the pipes of module '{}': {}", host.name, std::strerror(errno));
  host.out = shm::Descriptor(out[0]);
  host.err = shm::Descriptor(err[0]);
  shm::Descriptor child_out(out[1]), child_err(err[1]);
  for (const int fd : {out[0], err[0]}) ::fcntl(fd, F_SETFL, O_NONBLOCK);

  const auto parent = ::getpid();
  const std::string texts[] = {std::to_string(parent), std::to_string(control_fd_),
                               std::to_string(host.reply_object.get()), std::to_string(host.module),
                               std::to_string(host.incarnation)};
  const char* arguments[] = {host_path_.c_str(), texts[0].c_str(), texts[1].c_str(), texts[2].c_str(),
                             texts[3].c_str(),   texts[4].c_str(), nullptr};
  const pid_t pid = ::fork();
  MULLION_REQUIRE(pid >= 0, Errc::process, "cannot start a process for module '{}': {}", host.name,
                  std::strerror(errno));
  if (pid == 0) { // only async-signal-safe calls from here to exec
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    const int null = ::open("/dev/null", O_RDONLY);
    ::dup2(null, STDIN_FILENO);
    ::dup2(child_out.get(), STDOUT_FILENO);
    ::dup2(child_err.get(), STDERR_FILENO);
    ::execv(arguments[0], const_cast<char* const*>(arguments));
    const char text[] = "cannot execute the host program of this installation (lib/mullion/mullion-host)\n";
    (void)!::write(STDERR_FILENO, text, sizeof text - 1);
    ::_exit(127);
  }
  host.pid = pid;
  host.pidfd = shm::Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
  if (!host.pidfd.is_open()) {
    const int reason = errno;
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    throw Error(Errc::process,
                fmt::format("cannot watch the process of module '{}': {}", host.name, std::strerror(reason)));
  }
}

void Supervisor::drain(Host& host)
{
  drain_pipe(host, host.out, host.partial_out);
  drain_pipe(host, host.err, host.partial_err);
}

void Supervisor::reap(Host& host)
{
  if (host.is_dead) return;
  while (::waitpid(host.pid, &host.wait_status, 0) < 0 && errno == EINTR) {
  }
  drain(host);
  host.is_dead.store(true, std::memory_order_release);
  shm::futex_wake(host.reply().word);
}

void Supervisor::kill(Host& host)
{
  do_in_thread([&] {
    if (host.is_dead) return;
    ::kill(host.pid, SIGKILL);
    reap(host);
    std::erase_if(hosts_, [&](const auto& other) { return other.get() == &host; });
  });
}

void Supervisor::join(Host& host, std::chrono::milliseconds patience)
{
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!host.is_dead && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  kill(host);
}

// ---- signals -------------------------------------------------------------------------------------------------

std::string Supervisor::stop_reason() const
{
  const std::lock_guard lock(reason_mutex_);
  return reason_;
}

void Supervisor::request_stop(const std::string& reason)
{
  {
    const std::lock_guard lock(reason_mutex_);
    if (reason_.empty()) reason_ = reason;
  }
  is_stopping_ = true;
}

void Supervisor::on_signal()
{
  signalfd_siginfo info{};
  while (::read(signals_.get(), &info, sizeof info) == sizeof info) {
    const int signal = static_cast<int>(info.ssi_signo);
    if (signal == SIGTSTP) {
      pause_all();
      continue;
    }
    const auto name = fmt::format("SIG{}", ::sigabbrev_np(signal));
    const auto now = std::chrono::steady_clock::now();
    if (!is_stopping_ || first_stop_signal_ == std::chrono::steady_clock::time_point{}) {
      first_stop_signal_ = now;
      request_stop(name);
      log::warning("run", "{}: the run ends after the step at hand; once more ends it at once", name);
    } else if (now - first_stop_signal_ > same_request) {
      log::show_progress("");
      control_.state = shm::RunState::interrupted; // the guard says so, and where
      ::_exit(1);                                  // the hosts go with us
    }
  }
}

std::chrono::nanoseconds Supervisor::paused() const
{
  // While stopped, and until the lines behind the stop have run, the pause at hand counts as well.
  const auto begin = pause_begin_ns_.load();
  return std::chrono::nanoseconds(paused_ns_.load() + (begin == 0 ? 0 : now_ns() - begin));
}

void Supervisor::pause_all()
{
  const auto begin = now_ns();
  pause_begin_ns_ = begin;
  for (auto& host : hosts_) ::kill(host->pid, SIGSTOP);
  // To this thread, so that the lines behind it run after SIGCONT only; the whole process stops all the same.
  ::pthread_kill(::pthread_self(), SIGSTOP);
  paused_ns_ += now_ns() - begin;
  pause_begin_ns_ = 0;
  for (auto& host : hosts_) ::kill(host->pid, SIGCONT);
}

// ---- socket --------------------------------------------------------------------------------------------------

void Supervisor::serve(RunSocket& socket, Answer answer)
{
  do_in_thread([&] {
    socket_ = &socket;
    answer_ = std::move(answer);
  });
}

void Supervisor::unserve()
{
  do_in_thread([&] {
    if (socket_ != nullptr) socket_->serve(answer_); // the last replies, as far as they go at once
    socket_ = nullptr;
  });
}

} // namespace mullion::process
