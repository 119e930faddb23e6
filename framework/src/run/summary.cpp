#include "run/summary.hpp"

#include "run/signal.hpp"

#include <fmt/format.h>

#include <cmath>

namespace mullion::run {
namespace {

/// "0.0061 m (expected 0.0061, +0.02 %)"
std::string beside_expected(double measured, double expected)
{
  if (expected == 0.0) return fmt::format("{:.6g}", measured);
  return fmt::format("{:.6g} (expected {:.6g}, {:+.3f} %)", measured, expected, 100.0 * (measured / expected - 1.0));
}

std::string duration(double seconds)
{
  return seconds < 1e-3  ? fmt::format("{:.1f} us", seconds * 1e6)
         : seconds < 1.0 ? fmt::format("{:.1f} ms", seconds * 1e3)
                         : fmt::format("{:.2f} s", seconds);
}

/// What crossed the interface, what got lost, and what the scheme's lag does.
std::string describe_interface(const Recorder::InterfaceSummary& i)
{
  std::string text =
      fmt::format("interface     work on the structure {:.6g} J; defect {:+.3e} J", i.work_structure, i.defect);
  if (i.scale > 0.0)
    text += fmt::format(" ({:+.2e} of the energy at play: {})", i.defect / i.scale, i.defect < 0.0 ? "made" : "lost");
  text += "\n";
  if (i.motion.frequency > 0.0)
    text += fmt::format("              oscillates at {:.6g} Hz, grows at {:+.3e} 1/s (fitted; residual {:.1e})\n",
                        i.motion.frequency, i.motion.growth, i.motion.relative_residual);
  if (!i.lag) text += "              net lag: no constant of this scheme, no estimate\n";
  else if (i.vacuum_frequency && i.motion.frequency > 0.0 &&
           std::abs(i.motion.frequency - *i.vacuum_frequency) > 0.2 * *i.vacuum_frequency)
    text += fmt::format("              net lag {:.4g} s, no estimate of what it does: another mode dominates than the "
                        "structure's lowest ({:.6g} Hz alone)\n",
                        *i.lag, *i.vacuum_frequency);
  else if (i.vacuum_frequency && i.motion.frequency > 0.0)
    text += fmt::format("              net lag {:.4g} s: it alone makes {:+.3e} 1/s (structure alone: {:.6g} Hz)\n",
                        *i.lag, growth_from_lag(*i.lag, i.motion.frequency, *i.vacuum_frequency), *i.vacuum_frequency);
  else text += fmt::format("              net lag {:.4g} s, no estimate of what it does\n", *i.lag);
  if (i.made)
    text +=
        fmt::format("  warning: the scheme manufactures energy: growth {:+.3e} 1/s, explained by the defect {:+.3e} "
                    "1/s\n",
                    i.made->growth, i.made->explained);
  return text;
}

} // namespace

std::string summary(const Recorder& recorder, const std::string& stopped_by)
{
  const auto& attempt = recorder.attempt();
  const auto& c = recorder.the_case();
  const auto n_done = attempt.steps - attempt.first_step;
  const double per_step = attempt.wall_s / static_cast<double>(std::max<std::int64_t>(1, n_done));
  std::string text = fmt::format("run {}: {}{}, {} steps to t = {} s in {} ({} a step)\n", c.name, attempt.outcome,
                                 stopped_by.empty() ? "" : " by " + stopped_by, attempt.steps, attempt.simulated_time,
                                 duration(attempt.wall_s), duration(per_step));
  for (std::size_t s = 0; s < recorder.series().size(); ++s) {
    const auto& series = recorder.series()[s];
    const auto& expected = c.expectations[s];
    text += fmt::format("{}\n", series.quantity);
    text += fmt::format("  amplitude  {}\n", beside_expected(amplitude(series.values), expected.amplitude));
    const double frequency = dominant_frequency(series.times, series.values);
    text += frequency == 0.0 ? "  frequency  none: fewer than two periods were seen\n"
                             : fmt::format("  frequency  {} Hz\n", beside_expected(frequency, expected.frequency));
    text += fmt::format("  expected from: {}\n", expected.source);
  }
  if (recorder.interface_summary()) text += describe_interface(*recorder.interface_summary());
  for (const auto& [call, answer] : attempt.functions) text += fmt::format("{} = {:.6g}\n", call, answer);
  text += fmt::format("time          {:<28} {:>10} {:>10} {:>10} {:>7}\n", "", "calls", "work", "waiting", "share");
  for (const auto& timing : attempt.timings)
    if (timing.call != attach_call)
      text += fmt::format("  {:<12}{:<28} {:>10} {:>10} {:>10} {:>5.1f} %\n", timing.who, timing.call, timing.count,
                          duration(timing.work_s), duration(timing.wait_s), 100.0 * timing.wall_s / attempt.wall_s);
  text += fmt::format("results in {}\n", recorder.out().string());
  return text;
}

} // namespace mullion::run
