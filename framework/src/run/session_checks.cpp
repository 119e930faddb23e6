// What a session does about the large exchanged fields that a module's runtime leaves to it: each is checked beside the
// run, and no step commits, and no window is written again, before what was written there proved finite.
#include "run/session.hpp"
#include "shm/levels.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>

namespace mullion::run {

void Session::check_later(std::uint32_t index)
{
  const auto& module = modules_[index];
  if (module.operation != shm::Operation::step && module.operation != shm::Operation::call) return;
  const auto& written = windows_written(module);
  for (const auto field : module.large_fields) {
    if (std::find(written.begin(), written.end(), field.window) == written.end()) continue;
    const auto values = read(field, 0);
    checker_.add(values.data(), values.size());
    checks_.push_back({index, field, fmt::format("{} failed {}", who(module), where(module))});
  }
}

void Session::check_first_state()
{
  for (const auto& module : modules_) {
    const auto& record = control_.modules[static_cast<std::size_t>(&module - modules_.data())];
    for (std::uint32_t i = 0; i < record.n_exchanged; ++i) {
      const FieldAddress field{record.exchanged[i].window, record.exchanged[i].field};
      const auto values = read(field, 0);
      const auto bad = shm::first_not_finite(values.data(), values.size());
      MULLION_REQUIRE(bad < 0, Errc::numeric, "{} failed in define, before the first step: {}", who(module),
                      shm::describe_not_finite(control_.windows[field.window].name,
                                               windows_.view(field.window).fields()[field.field], values.data(), bad));
    }
  }
}

void Session::settle(std::size_t n_checks)
{
  for (; n_settled_ < n_checks; ++n_settled_) {
    const auto bad = checker_.outcome(n_settled_);
    if (bad < 0) continue;
    const auto& check = checks_[n_settled_];
    const auto values = read(check.field, 0);
    const auto text =
        shm::describe_not_finite(control_.windows[check.field.window].name,
                                 windows_.view(check.field.window).fields()[check.field.field], values.data(), bad);
    throw Error(Errc::numeric, fmt::format("{}: {}", check.call, text));
  }
}

void Session::run_and_settle(const std::function<void()>& drive)
{
  try {
    drive();
    for (std::uint32_t m = 0; m < modules_.size(); ++m) await(m);
  } catch (...) {
    settle(checks_.size()); // who fails because of a value that is not finite is not the culprit: its writer is
    throw;
  }
  settle(checks_.size());
}

void Session::settle_before_writing(std::uint32_t module)
{
  if (windows_written(modules_[module]).empty()) return;
  for (auto n = checks_.size(); n > n_settled_; --n)
    if (checks_[n - 1].module == module) return settle(n);
}

void Session::forget_checks()
{
  checker_.clear();
  checks_.clear();
  n_settled_ = 0;
}

} // namespace mullion::run
