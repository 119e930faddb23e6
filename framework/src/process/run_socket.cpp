#include "process/run_socket.hpp"

#include "config/suggestions.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <mutex>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>
#include <utility>

namespace mullion::process {
namespace {

namespace fs = std::filesystem;

/// A client gets this long to send its line, and again to take its answer. Nobody waits for it meanwhile.
constexpr std::chrono::seconds patience_with_clients{2};
constexpr std::size_t max_clients = 64; ///< who comes then waits in the kernel's queue until one is done
constexpr std::size_t longest_line = 65536;
constexpr std::size_t longest_answer = 16u << 20;

sockaddr_un address_of(const std::string& path)
{
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  MULLION_REQUIRE(path.size() < sizeof address.sun_path, Errc::config,
                  "the socket path '{}' is longer than {} characters; set MULLION_RUNTIME_DIR to a shorter folder",
                  path, sizeof address.sun_path - 1);
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

std::string lock_path_of(const std::string& run) { return runtime_folder() + "/" + run + ".lock"; }
std::string socket_path_of(const std::string& run) { return runtime_folder() + "/" + run + ".sock"; }

/// Blocking, for the client's side: everything up to a line's end, the end of the stream, or a timeout.
std::string read_line(int fd)
{
  std::string line;
  char buffer[4096];
  while (line.size() < longest_answer) {
    const auto n = ::read(fd, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    line.append(buffer, static_cast<std::size_t>(n));
    if (const auto end = line.find('\n'); end != std::string::npos) return line.substr(0, end);
  }
  return line;
}

void send_all(int fd, const std::string& text)
{
  for (std::size_t sent = 0; sent < text.size();) {
    const auto n = ::send(fd, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    sent += static_cast<std::size_t>(n);
  }
}

/// The lock file, opened and locked, or a closed descriptor if a live run holds it.
shm::Descriptor try_lock(const std::string& path, int flags)
{
  for (;;) {
    shm::Descriptor lock(::open(path.c_str(), O_RDWR | O_CLOEXEC | flags, 0600));
    if (!lock.is_open() || ::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) return {};
    // A dying run may have unlinked the file between our open and our lock: then this lock protects nothing.
    struct stat held {
    }, named{};
    ::fstat(lock.get(), &held);
    if (::stat(path.c_str(), &named) == 0 && named.st_ino == held.st_ino) return lock;
    if ((flags & O_CREAT) == 0) return {};
  }
}

std::string pid_in(const std::string& lock_path)
{
  shm::Descriptor file(::open(lock_path.c_str(), O_RDONLY | O_CLOEXEC));
  return file.is_open() ? read_line(file.get()) : "unknown";
}

} // namespace

std::string runtime_folder()
{
  std::string folder;
  if (const char* own = std::getenv("MULLION_RUNTIME_DIR")) folder = own;
  else if (const char* xdg = std::getenv("XDG_RUNTIME_DIR"); xdg != nullptr && fs::is_directory(xdg))
    folder = std::string(xdg) + "/mullion";
  else folder = fmt::format("/tmp/mullion-{}", ::getuid());
  ::mkdir(folder.c_str(), 0700);
  struct stat info {};
  MULLION_REQUIRE(::lstat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode), Errc::io,
                  "cannot make the runtime folder '{}': {}; set MULLION_RUNTIME_DIR to a folder of your own", folder,
                  std::strerror(errno));
  MULLION_REQUIRE(info.st_uid == ::getuid() && (info.st_mode & 022) == 0, Errc::io,
                  "the runtime folder '{}' belongs to user {} or others may write to it; set MULLION_RUNTIME_DIR to a "
                  "folder of your own with mode 700",
                  folder, info.st_uid);
  return folder;
}

/// Replies on their way from other threads to the one that serves.
struct RunSocket::Outbox {
  std::mutex mutex;
  std::vector<std::pair<std::uint64_t, std::string>> replies; ///< client's number, text
  shm::Descriptor wake{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};

  void put(std::uint64_t client, const std::string& text)
  {
    const std::lock_guard lock(mutex);
    replies.emplace_back(client, text);
    const std::uint64_t one = 1;
    (void)!::write(wake.get(), &one, sizeof one);
  }
  std::vector<std::pair<std::uint64_t, std::string>> take()
  {
    const std::lock_guard lock(mutex);
    std::uint64_t count = 0;
    (void)!::read(wake.get(), &count, sizeof count);
    return std::exchange(replies, {});
  }
};

RunSocket::RunSocket(const std::string& run_name, pid_t pid)
    : path_(socket_path_of(run_name)), lock_path_(lock_path_of(run_name)), lock_(try_lock(lock_path_, O_CREAT)),
      outbox_(std::make_shared<Outbox>())
{
  // `mullion ps` holds the lock for an instant when it looks whether a run is alive: ask more than once.
  for (int attempt = 0; attempt < 5 && !lock_.is_open(); ++attempt) {
    ::usleep(10'000);
    lock_ = try_lock(lock_path_, O_CREAT);
  }
  MULLION_REQUIRE(
      lock_.is_open(), Errc::config,
      "a run named '{}' is alive (process {}); wait for it, end it with 'mullion stop {}', or give this one "
      "another name with --set run.name=…",
      run_name, pid_in(lock_path_), run_name);
  const auto text = fmt::format("{}\n", pid);
  (void)!::ftruncate(lock_.get(), 0);
  (void)!::write(lock_.get(), text.data(), text.size());
  ::unlink(path_.c_str()); // of a dead run: we hold its lock
  socket_ = shm::Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const auto address = address_of(path_);
  MULLION_REQUIRE(socket_.is_open() &&
                      ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                      ::listen(socket_.get(), 16) == 0,
                  Errc::io, "cannot listen on '{}': {}", path_, std::strerror(errno));
}

RunSocket::~RunSocket()
{
  ::unlink(path_.c_str());
  ::unlink(lock_path_.c_str());
}

void RunSocket::watch(std::vector<pollfd>& polled) const
{
  if (clients_.size() < max_clients) polled.push_back({socket_.get(), POLLIN, 0});
  polled.push_back({outbox_->wake.get(), POLLIN, 0});
  for (const auto& client : clients_) {
    // One that waits for its answer has nothing more to say; that it has gone is seen when the answer is there.
    if (client.state == Client::State::waiting) continue;
    polled.push_back(
        {client.socket.get(), static_cast<short>(client.state == Client::State::sending ? POLLOUT : POLLIN), 0});
  }
}

int RunSocket::patience() const
{
  auto left = std::chrono::milliseconds::max();
  for (const auto& client : clients_)
    if (client.state != Client::State::waiting)
      left = std::min(left, std::chrono::ceil<std::chrono::milliseconds>(client.deadline - Clock::now()));
  if (left == std::chrono::milliseconds::max()) return -1;
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

void RunSocket::serve(const Answer& answer)
{
  accept_clients();
  for (auto& client : clients_)
    if (client.state == Client::State::reading) read_line_of(client, answer);
  for (const auto& [number, text] : outbox_->take())
    for (auto& client : clients_)
      if (client.number == number && client.state == Client::State::waiting) start_sending(client, text);
  for (auto& client : clients_)
    if (client.state == Client::State::sending) send_to(client);
  const auto now = Clock::now();
  std::erase_if(clients_, [&](const Client& client) {
    return !client.socket.is_open() || (client.state != Client::State::waiting && client.deadline <= now);
  });
}

void RunSocket::accept_clients()
{
  while (clients_.size() < max_clients) {
    shm::Descriptor socket(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket.is_open()) return;
    ucred who{};
    socklen_t size = sizeof who;
    const bool is_ours = ::getsockopt(socket.get(), SOL_SOCKET, SO_PEERCRED, &who, &size) == 0 && who.uid == ::getuid();
    auto& client = clients_.emplace_back();
    client.number = ++n_clients_;
    client.socket = std::move(socket);
    client.deadline = Clock::now() + patience_with_clients;
    if (!is_ours) start_sending(client, R"({"code":1,"error":"this run belongs to another user"})");
  }
}

void RunSocket::read_line_of(Client& client, const Answer& answer)
{
  char buffer[4096];
  for (;;) {
    const auto n = ::read(client.socket.get(), buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return;
    if (n > 0) client.in.append(buffer, static_cast<std::size_t>(n));
    const auto end = client.in.find('\n');
    if (end == std::string::npos) {
      if (n > 0 && client.in.size() < longest_line) continue;
      client.socket = {}; // it went away, or has no end
      return;
    }
    client.in.resize(end);
    client.state = Client::State::waiting;
    answer(client.in,
           [outbox = outbox_, number = client.number](const std::string& text) { outbox->put(number, text); });
    return;
  }
}

void RunSocket::start_sending(Client& client, const std::string& text)
{
  client.out = text + "\n";
  client.state = Client::State::sending;
  client.deadline = Clock::now() + patience_with_clients;
}

void RunSocket::send_to(Client& client)
{
  while (!client.out.empty()) {
    const auto n = ::send(client.socket.get(), client.out.data(), client.out.size(), MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return; // later, or never
    if (n <= 0) break;
    client.out.erase(0, static_cast<std::size_t>(n));
  }
  client.socket = {};
}

std::vector<std::string> live_runs()
{
  std::vector<std::string> runs;
  for (const auto& entry : fs::directory_iterator(runtime_folder())) {
    if (entry.path().extension() != ".lock") continue;
    const auto name = entry.path().stem().string();
    if (try_lock(entry.path(), 0).is_open()) clean_up(name);
    else runs.push_back(name);
  }
  std::sort(runs.begin(), runs.end());
  return runs;
}

std::string ask_run(const std::string& run_name, const std::string& line, std::chrono::seconds patience)
{
  shm::Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto address = address_of(socket_path_of(run_name));
  const timeval timeout{patience.count(), 0};
  ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
  ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof timeout);
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw Error(Errc::config,
                fmt::format("no run named '{}' is alive{}", run_name, config::suggestion(run_name, live_runs())));
  send_all(socket.get(), line + "\n");
  errno = 0;
  const auto answer = read_line(socket.get());
  MULLION_REQUIRE(!answer.empty() || errno != EAGAIN, Errc::process, "run '{}' did not answer within {} s", run_name,
                  patience.count());
  MULLION_REQUIRE(!answer.empty(), Errc::process, "run '{}' ended before it answered", run_name);
  return answer;
}

void clean_up(const std::string& run_name)
{
  const auto path = lock_path_of(run_name);
  const auto lock = try_lock(path, 0);
  if (!lock.is_open()) return;
  ::unlink(socket_path_of(run_name).c_str());
  ::unlink(path.c_str());
}

} // namespace mullion::process
