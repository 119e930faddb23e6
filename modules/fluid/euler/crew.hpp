// A crew of threads that does one thing at a time, each its own fixed part of it, and sleeps in between.
#pragma once

#include <functional>
#include <memory>

namespace mullion::euler {

class Crew {
public:
  /// @param n  parts of the work, hence threads; the caller's is one of them. The others start with the first run().
  explicit Crew(int n);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  [[nodiscard]] int size() const { return n_; }

  /// f(0), … f(n - 1), at the same time; returns when all are done.
  /// @pre f does not throw
  void run(const std::function<void(int part)>& f);

private:
  struct Shared;
  int n_;
  std::unique_ptr<Shared> shared_; // none with one thread
};

} // namespace mullion::euler
