#include "study/study_progress.hpp"

#include "log/console.hpp"

#include <string>

namespace mullion::study {

Progress::Progress() : interval_(log::is_terminal() ? std::chrono::milliseconds(100) : std::chrono::seconds(10))
{
  next_ += interval_;
}

void Progress::show(const Counts& counts)
{
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + interval_;
  const auto n_here = counts.n_done - counts.n_before, n_left = counts.n_runs - counts.n_done;
  auto text = fmt::format("{}/{} runs, {} failed, {} under way, {} waiting", counts.n_done, counts.n_runs,
                          counts.n_failed, counts.n_running, n_left - counts.n_running);
  if (n_here > 0) {
    const auto s = static_cast<long>(std::chrono::duration<double>(now - begin_).count() / static_cast<double>(n_here) *
                                     static_cast<double>(n_left));
    text += s < 3600 ? fmt::format(", {}:{:02} left", s / 60, s % 60)
                     : fmt::format(", {}:{:02}:{:02} left", s / 3600, s / 60 % 60, s % 60);
  }
  if (!log::is_terminal()) {
    log::info("study", "{}", text);
    return;
  }
  constexpr std::size_t width = 24;
  const auto filled = width * counts.n_done / counts.n_runs;
  log::show_progress(fmt::format("[{}{}] {:3} % {}", std::string(filled, '#'), std::string(width - filled, '.'),
                                 100 * counts.n_done / counts.n_runs, text));
}

} // namespace mullion::study
