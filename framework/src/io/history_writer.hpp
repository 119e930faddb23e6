// history.csv: one line per step, readable while the run goes on and by any tool. Numbers are the shortest texts
// that read back to the same doubles. Lines are buffered and written whole, at most five times a second: a
// process that dies loses the lines of the last 0.2 s at most, and a file in use may end within a line only if
// the disk ran full.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mullion::io {

class HistoryWriter {
public:
  /// @param columns         the names behind `step,time`
  /// @param continue_after  a step of an earlier attempt: its lines up to that step stay, later ones go. Without it,
  ///                        or if there is no file, the file starts anew.
  /// @throws Error Errc::io: the file cannot be written, or the one to go on with has other columns
  HistoryWriter(std::filesystem::path path, const std::vector<std::string>& columns,
                std::optional<std::int64_t> continue_after = {});
  /// Writes what is buffered, as far as it can.
  ~HistoryWriter();
  HistoryWriter(const HistoryWriter&) = delete;
  HistoryWriter& operator=(const HistoryWriter&) = delete;

  /// Append a line; as many values as columns.
  /// @throws Error Errc::io, naming the file
  void row(std::int64_t step, double time, std::span<const double> values);
  void flush();
  /// From any thread, not beside close(): what was flushed is on the disk, whatever happens to the machine.
  void sync() const;
  /// The step of the last line that was kept from an earlier attempt; -1: none was.
  [[nodiscard]] std::int64_t last_kept() const { return last_kept_; }
  /// Write what is buffered and close the file. Idempotent.
  void close();

private:
  using Clock = std::chrono::steady_clock;

  const std::filesystem::path path_;
  const std::size_t n_columns_;
  int fd_ = -1;
  std::int64_t last_kept_ = -1;
  fmt::memory_buffer buffer_;
  Clock::time_point last_flush_{};
};

} // namespace mullion::io
