// Shared-memory objects: memfds without a name, allocated for real, sealed against shrinking and growing. They
// vanish with the last process that holds them, so nothing can stay behind, however a run ends. Other processes of
// the run open them through /proc/<pid>/fd/<n>, read-only or read-write; the kernel then refuses stray writes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <sys/types.h>

namespace mullion::shm {

/// A file descriptor that closes itself.
class Descriptor {
public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool is_open() const { return fd_ >= 0; }
  int release();

private:
  int fd_ = -1;
};

enum class Access { read_only, read_write };

/// A mapped object. Unmapped when the last copy of `region` goes.
struct Mapping {
  std::shared_ptr<void> region;
  std::byte* data = nullptr;
  std::uint64_t bytes = 0;
};

/// Create an object of exactly this size, zero-filled, its memory allocated now.
/// @throws Error Errc::memory if the machine (or the container's limit) does not have that much available
Descriptor create_object(const std::string& name, std::uint64_t bytes);

/// Map an object of process `pid` (our own included). @throws Error Errc::memory
Mapping map_object(pid_t pid, int fd, Access access);

/// Open another process's object, so that it lives on when that process dies. @throws Error Errc::memory
Descriptor adopt_object(pid_t pid, int fd);

/// Bytes that can still be allocated: MemAvailable, or less where a control group limits us.
std::uint64_t available_memory();

/// "1.2 GiB": for messages.
std::string human_bytes(std::uint64_t bytes);

} // namespace mullion::shm
