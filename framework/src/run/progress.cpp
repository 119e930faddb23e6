#include "run/progress.hpp"

#include "log/console.hpp"

#include <string>

namespace mullion::run {
namespace {

std::string duration_text(double seconds)
{
  const auto s = static_cast<std::int64_t>(seconds + 0.5);
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

} // namespace

Progress::Progress(const std::atomic<std::int64_t>& n_steps)
    : n_steps_(n_steps), begin_(Clock::now()),
      interval_(log::is_terminal() ? std::chrono::milliseconds(100) : std::chrono::seconds(10))
{
  next_ = begin_ + interval_;
}

void Progress::show(const TimeStep& done)
{
  if (first_step_ < 0) first_step_ = done.index - 1;
  if (done.index < next_look_) return; // a step may take a microsecond: don't ask the clock each time
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  const double rate = static_cast<double>(done.index - first_step_) / std::max(elapsed, 1e-9);
  next_look_ = done.index + static_cast<std::int64_t>(rate * 0.01);
  if (now < next_) return;
  next_ = now + interval_;
  const auto n_steps = n_steps_.load();
  const double share = static_cast<double>(done.index) / static_cast<double>(n_steps);
  const double left = static_cast<double>(n_steps - done.index) / rate;
  const auto text = fmt::format("step {}/{}, t = {:.6g} s, {:.4g} steps/s, {} left", done.index, n_steps, done.end,
                                rate, duration_text(left));
  if (!log::is_terminal()) {
    log::info("run", "{}", text);
    return;
  }
  constexpr int width = 24;
  const int filled = static_cast<int>(share * width);
  log::show_progress(fmt::format("[{}{}] {:3.0f} % {}", std::string(filled, '#'), std::string(width - filled, '.'),
                                 100 * share, text));
}

} // namespace mullion::run
