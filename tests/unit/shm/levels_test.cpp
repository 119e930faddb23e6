#include "shm/levels.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

using namespace mullion;
using namespace mullion::shm;

namespace {

/// One window of n_slots slots with a carried state, an overwritten state and an output of four numbers each.
struct OneWindow {
  std::unique_ptr<Control> control = std::make_unique<Control>();
  std::vector<std::byte> memory;
  WindowView view;

  explicit OneWindow(std::uint32_t n_slots)
  {
    WindowPlan plan;
    plan.name = "a/b";
    plan.dimension = 1;
    plan.n_slots = n_slots;
    plan.panes = {{0, 4, 0, nullptr, nullptr, 0, 1}};
    const auto add = [&](const char* name, std::uint32_t role, std::uint32_t carry) {
      FieldPlan field;
      field.name = name;
      field.unit = "1";
      field.role = role;
      field.carry = carry;
      field.entities = 4;
      plan.fields.push_back(field);
    };
    add("carried", MULLION_STATE, MULLION_COPY);
    add("overwritten", MULLION_STATE, MULLION_OVERWRITE);
    add("output", MULLION_OUTPUT, MULLION_OVERWRITE);
    memory.resize(window_bytes(plan));
    write_window(plan, memory.data(), memory.size());
    view = WindowView(memory.data(), memory.size(), "a/b");
    control->n_windows = 1;
    initialise_levels(*control, 0, n_slots, /*t0=*/1.0, /*dt=*/0.5);
  }
  [[nodiscard]] const LevelEntry& levels() const { return control->table(control->epoch).windows[0]; }
  double* field(int f, int level)
  {
    return reinterpret_cast<double*>(view.data(view.fields()[f], slot_of(levels(), level)));
  }
  void write(double value, double time, std::int64_t step)
  {
    for (int f = 0; f < 3; ++f) std::fill_n(field(f, 0), 4, value);
    control->working[0] = {{time, step, 0, MULLION_INSTANT}, 1, 0};
  }
};

} // namespace

TEST_CASE("at the start all levels are stamped backwards from the initial time")
{
  const OneWindow window(4);

  CHECK(window.levels().committed[0].time == 1.0);
  CHECK(window.levels().committed[2].time == 0.0);
}

TEST_CASE("a commit makes the working level the newest committed one and shifts the others")
{
  OneWindow window(3);
  window.write(10.0, 1.5, 1);
  commit(*window.control);
  window.write(20.0, 2.0, 2);

  commit(*window.control);

  CHECK(window.control->epoch == 2);
  CHECK(window.field(0, 1)[0] == 20.0);
  CHECK(window.field(0, 2)[3] == 10.0);
  CHECK(window.levels().committed[0].time == 2.0);
  CHECK(window.levels().committed[1].time == 1.5);
  CHECK(window.levels().committed[1].step == 1);
}

TEST_CASE("a window that was not written keeps its levels through a commit")
{
  OneWindow window(2);
  window.write(10.0, 1.5, 1);
  commit(*window.control);

  commit(*window.control);

  CHECK(window.control->epoch == 2);
  CHECK(window.field(0, 1)[0] == 10.0);
  CHECK(window.levels().committed[0].time == 1.5);
}

TEST_CASE("the old table stays whole until the epoch flips: a reader of the old epoch sees the old levels")
{
  OneWindow window(2);
  window.write(10.0, 1.5, 1);
  commit(*window.control);
  const auto before = window.levels();
  const auto epoch = window.control->epoch.load();
  window.write(20.0, 2.0, 2);

  commit(*window.control);

  CHECK(window.control->table(epoch).windows[0].working_slot == before.working_slot);
  CHECK(window.control->table(epoch).windows[0].committed[0].time == 1.5);
}

TEST_CASE("arming copies carried state and nothing else")
{
  OneWindow window(2);
  window.write(10.0, 1.5, 1);
  commit(*window.control);
  window.write(-1.0, 2.0, 2);

  arm(window.view, window.levels());

  CHECK(window.field(0, 0)[2] == 10.0);
  CHECK(window.field(1, 0)[2] == -1.0);
  CHECK(window.field(2, 0)[2] == -1.0);
}

TEST_CASE("poison fills what is not carried, and the first entry that still has it is named")
{
  OneWindow window(2);
  window.write(1.0, 1.5, 1);

  poison_working(window.view, window.levels());

  CHECK(window.field(0, 0)[0] == 1.0);
  CHECK(std::isnan(window.field(2, 0)[3]));
  std::fill_n(window.field(1, 0), 4, 2.0);
  std::fill_n(window.field(2, 0), 3, 2.0);
  CHECK(find_poison(window.view, window.levels()) == "output[0, 3]");
  window.field(2, 0)[3] = std::numeric_limits<double>::quiet_NaN(); // an own NaN is written, not poison
  CHECK_FALSE(find_poison(window.view, window.levels()).has_value());
}

TEST_CASE("sealing copies the working level to all levels")
{
  OneWindow window(4);
  window.write(7.0, 1.0, 0);

  seal(window.view, window.levels());

  for (int level = 1; level < 4; ++level) CHECK(window.field(1, level)[1] == 7.0);
}

TEST_CASE("a value that is not finite is found wherever it stands")
{
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()})
    for (const std::int64_t at : {0, 1, 511, 512, 1023, 1299}) {
      std::vector<double> values(1300, std::numeric_limits<double>::max());
      values[5] = -0.0;
      values[7] = std::numeric_limits<double>::denorm_min();
      CHECK(first_not_finite(values.data(), 1300) == -1);
      values[static_cast<std::size_t>(at)] = bad;
      CHECK(first_not_finite(values.data(), 1300) == at);
    }
}

TEST_CASE("the same with many chunks, prefetched or not, of several values the first")
{
  constexpr std::int64_t n = 70'001;
  for (const bool is_beyond_caches : {false, true}) {
    std::vector<double> values(n, 1.0);
    CHECK(first_not_finite(values.data(), n, is_beyond_caches) == -1);
    for (const std::int64_t at : {70'000, 65'536, 65'535, 8192, 8191, 0}) {
      values[static_cast<std::size_t>(at)] = std::numeric_limits<double>::quiet_NaN();
      CHECK(first_not_finite(values.data(), n, is_beyond_caches) == at);
    }
  }
}
