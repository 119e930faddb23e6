#include "shm/window_layout.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <cstring>
#include <vector>

using namespace mullion;
using namespace mullion::shm;

namespace {

/// A mixed pane: one quadrilateral and one triangle on five nodes in 2D, and a pane of two points.
struct Example {
  std::vector<double> coordinates{0, 0, 1, 0, 1, 1, 0, 1, 2, 0.5};
  std::vector<std::int32_t> quadrilateral{0, 1, 2, 3}, triangle{1, 4, 2}, points{0, 1};
  std::vector<mullion_block> blocks{{MULLION_QUADRILATERAL4, 4, 1, quadrilateral.data()},
                                    {MULLION_TRIANGLE3, 3, 1, triangle.data()}};
  std::vector<mullion_block> point_block{{MULLION_POINT1, 1, 2, points.data()}};
  WindowPlan plan;

  Example()
  {
    plan.name = "fluid/volume";
    plan.dimension = 2;
    plan.n_slots = 3;
    plan.panes = {{7, 5, 2, coordinates.data(), blocks.data(), 2, 2},
                  {8, 2, 2, coordinates.data(), point_block.data(), 1, 2}};
    auto& velocity = plan.fields.emplace_back();
    velocity.name = "velocity";
    velocity.unit = "m/s";
    velocity.components = 2;
    velocity.entities = 5;
    auto& pressure = plan.fields.emplace_back();
    pressure.name = "pressure";
    pressure.unit = "Pa";
    pressure.location = MULLION_ELEMENT;
    pressure.role = MULLION_OUTPUT;
    pressure.entities = 2;
    auto& numbers = plan.fields.emplace_back();
    numbers.name = "numbers";
    numbers.unit = "1";
    numbers.pane = 1;
    numbers.role = MULLION_FIXED;
    numbers.scalar = MULLION_I32;
    numbers.storage = Storage::fixed;
    numbers.entities = 2;
  }
  [[nodiscard]] std::vector<std::byte> write() const
  {
    // 64-byte alignment inside the object is relative to its start; over-allocate a page for the start itself
    std::vector<std::byte> memory(window_bytes(plan));
    write_window(plan, memory.data(), memory.size());
    return memory;
  }
};

} // namespace

TEST_CASE("a window comes back as it was written: panes, mixed elements, fields, slots")
{
  const Example example;
  auto memory = example.write();

  const WindowView view(memory.data(), memory.size(), "fluid/volume");

  CHECK(view.header().n_slots == 3);
  REQUIRE(view.panes().size() == 2);
  std::vector<mullion_block> blocks;
  const auto pane = view.pane(0, blocks);
  CHECK(pane.id == 7);
  CHECK(std::memcmp(pane.coordinates, example.coordinates.data(), 10 * sizeof(double)) == 0);
  REQUIRE(blocks.size() == 2);
  CHECK(blocks[1].element == MULLION_TRIANGLE3);
  CHECK(blocks[1].connectivity[1] == 4);
  REQUIRE(view.find_field(0, "velocity") == 0);
  CHECK(view.find_field(1, "velocity") == -1);
  const auto& velocity = view.fields()[0];
  CHECK(velocity.offset % 64 == 0);
  CHECK(view.data(velocity, 1) - view.data(velocity, 0) == static_cast<std::ptrdiff_t>(view.header().slot_bytes));
  CHECK(view.header().slot_bytes % 4096 == 0);
  CHECK(view.header().slots_offset % 4096 == 0);
}

TEST_CASE("the object is exactly as large as its layout")
{
  const Example example;

  CHECK(example.write().size() == window_bytes(example.plan));
}

TEST_CASE("every damaged byte of a schema is noticed")
{
  const Example example;
  auto memory = example.write();
  const auto schema = WindowView(memory.data(), memory.size(), "fluid/volume").header().fixed_offset;

  for (std::size_t i = 0; i < schema; ++i) {
    memory[i] ^= std::byte{0x5a};
    CHECK_THROWS_AS(WindowView(memory.data(), memory.size(), "fluid/volume"), Error);
    memory[i] ^= std::byte{0x5a};
  }
}

TEST_CASE("a truncated, foreign or misnamed object is refused with the reason")
{
  const Example example;
  auto memory = example.write();
  const auto message_of = [&](std::size_t bytes, const char* name) -> std::string {
    try {
      (void)WindowView(memory.data(), bytes, name);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };

  CHECK(message_of(100, "fluid/volume").find("the size is 100") != std::string::npos);
  CHECK(message_of(memory.size() - 4096, "fluid/volume").find("the recorded size") != std::string::npos);
  CHECK(message_of(memory.size(), "fluid/wall").find("the name") != std::string::npos);
  memory[0] = std::byte{0};
  CHECK(message_of(memory.size(), "fluid/volume").find("the magic number") != std::string::npos);
}

TEST_CASE("a connectivity that leads outside of the pane is refused")
{
  Example example;
  example.triangle[1] = 5; // there are nodes 0 to 4

  auto memory = example.write();

  CHECK_THROWS_AS(WindowView(memory.data(), memory.size(), "fluid/volume"), Error);
}

TEST_CASE("names that are too long and windows that are too large are refused")
{
  Example example;

  example.plan.name = std::string(64, 'x');
  CHECK_THROWS_AS(window_bytes(example.plan), Error);
  example.plan.name = "fluid/volume";
  example.plan.fields[0].entities = INT64_C(1) << 59;
  CHECK_THROWS_AS(window_bytes(example.plan), Error);
}
