// What the two things cost that make a step repeatable, beside a plain copy of the bytes that they are about: arming a
// window (its carried state is copied into the working level) and a commit (which copies nothing). One window in two
// slots, from 1 MB to 1 GB of state; the copy is from one half to the other of an object of the same kind. By turns;
// medians of times and of ratios, so that what neighbours took of the processor falls out.
//
//   build-dev/bench/levels [--rounds R] [--largest MB]
#include "mullion_run.hpp"

#include "shm/levels.hpp"
#include "shm/memory_object.hpp"
#include "shm/window_layout.hpp"

#include <cstring>
#include <memory>

namespace {

using mullion::bench::median;
using mullion::bench::milliseconds;
namespace shm = mullion::shm;

shm::WindowPlan plan_of(std::size_t megabytes)
{
  shm::WindowPlan plan;
  plan.name = "structure/store";
  plan.dimension = 3;
  const auto nodes = static_cast<std::int64_t>(megabytes) * 1000;
  plan.panes.push_back({0, nodes, 0, nullptr, nullptr, 0, 3});
  shm::FieldPlan field; // a state that is copied: the roles' defaults
  field.name = "values";
  field.unit = "1";
  field.components = 125; // a kilobyte a node
  field.entities = nodes;
  plan.fields.push_back(field);
  return plan;
}

void measure(std::size_t megabytes, int rounds)
{
  const auto plan = plan_of(megabytes);
  const auto object = shm::create_object(plan.name, shm::window_bytes(plan));
  const auto mapping = shm::map_object(::getpid(), object.get(), shm::Access::read_write);
  shm::write_window(plan, mapping.data, mapping.bytes);
  const shm::WindowView view(mapping.data, mapping.bytes, plan.name);
  const auto control = std::make_unique<shm::Control>();
  control->n_windows = 1;
  shm::initialise_levels(*control, 0, 2, 0.0, 1.0);
  const auto bytes = megabytes * 1'000'000;
  const auto other = shm::create_object("copy", 2 * bytes);
  const auto halves = shm::map_object(::getpid(), other.get(), shm::Access::read_write);
  const auto commit = [&] {
    control->working[0].is_written = 1;
    shm::commit(*control);
  };

  std::vector<double> copies, arms, commits, arm_ratios, commit_ratios;
  const auto n = std::max<std::size_t>(1, 200 / megabytes) * static_cast<std::size_t>(rounds);
  const auto half = [&](std::size_t i) { return halves.data + (i % 2) * bytes; };
  for (std::size_t i = 0; i < n + 2; ++i) {
    const double copy = milliseconds([&] { std::memcpy(half(i), half(i + 1), bytes); });
    const double arm = milliseconds([&] { shm::arm(view, control->table(control->epoch).windows[0]); });
    const double done = milliseconds(commit);
    if (i < 2) continue; // they map the pages
    copies.push_back(copy);
    arms.push_back(arm);
    commits.push_back(done);
    arm_ratios.push_back(arm / copy);
    commit_ratios.push_back(done / copy);
  }
  fmt::print("| {} MB | {:.3f} ms | {:.3f} ms | {:.2f} | {:.2f} us | {:.1e} |\n", megabytes, median(copies),
             median(arms), median(arm_ratios), 1e3 * median(commits), median(commit_ratios));
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
  int rounds = 15;
  std::size_t largest = 1000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--largest") == 0) largest = static_cast<std::size_t>(std::atol(argv[i + 1]));
  }
  fmt::print("| state | a copy | re-arm | / copy | commit | / copy |\n|---|---|---|---|---|---|\n");
  for (std::size_t megabytes = 1; megabytes <= largest; megabytes *= 10) measure(megabytes, rounds);
}
