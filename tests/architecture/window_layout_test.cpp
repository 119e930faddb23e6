// docs/formats/window_layout.md says byte by byte what the structs of the shared memory are: members in their order,
// offsets and sizes, and the sizes of the whole.
#include "architecture/source_tree.hpp"

#include "shm/control.hpp"
#include "shm/window_layout.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <map>
#include <regex>
#include <string>
#include <vector>

using namespace mullion::shm;

// Control holds atomics, which are no aggregates of C; their offsets are what they are.
#pragma GCC diagnostic ignored "-Winvalid-offsetof"

namespace {

struct Member {
  std::string name;
  std::size_t offset, size;
  bool operator==(const Member&) const = default;
};
struct Layout {
  std::size_t size = 0;
  std::vector<Member> members;
};

std::string to_text(const Layout& layout)
{
  std::string text = std::to_string(layout.size) + " bytes:";
  for (const auto& m : layout.members)
    text += " " + m.name + "@" + std::to_string(m.offset) + "+" + std::to_string(m.size);
  return text;
}

/// "### Name: 40 bytes", then a table "| offset | size | `member` | …".
std::map<std::string, Layout> documented()
{
  static const std::regex heading(R"re(^### (\w+): (\d+) bytes$)re"), row(R"re(^\| (\d+) \| (\d+) \| `(\w+)` \|)re");
  std::map<std::string, Layout> layouts;
  Layout* current = nullptr;
  std::smatch match;
  for (const auto& line : mullion::test::lines_of("docs/formats/window_layout.md")) {
    if (line.rfind("#", 0) == 0) current = nullptr;
    if (std::regex_search(line, match, heading)) {
      current = &layouts[match[1]];
      current->size = std::stoul(match[2]);
    } else if (current != nullptr && std::regex_search(line, match, row)) {
      current->members.push_back({match[3], std::stoul(match[1]), std::stoul(match[2])});
    }
  }
  return layouts;
}

#define MEMBER(Type, member)                                                                                           \
  Member { #member, offsetof(Type, member), sizeof(Type::member) }

std::map<std::string, Layout> compiled()
{
  std::map<std::string, Layout> layouts;
  layouts["WindowHeader"] = {
      sizeof(WindowHeader),
      {MEMBER(WindowHeader, magic), MEMBER(WindowHeader, version), MEMBER(WindowHeader, generation),
       MEMBER(WindowHeader, n_panes), MEMBER(WindowHeader, n_blocks), MEMBER(WindowHeader, n_fields),
       MEMBER(WindowHeader, n_slots), MEMBER(WindowHeader, dimension), MEMBER(WindowHeader, reserved),
       MEMBER(WindowHeader, total_bytes), MEMBER(WindowHeader, panes_offset), MEMBER(WindowHeader, blocks_offset),
       MEMBER(WindowHeader, fields_offset), MEMBER(WindowHeader, fixed_offset), MEMBER(WindowHeader, fixed_bytes),
       MEMBER(WindowHeader, slots_offset), MEMBER(WindowHeader, slot_bytes), MEMBER(WindowHeader, schema_checksum),
       MEMBER(WindowHeader, name)}};
  layouts["PaneRecord"] = {sizeof(PaneRecord),
                           {MEMBER(PaneRecord, id), MEMBER(PaneRecord, n_nodes), MEMBER(PaneRecord, n_elements),
                            MEMBER(PaneRecord, coordinates_offset), MEMBER(PaneRecord, first_block),
                            MEMBER(PaneRecord, n_blocks)}};
  layouts["BlockRecord"] = {sizeof(BlockRecord),
                            {MEMBER(BlockRecord, element), MEMBER(BlockRecord, nodes_per_element),
                             MEMBER(BlockRecord, n_elements), MEMBER(BlockRecord, connectivity_offset)}};
  layouts["FieldRecord"] = {sizeof(FieldRecord),
                            {MEMBER(FieldRecord, name), MEMBER(FieldRecord, unit), MEMBER(FieldRecord, pane),
                             MEMBER(FieldRecord, location), MEMBER(FieldRecord, components), MEMBER(FieldRecord, role),
                             MEMBER(FieldRecord, nature), MEMBER(FieldRecord, carry), MEMBER(FieldRecord, scalar),
                             MEMBER(FieldRecord, storage), MEMBER(FieldRecord, entities), MEMBER(FieldRecord, offset),
                             MEMBER(FieldRecord, source_window), MEMBER(FieldRecord, source_field),
                             MEMBER(FieldRecord, policy), MEMBER(FieldRecord, reserved)}};
  layouts["Control"] = {sizeof(Control), {MEMBER(Control, magic),        MEMBER(Control, version),
                                          MEMBER(Control, bytes),        MEMBER(Control, run_name),
                                          MEMBER(Control, guard_pid),    MEMBER(Control, orchestrator_pid),
                                          MEMBER(Control, state),        MEMBER(Control, n_modules),
                                          MEMBER(Control, n_windows),    MEMBER(Control, replay),
                                          MEMBER(Control, step),         MEMBER(Control, n_steps),
                                          MEMBER(Control, time),         MEMBER(Control, current),
                                          MEMBER(Control, outcome_file), MEMBER(Control, orchestrator_asleep),
                                          MEMBER(Control, epoch),        MEMBER(Control, levels),
                                          MEMBER(Control, working),      MEMBER(Control, windows),
                                          MEMBER(Control, modules)}};
  layouts["LevelEntry"] = {
      sizeof(LevelEntry),
      {MEMBER(LevelEntry, working_slot), MEMBER(LevelEntry, n_slots), MEMBER(LevelEntry, committed)}};
  layouts["WorkingLevel"] = {
      sizeof(WorkingLevel),
      {MEMBER(WorkingLevel, stamp), MEMBER(WorkingLevel, is_written), MEMBER(WorkingLevel, reserved)}};
  layouts["WindowRecord"] = {sizeof(WindowRecord),
                             {MEMBER(WindowRecord, name), MEMBER(WindowRecord, owner), MEMBER(WindowRecord, module),
                              MEMBER(WindowRecord, fd), MEMBER(WindowRecord, generation), MEMBER(WindowRecord, bytes)}};
  layouts["CurrentCall"] = {sizeof(CurrentCall),
                            {MEMBER(CurrentCall, module), MEMBER(CurrentCall, operation), MEMBER(CurrentCall, function),
                             MEMBER(CurrentCall, reserved), MEMBER(CurrentCall, step), MEMBER(CurrentCall, time)}};
  layouts["ModuleRecord"] = {
      sizeof(ModuleRecord),
      {MEMBER(ModuleRecord, name), MEMBER(ModuleRecord, kind), MEMBER(ModuleRecord, plugin), MEMBER(ModuleRecord, path),
       MEMBER(ModuleRecord, is_inline), MEMBER(ModuleRecord, pid), MEMBER(ModuleRecord, reply_fd),
       MEMBER(ModuleRecord, incarnation), MEMBER(ModuleRecord, n_parameters), MEMBER(ModuleRecord, n_exchanged),
       MEMBER(ModuleRecord, parameters), MEMBER(ModuleRecord, text), MEMBER(ModuleRecord, exchanged),
       MEMBER(ModuleRecord, interface_window), MEMBER(ModuleRecord, histories), MEMBER(ModuleRecord, n_histories),
       MEMBER(ModuleRecord, request)}};
  layouts["ParameterRecord"] = {sizeof(ParameterRecord),
                                {MEMBER(ParameterRecord, real), MEMBER(ParameterRecord, integer),
                                 MEMBER(ParameterRecord, text_offset), MEMBER(ParameterRecord, reserved)}};
  layouts["Request"] = {sizeof(Request),
                        {MEMBER(Request, word), MEMBER(Request, operation), MEMBER(Request, function),
                         MEMBER(Request, incarnation), MEMBER(Request, epoch), MEMBER(Request, step),
                         MEMBER(Request, flags), MEMBER(Request, reserved), MEMBER(Request, arguments)}};
  layouts["Reply"] = {sizeof(Reply),
                      {MEMBER(Reply, magic), MEMBER(Reply, incarnation), MEMBER(Reply, reserved), MEMBER(Reply, word),
                       MEMBER(Reply, asleep), MEMBER(Reply, status), MEMBER(Reply, n_windows), MEMBER(Reply, work_ns),
                       MEMBER(Reply, results), MEMBER(Reply, windows), MEMBER(Reply, error)}};
  layouts["DefinedWindow"] = {sizeof(DefinedWindow),
                              {MEMBER(DefinedWindow, name), MEMBER(DefinedWindow, fd), MEMBER(DefinedWindow, n_slots),
                               MEMBER(DefinedWindow, bytes)}};
  layouts["Stamp"] = {sizeof(mullion_stamp),
                      {MEMBER(mullion_stamp, time), MEMBER(mullion_stamp, step), MEMBER(mullion_stamp, iteration),
                       MEMBER(mullion_stamp, kind)}};
  return layouts;
}

} // namespace

TEST_CASE("the documented layout of the shared memory is the compiled one")
{
  const auto document = documented();
  const auto code = compiled();

  CHECK(document.size() == code.size());
  for (const auto& [name, layout] : code) {
    REQUIRE_MESSAGE(document.count(name) == 1, name, " has no table");
    CHECK_MESSAGE(to_text(document.at(name)) == to_text(layout), name);
  }
}
