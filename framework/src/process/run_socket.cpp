#include "process/run_socket.hpp"

#include "config/suggestions.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

namespace mullion::process {
namespace {

namespace fs = std::filesystem;

constexpr timeval patience_with_clients{0, 200'000}; // a client that sends nothing must not hold up the run
constexpr timeval patience_with_runs{5, 0};

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

std::string read_line(int fd)
{
  std::string line;
  char c = 0;
  while (line.size() < 65536 && ::read(fd, &c, 1) == 1 && c != '\n') line += c;
  return line;
}

void send_all(int fd, const std::string& text)
{
  for (std::size_t sent = 0; sent < text.size();) {
    const auto n = ::send(fd, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
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

RunSocket::RunSocket(const std::string& run_name, pid_t pid)
    : path_(socket_path_of(run_name)), lock_path_(lock_path_of(run_name)), lock_(try_lock(lock_path_, O_CREAT))
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

void RunSocket::answer_one(const std::function<std::string(const std::string&)>& answer)
{
  shm::Descriptor client(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
  if (!client.is_open()) return;
  ::setsockopt(client.get(), SOL_SOCKET, SO_RCVTIMEO, &patience_with_clients, sizeof patience_with_clients);
  ::setsockopt(client.get(), SOL_SOCKET, SO_SNDTIMEO, &patience_with_clients, sizeof patience_with_clients);
  ucred who{};
  socklen_t size = sizeof who;
  if (::getsockopt(client.get(), SOL_SOCKET, SO_PEERCRED, &who, &size) != 0 || who.uid != ::getuid()) {
    send_all(client.get(), "error: this run belongs to another user\n");
    return;
  }
  send_all(client.get(), answer(read_line(client.get())) + "\n");
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

std::string ask_run(const std::string& run_name, const std::string& line)
{
  shm::Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto address = address_of(socket_path_of(run_name));
  ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &patience_with_runs, sizeof patience_with_runs);
  ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &patience_with_runs, sizeof patience_with_runs);
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw Error(Errc::config,
                fmt::format("no run named '{}' is alive{}", run_name, config::suggestion(run_name, live_runs())));
  send_all(socket.get(), line + "\n");
  const auto answer = read_line(socket.get());
  MULLION_REQUIRE(!answer.empty(), Errc::process, "run '{}' did not answer within {} s", run_name,
                  patience_with_runs.tv_sec);
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
