#include "io/checkpoint_writer.hpp"

#include "io/atomic_file.hpp"
#include "io/checkpoint_files.hpp"

#include <mullion/sdk/error.hpp>

#include <signal.h>

#include <system_error>
#include <utility>

namespace mullion::io {

CheckpointWriter::CheckpointWriter(std::filesystem::path folder, std::int64_t n_kept, Report report)
    : folder_(std::move(folder)), n_kept_(n_kept), report_(std::move(report))
{
}

CheckpointWriter::~CheckpointWriter()
{
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void CheckpointWriter::submit(std::int64_t step, Image image, std::function<void()> before, Report done)
{
  if (!thread_.joinable()) {
    // signals are the orchestrator's main thread's; a limit on file sizes shall be an error here, not a signal
    sigset_t all, mask;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &mask);
    try {
      thread_ = std::thread([this] { run_thread(); });
    } catch (const std::system_error& error) {
      pthread_sigmask(SIG_SETMASK, &mask, nullptr);
      throw Error(Errc::process, fmt::format("no thread for writing checkpoints: {}", error.what()));
    }
    pthread_sigmask(SIG_SETMASK, &mask, nullptr);
  }
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !is_in_flight_; });
    step_ = step;
    image_ = std::move(image);
    before_ = std::move(before);
    done_ = std::move(done);
    is_in_flight_ = true;
  }
  changed_.notify_all();
}

void CheckpointWriter::wait()
{
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !is_in_flight_; });
}

void CheckpointWriter::run_thread()
{
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_ending_ || is_in_flight_; });
    if (!is_in_flight_) return;
    lock.unlock();
    const auto problem = write();
    if (problem.empty()) last_step_ = step_;
    report_(step_, problem);
    if (done_) done_(step_, problem);
    lock.lock();
    image_ = {};
    before_ = {};
    done_ = {};
    is_in_flight_ = false;
    changed_.notify_all();
  }
}

std::string CheckpointWriter::write() const
{
  try {
    if (before_) before_();
    write_atomically(folder_ / checkpoint_name(step_), image_, Trailer::checksum);
  } catch (const std::exception& error) {
    return error.what();
  }
  keep_newest_checkpoints(folder_, n_kept_, step_);
  return "";
}

} // namespace mullion::io
