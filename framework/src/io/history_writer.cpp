#include "io/history_writer.hpp"

#include "io/atomic_file.hpp"

#include <mullion/sdk/error.hpp>

#include <fmt/compile.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

namespace mullion::io {
namespace {

constexpr auto flush_interval = std::chrono::milliseconds(200);
constexpr std::size_t flush_size = std::size_t{1} << 20; // [bytes] whatever the time

[[noreturn]] void fail(const char* what, const std::filesystem::path& path, int code)
{
  throw Error(Errc::io, fmt::format("cannot {} {}: {}", what, path.string(), std::generic_category().message(code)));
}

/// Bytes of `text` up to and with the last whole line whose step is at most `step`; that line's step goes to `last`.
std::size_t end_of_step(std::string_view text, std::string_view header, std::int64_t step, std::int64_t& last)
{
  std::size_t end = header.size();
  while (true) {
    const auto newline = text.find('\n', end);
    if (newline == std::string_view::npos) return end;
    std::int64_t found = 0;
    const auto parsed = std::from_chars(text.data() + end, text.data() + newline, found);
    if (parsed.ec != std::errc{} || *parsed.ptr != ',' || found > step) return end;
    end = newline + 1;
    last = found;
  }
}

} // namespace

HistoryWriter::HistoryWriter(std::filesystem::path path, const std::vector<std::string>& columns,
                             std::optional<std::int64_t> continue_after)
    : path_(std::move(path)), n_columns_(columns.size())
{
  std::string header = "step,time";
  for (const auto& column : columns) header += "," + column;
  header += "\n";

  std::size_t kept = 0;
  std::error_code ignored;
  if (continue_after && std::filesystem::exists(path_, ignored)) {
    const auto text = read_text(path_);
    MULLION_REQUIRE(text.empty() || text.starts_with(header), Errc::io,
                    "cannot go on with {}: its columns are '{}' but this run's are '{}'; choose another folder "
                    "with --out",
                    path_.string(), text.substr(0, text.find('\n')),
                    std::string_view(header).substr(0, header.size() - 1));
    if (!text.empty()) kept = end_of_step(text, header, *continue_after, last_kept_);
  }

  fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (fd_ < 0) fail("create", path_, errno);
  // EINVAL: not a regular file (a pipe, a terminal)
  const bool is_cut = ::ftruncate(fd_, static_cast<off_t>(kept)) == 0 || errno == EINVAL;
  if (!is_cut || (::lseek(fd_, static_cast<off_t>(kept), SEEK_SET) < 0 && errno != ESPIPE)) {
    const int code = errno;
    ::close(std::exchange(fd_, -1));
    fail("write", path_, code);
  }
  if (kept == 0) buffer_.append(header);
}

HistoryWriter::~HistoryWriter()
{
  try {
    close();
  } catch (const Error&) {
    // whoever cares calls close() himself
  }
}

void HistoryWriter::row(std::int64_t step, double time, std::span<const double> values)
{
  MULLION_ASSERT(fd_ >= 0 && values.size() == n_columns_, "{}: a row of {} values for {} columns{}", path_.string(),
                 values.size(), n_columns_, fd_ < 0 ? ", after close" : "");
  auto out = std::back_inserter(buffer_);
  fmt::format_to(out, FMT_COMPILE("{},{}"), step, time);
  for (const double value : values) fmt::format_to(out, FMT_COMPILE(",{}"), value);
  buffer_.push_back('\n');
  if (buffer_.size() >= flush_size || Clock::now() - last_flush_ >= flush_interval) flush();
}

void HistoryWriter::flush()
{
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const auto n = ::write(fd_, buffer_.data() + done, buffer_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int code = errno;
      buffer_.clear(); // or the destructor would fail again
      fail("write", path_, code);
    }
    done += static_cast<std::size_t>(n);
  }
  buffer_.clear();
  last_flush_ = Clock::now();
}

void HistoryWriter::sync() const
{
  // EINVAL: not a regular file (a pipe, a terminal)
  if (::fsync(fd_) != 0 && errno != EINVAL) fail("sync", path_, errno);
}

void HistoryWriter::close()
{
  if (fd_ < 0) return;
  try {
    flush();
  } catch (...) {
    ::close(std::exchange(fd_, -1));
    throw;
  }
  if (::close(std::exchange(fd_, -1)) != 0 && errno != EINTR) fail("close", path_, errno);
}

} // namespace mullion::io
