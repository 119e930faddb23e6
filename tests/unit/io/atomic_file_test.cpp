// Files that are whole or not there: the trailer against truncation and alteration, replacement, full disks.
#include "io/atomic_file.hpp"

#include "scratch.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <sys/resource.h>

#include <csignal>
#include <fstream>

using namespace mullion;
using namespace mullion::io;
using mullion::testing::Scratch;

namespace {

Bytes some_bytes(std::size_t n)
{
  Bytes bytes(n);
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::byte>(31 * i + 7);
  return bytes;
}

void overwrite(const std::filesystem::path& path, const std::string& content)
{
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

std::string message_of_reading(const std::filesystem::path& path)
{
  try {
    (void)read_checked(path);
  } catch (const Error& error) {
    CHECK(error.code() == Errc::io);
    return error.what();
  }
  return "";
}

std::size_t n_files(const std::filesystem::path& folder)
{
  std::size_t n = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++n;
  return n;
}

/// Files of this process end at `limit` bytes while this lives, with an error instead of a signal.
class FileSizeLimit {
public:
  explicit FileSizeLimit(rlim_t limit)
  {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit now = before_;
    now.rlim_cur = limit;
    ::setrlimit(RLIMIT_FSIZE, &now);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit()
  {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
  rlimit before_{};
  void (*handler_)(int);
};

} // namespace

TEST_CASE("the checksum is the CRC-64 of the .xz format")
{
  const auto crc = [](std::string_view text) { return crc64(std::as_bytes(std::span(text))); };

  CHECK(crc("123456789") == 0x995DC9BBDF1939FAU); // the check value of CRC-64/XZ in the catalogue of CRCs
  CHECK(crc("") == 0);
}

TEST_CASE("a checked file gives back its content, of any length")
{
  const Scratch scratch;
  for (const std::size_t n : {0, 1, 7, 8, 9, 100000}) {
    write_atomically(scratch / "file", some_bytes(n), Trailer::checksum);

    CHECK(read_checked(scratch / "file") == some_bytes(n));
    CHECK(std::filesystem::file_size(scratch / "file") == n + trailer_bytes);
  }
  CHECK(n_files(scratch.path()) == 1);
}

TEST_CASE("a checked file that was cut anywhere is refused")
{
  const Scratch scratch;
  write_atomically(scratch / "file", some_bytes(61), Trailer::checksum);
  const auto whole = read_text(scratch / "file");

  for (std::size_t n = 0; n < whole.size(); ++n) {
    overwrite(scratch / "file", whole.substr(0, n));
    CHECK(message_of_reading(scratch / "file").find("truncated") != std::string::npos);
  }
  overwrite(scratch / "file", whole + "x");
  CHECK(message_of_reading(scratch / "file") != "");
  overwrite(scratch / "file", whole.substr(1));
  CHECK(message_of_reading(scratch / "file").find("60") != std::string::npos);
}

TEST_CASE("a checked file is refused whichever bits of whichever byte were changed")
{
  const Scratch scratch;
  write_atomically(scratch / "file", some_bytes(61), Trailer::checksum);
  const auto whole = read_text(scratch / "file");

  std::size_t n_caught = 0;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const int bits : {0x01, 0x10, 0x80, 0xff}) {
      auto altered = whole;
      altered[i] = static_cast<char>(altered[i] ^ bits);
      overwrite(scratch / "file", altered);
      if (!message_of_reading(scratch / "file").empty()) ++n_caught;
    }
  CHECK(n_caught == 4 * whole.size());
}

TEST_CASE("a file that cannot grow is an error that says so, and the old file stays")
{
  const Scratch scratch;
  write_atomically(scratch / "file", "old");

  std::string message;
  {
    const FileSizeLimit limit(1000);
    try {
      write_atomically(scratch / "file", some_bytes(5000), Trailer::checksum);
    } catch (const Error& error) {
      CHECK(error.code() == Errc::io);
      message = error.what();
    }
  }

  CHECK(message.find("cannot write " + (scratch / "file").string()) == 0);
  CHECK(message.find("File too large") != std::string::npos);
  CHECK(read_text(scratch / "file") == "old");
  CHECK(n_files(scratch.path()) == 1); // no temporary stays
}

TEST_CASE("a missing folder and a missing file are errors that name them")
{
  const Scratch scratch;

  CHECK_THROWS_WITH_AS(write_atomically(scratch / "none" / "file", "x"), doctest::Contains("none/file"), Error);
  CHECK_THROWS_WITH_AS((void)read_checked(scratch / "missing"), doctest::Contains("missing: No such file"), Error);
  CHECK_THROWS_WITH_AS((void)read_text(scratch.path()), doctest::Contains("Is a directory"), Error);
  overwrite(scratch / "plain", "");
  CHECK_THROWS_WITH_AS(make_folder(scratch / "plain" / "sub"), doctest::Contains("plain/sub: Not a directory"), Error);
}

TEST_CASE("temporaries of dead processes are swept, those of living ones and other files are not")
{
  const Scratch scratch;
  const auto alive = "a.h5.tmp-" + std::to_string(::getpid());
  // above the largest number that Linux gives a process
  for (const auto& name : {std::string("a.h5.tmp-999999999"), alive, std::string("b.tmp-12x"), std::string("c.h5")})
    overwrite(scratch / name, "x");

  remove_stale_temporaries(scratch.path());

  CHECK_FALSE(std::filesystem::exists(scratch / "a.h5.tmp-999999999"));
  CHECK(n_files(scratch.path()) == 3);
  remove_stale_temporaries(scratch / "missing"); // nothing, and no error
}
