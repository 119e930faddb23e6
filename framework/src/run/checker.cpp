#include "run/checker.hpp"

#include "shm/levels.hpp"

#include <algorithm>

namespace mullion::run {

namespace {

/// 1 MiB: long enough that taking one costs nothing beside it, short enough that the last one is not waited for.
constexpr std::int64_t chunk = 1 << 17;

} // namespace

Checker::~Checker()
{
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  is_added_.notify_one();
  thread_.join();
}

void Checker::add(const double* values, std::int64_t n)
{
  auto job = std::make_shared<Job>();
  job->values = values;
  job->n = n;
  job->n_chunks = (n + chunk - 1) / chunk;
  job->first_bad = n;
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  if (thread_.joinable()) is_added_.notify_one();
  else thread_ = std::thread([this] { loop(); });
}

std::int64_t Checker::outcome(std::size_t index)
{
  auto& job = *jobs_[index]; // only this thread changes the list
  work_on(job);
  {
    std::unique_lock lock(mutex_);
    is_done_.wait(lock, [&] { return job.n_done == job.n_chunks; });
  }
  return job.first_bad < job.n ? job.first_bad.load() : -1;
}

void Checker::clear()
{
  for (std::size_t i = 0; i < jobs_.size(); ++i) (void)outcome(i);
  const std::lock_guard lock(mutex_);
  jobs_.clear();
  n_begun_ = 0;
}

void Checker::loop()
{
  for (;;) {
    std::shared_ptr<Job> job; // it may be cleared while we find that nothing of it is left to do
    {
      std::unique_lock lock(mutex_);
      is_added_.wait(lock, [&] { return is_over_ || n_begun_ < jobs_.size(); });
      if (is_over_) return;
      job = jobs_[n_begun_++];
    }
    work_on(*job);
  }
}

void Checker::work_on(Job& job)
{
  // From the last chunk to the first, as in first_not_finite(): what was written last is what the caches still hold.
  for (;;) {
    const auto k = job.n_chunks - 1 - job.n_taken.fetch_add(1);
    if (k < 0) return;
    const auto start = k * chunk;
    const auto bad = shm::first_not_finite(job.values + start, std::min(chunk, job.n - start), true);
    if (bad >= 0)
      for (auto first = job.first_bad.load(); start + bad < first;)
        if (job.first_bad.compare_exchange_weak(first, start + bad)) break;
    if (job.n_done.fetch_add(1) + 1 < job.n_chunks) continue;
    const std::lock_guard lock(mutex_); // so that it cannot fall between a waiter's look and its sleep
    is_done_.notify_all();
  }
}

} // namespace mullion::run
