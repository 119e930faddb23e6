// Workers wait on a counter that the caller raises; the last to finish wakes the caller.
#include "crew.hpp"

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace mullion::euler {

namespace {

// A pass over a large mesh takes a millisecond or so, and the next one follows at once: a short spin spares both sides
// a sleep. It is short, because the threads of other solvers want the processor too.
constexpr int spins = 2000;

template <class Done> void wait_until(const std::atomic<std::uint32_t>& word, const Done& is_done)
{
  for (int i = 0; i < spins; ++i)
    if (is_done(word.load(std::memory_order_acquire))) return;
  for (auto seen = word.load(std::memory_order_acquire); !is_done(seen); seen = word.load(std::memory_order_acquire))
    word.wait(seen, std::memory_order_acquire);
}

} // namespace

struct Crew::Shared {
  std::atomic<std::uint32_t> round{0}, n_busy{0};
  std::atomic<bool> is_over{false};
  const std::function<void(int)>* work = nullptr;
  std::vector<std::thread> threads;

  void serve(int part)
  {
    for (std::uint32_t done = 0;;) {
      wait_until(round, [&](std::uint32_t now) { return now != done; });
      if (is_over.load(std::memory_order_acquire)) return;
      ++done;
      (*work)(part);
      if (n_busy.fetch_sub(1, std::memory_order_acq_rel) == 1) n_busy.notify_one();
    }
  }
};

Crew::Crew(int n) : n_(n), shared_(n > 1 ? std::make_unique<Shared>() : nullptr) {}

Crew::~Crew()
{
  if (!shared_) return;
  shared_->is_over.store(true, std::memory_order_release);
  shared_->round.fetch_add(1, std::memory_order_acq_rel);
  shared_->round.notify_all();
  for (auto& thread : shared_->threads) thread.join();
}

void Crew::run(const std::function<void(int)>& f)
{
  if (!shared_) return f(0);
  auto& shared = *shared_;
  if (shared.threads.empty())
    for (int part = 1; part < n_; ++part) shared.threads.emplace_back([&shared, part] { shared.serve(part); });
  shared.work = &f;
  shared.n_busy.store(static_cast<std::uint32_t>(n_ - 1), std::memory_order_release);
  shared.round.fetch_add(1, std::memory_order_acq_rel);
  shared.round.notify_all();
  f(0);
  wait_until(shared.n_busy, [](std::uint32_t busy) { return busy == 0; });
}

} // namespace mullion::euler
