// Puts checkpoints on the disk while the run goes on: a thread of its own, one file in flight. What a checkpoint refers
// to (rows of history.csv, result files) is on the disk before it appears under its name, and an older one is removed
// only after that. A checkpoint that cannot be written is told and costs the run nothing else: the older ones stay.
// A process that dies here leaves a temporary file, never a part of a checkpoint under its name.
#pragma once

#include "io/hdf5_image.hpp"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace mullion::io {

class CheckpointWriter {
public:
  /// Called in the writer's thread when a file is done. @param problem  "", or why it was not written
  using Report = std::function<void(std::int64_t step, const std::string& problem)>;

  /// @param n_kept  so many checkpoints stay in the folder; 0: all
  CheckpointWriter(std::filesystem::path folder, std::int64_t n_kept, Report report);
  /// Writes what it was given.
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  /// Hand over one checkpoint; waits while another is in flight.
  /// @param before  called in the writer's thread first: wait for what the checkpoint refers to; it may throw
  /// @param done    called like the report, for this one
  /// @throws Error Errc::process if there is no thread to be had
  void submit(std::int64_t step, Image image, std::function<void()> before, Report done = {});

  /// Wait until nothing is in flight.
  void wait();

  /// The step of the newest checkpoint that this writer put on the disk; -1: none yet. From any thread.
  [[nodiscard]] std::int64_t last_step() const { return last_step_.load(); }

private:
  void run_thread();
  [[nodiscard]] std::string write() const; ///< the one in flight. @return what went wrong

  const std::filesystem::path folder_;
  const std::int64_t n_kept_;
  const Report report_;
  std::atomic<std::int64_t> last_step_{-1};
  std::thread thread_;
  std::mutex mutex_; ///< guards what follows
  std::condition_variable changed_;
  bool is_in_flight_ = false, is_ending_ = false;
  std::int64_t step_ = 0; ///< this and what follows: the thread's while a file is in flight
  Image image_;
  std::function<void()> before_;
  Report done_;
};

} // namespace mullion::io
