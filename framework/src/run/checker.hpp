// The check of large exchanged fields for finite values, beside the run: a thread of the orchestrator looks through
// what one module wrote while the next one works, and whoever needs the outcome helps it to finish. Small fields are
// checked at once by the module's runtime, where they still lie in the caches; to read a large one again from memory,
// with all else waiting, would cost as much as writing it did.
//
// It reads windows and writes nothing shared. Whoever adds a field sees to it that nobody writes there until its
// outcome was asked for. A host that dies leaves its windows whole: nothing here notices.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace mullion::run {

class Checker {
public:
  Checker() = default;
  ~Checker();
  Checker(const Checker&) = delete;
  Checker& operator=(const Checker&) = delete;

  /// Have values looked through. The first call starts the thread: a run without large fields has none.
  void add(const double* values, std::int64_t n);

  /// Wait for the outcome of a check, helping with it. The thread need not get a core for this to end.
  /// @param index  0: the first that was added since clear()
  /// @return       index of the first value that is not finite, or -1
  [[nodiscard]] std::int64_t outcome(std::size_t index);

  /// Wait for all checks and forget them.
  void clear();

private:
  struct Job {
    const double* values;
    std::int64_t n, n_chunks;
    std::atomic<std::int64_t> n_taken{0}, n_done{0}, first_bad;
  };
  void loop();
  void work_on(Job& job);

  std::mutex mutex_; ///< of all that follows; a job's own members are atomic
  std::condition_variable is_added_, is_done_;
  std::vector<std::shared_ptr<Job>> jobs_;
  std::size_t n_begun_ = 0; ///< jobs that the thread has turned to
  bool is_over_ = false;
  std::thread thread_;
};

} // namespace mullion::run
