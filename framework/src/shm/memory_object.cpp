#include "shm/memory_object.hpp"

#include <mullion/sdk/error.hpp>

#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <limits>
#include <sstream>
#include <sys/mman.h>
#include <unistd.h>

namespace mullion::shm {
namespace {

namespace bip = boost::interprocess;

std::string proc_path(pid_t pid, int fd) { return fmt::format("/proc/{}/fd/{}", pid, fd); }

/// A number from a one-line file of the control-group file system; the largest number for "max" or no file.
std::uint64_t read_limit(const std::string& path)
{
  std::ifstream file(path);
  std::uint64_t value = 0;
  return file >> value ? value : std::numeric_limits<std::uint64_t>::max();
}

/// What the control groups (version 2) of this process and their parents leave us.
std::uint64_t available_in_control_groups()
{
  constexpr auto unlimited = std::numeric_limits<std::uint64_t>::max();
  std::ifstream groups("/proc/self/cgroup");
  std::string line, group;
  while (std::getline(groups, line))
    if (line.rfind("0::", 0) == 0) group = line.substr(3);
  auto available = unlimited;
  for (;;) {
    const auto folder = "/sys/fs/cgroup" + group;
    const auto limit = read_limit(folder + "/memory.max");
    const auto used = read_limit(folder + "/memory.current");
    if (limit != unlimited && used != unlimited) available = std::min(available, limit - std::min(limit, used));
    if (group.empty() || group == "/") return available;
    group.erase(group.rfind('/'));
  }
}

} // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept
{
  if (this != &other) {
    if (fd_ >= 0) ::close(fd_);
    fd_ = other.release();
  }
  return *this;
}

Descriptor::~Descriptor()
{
  if (fd_ >= 0) ::close(fd_);
}

int Descriptor::release()
{
  const int fd = fd_;
  fd_ = -1;
  return fd;
}

std::uint64_t available_memory()
{
  std::ifstream info("/proc/meminfo");
  std::string key;
  std::uint64_t kib = 0;
  auto available = std::numeric_limits<std::uint64_t>::max();
  while (info >> key >> kib) {
    if (key == "MemAvailable:") available = kib * 1024;
    info.ignore(64, '\n');
  }
  return std::min(available, available_in_control_groups());
}

std::string human_bytes(std::uint64_t bytes)
{
  constexpr const char* units[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  double value = static_cast<double>(bytes);
  int unit = 0;
  while (value >= 1024.0 && unit < 6) value /= 1024.0, ++unit;
  return unit == 0 ? fmt::format("{} bytes", bytes) : fmt::format("{:.1f} {}", value, units[unit]);
}

Descriptor create_object(const std::string& name, std::uint64_t bytes)
{
  // Ask before allocating: over-committing ends in the kernel's out-of-memory killer and no message at all. A
  // margin stays free for the processes themselves.
  constexpr std::uint64_t margin = 64ull << 20;
  const auto available = available_memory();
  MULLION_REQUIRE(bytes <= available && available - bytes >= margin, Errc::memory,
                  "too little memory for '{}': it needs {}, {} are available (of which {} stay free for the "
                  "processes); use a smaller mesh, fewer levels or a larger machine",
                  name, human_bytes(bytes), human_bytes(available), human_bytes(margin));
  Descriptor object(::memfd_create(("mullion:" + name).substr(0, 200).c_str(), MFD_CLOEXEC | MFD_ALLOW_SEALING));
  MULLION_REQUIRE(object.is_open(), Errc::memory, "cannot create the memory object '{}': {}", name,
                  std::strerror(errno));
  int status = 0;
  while ((status = ::posix_fallocate(object.get(), 0, static_cast<off_t>(bytes))) == EINTR) {
  }
  MULLION_REQUIRE(status == 0, Errc::memory, "cannot allocate {} for '{}': {}", human_bytes(bytes), name,
                  std::strerror(status));
  MULLION_REQUIRE(::fcntl(object.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) == 0, Errc::memory,
                  "cannot seal the memory object '{}': {}", name, std::strerror(errno));
  return object;
}

Mapping map_object(pid_t pid, int fd, Access access)
{
  const auto mode = access == Access::read_only ? bip::read_only : bip::read_write;
  try {
    const bip::file_mapping file(proc_path(pid, fd).c_str(), mode);
    auto region = std::make_shared<bip::mapped_region>(file, mode);
    auto* data = static_cast<std::byte*>(region->get_address());
    const auto bytes = region->get_size();
    return {std::move(region), data, bytes};
  } catch (const bip::interprocess_exception& error) {
    throw Error(Errc::memory, fmt::format("cannot map the memory object {} of process {}: {}", fd, pid, error.what()));
  }
}

Descriptor adopt_object(pid_t pid, int fd)
{
  Descriptor object(::open(proc_path(pid, fd).c_str(), O_RDONLY | O_CLOEXEC));
  MULLION_REQUIRE(object.is_open(), Errc::memory, "cannot open the memory object {} of process {}: {}", fd, pid,
                  std::strerror(errno));
  return object;
}

} // namespace mullion::shm
