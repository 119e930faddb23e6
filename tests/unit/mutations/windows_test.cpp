// Damaged window objects: an error that names the window, or a view that never leads out of its object.
#include "mutations.hpp"
#include "windows.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <utility>
#include <vector>

using namespace mullion;
using namespace mullion::testing;

namespace {

void damage_windows(std::uint64_t count)
{
  std::vector<std::pair<std::string, std::vector<std::byte>>> samples;
  for (const auto& window : planned_windows()) samples.emplace_back(window.plan.name, window.write());
  for (auto& [name, object] : samples) REQUIRE(!is_refused(object, name));

  std::uint64_t n_refused = 0, n_accepted = 0;
  for_each_mutation(count, [&](Random& random) {
    const auto& [name, whole] = random.one_of(samples);
    auto object = whole;
    shm::WindowHeader header;
    std::memcpy(&header, object.data(), sizeof header);
    // most damage goes to the schema, some of it to the mesh; that to the slots' values is none of the layout's
    const std::size_t ends[] = {sizeof header, header.fixed_offset, header.slots_offset, object.size()};
    const auto end = random.one_of(ends);
    mutate(object, random.below(4) == 0 ? 8 : 64 * random.below(end / 64), end, random);
    if (random.below(4) != 0) seal(object);
    object.shrink_to_fit(); // so that the address sanitizer knows where it ends
    (is_refused(object, name) ? n_refused : n_accepted) += 1;
  });
  CHECK(n_refused > 0);
  CHECK(n_accepted > 0);
}

/// The text that refuses the window of this name, after `change` of its header, first pane and first block.
template <class Change> std::string refusal(const std::string& name, Change&& change)
{
  for (const auto& window : planned_windows()) {
    if (window.plan.name != name) continue;
    auto object = window.write();
    shm::WindowHeader header;
    shm::PaneRecord pane;
    shm::BlockRecord block{};
    std::memcpy(&header, object.data(), sizeof header);
    std::memcpy(&pane, object.data() + header.panes_offset, sizeof pane);
    if (header.n_blocks > 0) std::memcpy(&block, object.data() + header.blocks_offset, sizeof block);
    change(header, pane, block);
    std::memcpy(object.data(), &header, sizeof header);
    std::memcpy(object.data() + header.panes_offset, &pane, sizeof pane);
    if (header.n_blocks > 0) std::memcpy(object.data() + header.blocks_offset, &block, sizeof block);
    seal(object);
    try {
      (void)shm::WindowView(object.data(), object.size(), name);
    } catch (const Error& error) {
      return error.what();
    }
  }
  return "";
}

} // namespace

// What the damage below has found; each of these led outside of the object, or to numbers across their boundary.
TEST_CASE("sizes and offsets that no owner would write are refused, though the checksum is right")
{
  using shm::BlockRecord, shm::PaneRecord, shm::WindowHeader;
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };

  // 8 bytes times so many coordinates overflow 64 bits, and nothing at all seems to be needed
  CHECK(has(refusal("fluid/volume",
                    [](WindowHeader& header, PaneRecord& pane, BlockRecord&) {
                      header.dimension = 0x80000000;
                      pane.n_nodes = 0x40000000;
                    }),
            "the number of coordinates a node is 2147483648, expected 3"));
  CHECK(has(refusal("fluid/wall.in", [](WindowHeader&, PaneRecord& pane, BlockRecord&) { pane.n_elements = -1; }),
            "a pane's number of elements"));
  CHECK(
      has(refusal("fluid/volume", [](WindowHeader&, PaneRecord& pane, BlockRecord&) { pane.coordinates_offset += 4; }),
          "a pane's coordinates' offset"));
  CHECK(has(
      refusal("fluid/volume", [](WindowHeader&, PaneRecord&, BlockRecord& block) { block.connectivity_offset += 2; }),
      "a block's connectivity offset"));
}

TEST_CASE("a companion hands out no mesh")
{
  const auto windows = planned_windows();
  auto object = windows[3].write();
  const shm::WindowView view(object.data(), object.size(), "fluid/wall.in");
  std::vector<mullion_block> blocks;

  CHECK_THROWS_WITH_AS((void)view.pane(0, blocks),
                       "window fluid/wall.in: its pane 0 holds no mesh; a companion's mesh is that of the window it "
                       "belongs to",
                       Error);
}

TEST_CASE("a damaged window object is refused with its name, or leads nowhere outside of it") { damage_windows(4000); }

TEST_SUITE("full")
{
  TEST_CASE("40,000 damaged window objects are refused with their names, or lead nowhere outside of them")
  {
    damage_windows(40'000);
  }
}
