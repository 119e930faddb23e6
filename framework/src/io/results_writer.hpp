// The results of a run: results/mesh.h5 once, one closed HDF5 file per output, and the two indices results.xdmf and
// results.h5 beside the folder (docs/formats/results.md). The calling thread builds images in memory; a thread of the
// writer's own puts bytes on the disk, one output at a time, its file before the indices that name it. A process
// that dies here leaves whole files and an index of files that are all there.
#pragma once

#include "io/atomic_file.hpp"
#include "io/snapshot.hpp"
#include "io/xdmf_index.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace mullion::io {

class ResultsWriter {
public:
  /// @param out       the run's folder; it and its results/ are made by begin()
  /// @param run_name  for messages only: nothing of it is written
  ResultsWriter(std::filesystem::path out, std::string run_name);
  /// Writes what finish() would, as far as it can.
  ~ResultsWriter();
  ResultsWriter(const ResultsWriter&) = delete;
  ResultsWriter& operator=(const ResultsWriter&) = delete;

  /// After a restart in the same folder: the index goes on from the outputs that the checkpoint lists, as far as their
  /// files are there; files of other outputs are removed. Call before begin().
  void go_on_from(const OutputList& outputs);
  /// The outputs so far, for a checkpoint.
  [[nodiscard]] OutputList outputs() const { return index_.list(); }
  [[nodiscard]] bool has_output(std::int64_t step) const;

  /// Write mesh.h5, here and now (so that a folder that can't be written fails at the start): reference coordinates,
  /// connectivity, and the fields of `windows` as those that never change. Called once.
  void begin(const std::vector<WindowData>& windows);

  /// Write one output, with the fields of `windows` as those that change; the panes are begin()'s, in any
  /// number. Steps come in increasing order. The arrays are free again when this returns.
  /// @throws Error Errc::io: this output, or the one before, could not be written
  void write(std::int64_t step, double time, const std::vector<WindowData>& windows);

  /// Wait until all outputs so far, and indices that name them, are on disk. Call it before a checkpoint becomes
  /// visible: then a restart from there finds all earlier outputs in the index.
  /// @throws Error Errc::io: an output or an index could not be written
  void flush();

  /// From any thread: wait until the outputs that were handed over so far are on disk. @return are they?
  [[nodiscard]] bool wait_for_outputs();

  /// flush() and end the thread.
  /// @throws Error Errc::io, once
  void finish();

private:
  using Clock = std::chrono::steady_clock;
  struct File {
    std::filesystem::path path;
    Bytes content;
    Trailer trailer;
  };
  struct PaneSize {
    std::int64_t n_nodes, n_elements;
  };

  void run_thread();
  void submit(std::vector<File> files, bool is_output);
  void wait_until_idle(std::unique_lock<std::mutex>& lock);
  std::vector<File> index_files();
  [[nodiscard]] std::filesystem::path output_path(std::int64_t step) const;

  const std::filesystem::path out_, results_;
  const std::string run_name_;
  XdmfIndex index_;
  std::map<std::string, PaneSize> panes_; ///< by pane group
  bool has_begun_ = false;
  bool is_index_due_ = false; ///< an output is not yet in the indices on disk
  Clock::time_point next_index_{};

  std::thread thread_;
  std::mutex mutex_; ///< guards what follows
  std::condition_variable changed_;
  std::vector<File> files_; ///< in flight: the thread's until it empties it
  bool is_output_ = false;  ///< the first of files_ is an output
  bool is_ending_ = false;
  std::exception_ptr error_;
};

} // namespace mullion::io
