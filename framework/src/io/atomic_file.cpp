#include "io/atomic_file.hpp"

#include <mullion/sdk/error.hpp>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

namespace mullion::io {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "trailers are little-endian");

constexpr char magic[8] = {'M', 'U', 'L', 'L', 'T', 'R', 'L', '1'};
constexpr std::string_view temporary_mark = ".tmp-";

/// tables[k][b]: the CRC of byte b followed by k zero bytes, for eight bytes a turn.
constexpr auto crc_tables = [] {
  std::array<std::array<std::uint64_t, 256>, 8> tables{};
  for (std::uint64_t b = 0; b < 256; ++b) {
    std::uint64_t crc = b;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xC96C5795D7870F42U : 0U);
    tables[0][b] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t b = 0; b < 256; ++b) tables[k][b] = (tables[k - 1][b] >> 8) ^ tables[0][tables[k - 1][b] & 0xff];
  return tables;
}();

[[noreturn]] void fail(const char* what, const fs::path& path, int code)
{
  const char* hint = "";
  if (code == ENOSPC || code == EDQUOT) hint = "; make room on that disk or choose another folder with --out";
  if (code == EFBIG) hint = "; the limit on file sizes (ulimit -f) is too small";
  if (code == EACCES || code == EROFS) hint = "; choose a folder that you may write to with --out";
  throw Error(Errc::io, fmt::format("{} {}: {}{}", what, path.string(), std::generic_category().message(code), hint));
}

class Descriptor {
public:
  Descriptor(const fs::path& path, int flags, const char* what) : path_(path)
  {
    do fd_ = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    while (fd_ < 0 && errno == EINTR);
    if (fd_ < 0) fail(what, path, errno);
  }
  ~Descriptor()
  {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write(std::span<const std::byte> bytes) const
  {
    while (!bytes.empty()) {
      // 1 GiB at a time: Linux writes less than 2 GiB in one call
      const auto n = ::write(fd_, bytes.data(), std::min<std::size_t>(bytes.size(), 1U << 30));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail("cannot write", path_, errno);
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
  }
  void sync() const
  {
    // EINVAL: a file system (or a special file) without sync
    if (::fsync(fd_) != 0 && errno != EINVAL) fail("cannot sync", path_, errno);
  }
  /// Some file systems (NFS) report a full disk only here.
  void close()
  {
    const int result = ::close(std::exchange(fd_, -1));
    if (result != 0 && errno != EINTR) fail("cannot close", path_, errno);
  }
  /// All bytes of a regular file.
  template <class Buffer> Buffer read() const
  {
    struct stat status {};
    if (::fstat(fd_, &status) != 0) fail("cannot read", path_, errno);
    if (S_ISDIR(status.st_mode)) fail("cannot read", path_, EISDIR);
    Buffer buffer;
    buffer.resize(static_cast<std::size_t>(status.st_size));
    std::size_t done = 0;
    while (done < buffer.size()) {
      const auto n = ::read(fd_, buffer.data() + done, buffer.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail("cannot read", path_, errno);
      if (n == 0) break;
      done += static_cast<std::size_t>(n);
    }
    buffer.resize(done);
    return buffer;
  }

private:
  const fs::path& path_;
  int fd_ = -1;
};

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

std::array<std::byte, trailer_bytes> make_trailer(std::span<const std::byte> content)
{
  const std::uint64_t numbers[2] = {content.size(), crc64(content)};
  std::array<std::byte, trailer_bytes> trailer;
  std::memcpy(trailer.data(), numbers, 16);
  std::memcpy(trailer.data() + 16, magic, 8);
  return trailer;
}

} // namespace

std::uint64_t crc64(std::span<const std::byte> content)
{
  const auto& t = crc_tables;
  std::uint64_t crc = ~std::uint64_t{0};
  std::size_t i = 0;
  for (; i + 8 <= content.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, content.data() + i, 8);
    crc ^= word;
    crc = t[7][crc & 0xff] ^ t[6][(crc >> 8) & 0xff] ^ t[5][(crc >> 16) & 0xff] ^ t[4][(crc >> 24) & 0xff] ^
          t[3][(crc >> 32) & 0xff] ^ t[2][(crc >> 40) & 0xff] ^ t[1][(crc >> 48) & 0xff] ^ t[0][crc >> 56];
  }
  for (; i < content.size(); ++i) crc = (crc >> 8) ^ t[0][(crc ^ static_cast<std::uint64_t>(content[i])) & 0xff];
  return ~crc;
}

void write_atomically(const fs::path& path, std::span<const std::byte> content, Trailer trailer)
{
  const fs::path temporary = path.string() + fmt::format("{}{}", temporary_mark, static_cast<long>(::getpid()));
  try {
    Descriptor file(temporary, O_WRONLY | O_CREAT | O_TRUNC, "cannot create");
    file.write(content);
    if (trailer == Trailer::checksum) file.write(make_trailer(content));
    file.sync();
    file.close();
    if (::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot replace", path, errno);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  const auto folder = folder_of(path);
  Descriptor(folder, O_RDONLY | O_DIRECTORY, "cannot open").sync();
}

void write_atomically(const fs::path& path, std::string_view text)
{
  write_atomically(path, std::as_bytes(std::span(text)), Trailer::none);
}

Bytes read_checked(const fs::path& path)
{
  auto bytes = Descriptor(path, O_RDONLY, "cannot open").read<Bytes>();
  const auto size = bytes.size();
  MULLION_REQUIRE(size >= trailer_bytes && std::memcmp(bytes.data() + size - 8, magic, 8) == 0, Errc::io,
                  "{} ({} bytes) does not end with Mullion's trailer: it was truncated, or "
                  "something else wrote it",
                  path.string(), size);
  std::uint64_t numbers[2];
  std::memcpy(numbers, bytes.data() + size - trailer_bytes, 16);
  bytes.resize(size - trailer_bytes);
  MULLION_REQUIRE(numbers[0] == bytes.size(), Errc::io,
                  "{} was truncated or altered: its trailer says {} bytes, {} are there", path.string(), numbers[0],
                  bytes.size());
  const auto found = crc64(bytes);
  MULLION_REQUIRE(numbers[1] == found, Errc::io,
                  "{} was altered: its trailer says checksum {:016x}, its content has {:016x}", path.string(),
                  numbers[1], found);
  return bytes;
}

std::string read_text(const fs::path& path) { return Descriptor(path, O_RDONLY, "cannot open").read<std::string>(); }

void make_folder(const fs::path& folder)
{
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail("cannot make the folder", folder, error.value());
}

void remove_stale_temporaries(const fs::path& folder) noexcept
{
  try {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const auto name = entry.path().filename().string();
      const auto mark = name.rfind(temporary_mark);
      if (mark == std::string::npos) continue;
      const char* const end = name.data() + name.size();
      pid_t pid = 0;
      const auto parsed = std::from_chars(name.data() + mark + temporary_mark.size(), end, pid);
      if (parsed.ec != std::errc{} || parsed.ptr != end || pid <= 0) continue;
      if (::kill(pid, 0) != 0 && errno == ESRCH) ::unlink(entry.path().c_str());
    }
  } catch (const std::exception&) {
    // a folder that cannot be listed has no temporaries of ours that matter
  }
}

} // namespace mullion::io
