// A folder of its own for a test, and a small run's windows to write.
#pragma once

#include "io/snapshot.hpp"

#include <mullion/sdk/mesh.hpp>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace mullion::testing {

class Scratch {
public:
  Scratch()
  {
    // in memory where that is to be had: the writers sync every file, and a disk takes milliseconds for each
    const bool has_memory = ::access("/dev/shm", W_OK | X_OK) == 0;
    const auto base = has_memory ? std::filesystem::path("/dev/shm") : std::filesystem::temp_directory_path();
    std::string pattern = (base / "mullion-run-io-XXXXXX").string();
    const char* const made = ::mkdtemp(pattern.data());
    MULLION_REQUIRE(made != nullptr, Errc::io, "no scratch folder {}", pattern);
    path_ = made;
  }
  ~Scratch()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
  std::filesystem::path path_;
};

/// Three windows: a 1D gas column, a 2D pane of mixed elements (a quadrilateral, a triangle, a line, a point), and a
/// 3D pane with one element of each solid type; a fourth without nodes.
struct SmallRun {
  std::vector<double> column_x{0.0, 0.5, 1.0};
  std::vector<std::int32_t> column_lines{0, 1, 1, 2};
  std::vector<double> column_now{0.0, 0.625, 1.25}, pressure{1e5, 1.5e5}, energy{42.0};

  std::vector<double> plate_x{0, 0, 1, 0, 1, 1, 0, 1, 2, 0};
  std::vector<std::int32_t> quadrilateral{0, 1, 2, 3}, triangle{1, 4, 2}, line{0, 4}, point{3};
  std::vector<double> displacement{0, 0, 0.5, 0, 0.5, 0.25, 0, 0, 0, 1},
      stress{11, 12, 13, 14, 21, 22, 23, 24, 31, 32, 33, 34, 41, 42, 43, 44};
  std::vector<std::int32_t> tag{7, 8, 9, 10};

  // a unit cube (0-7), a pyramid on its top (8), a prism at its side (9, 10), a tetrahedron beyond (11)
  std::vector<double> solid_x{0, 0, 0, 1, 0, 0, 1,   1,   0, 0, 1, 0, 0, 0, 1, 1, 0, 1,
                              1, 1, 1, 0, 1, 1, 0.5, 0.5, 2, 2, 0, 0, 2, 1, 0, 3, 0, 0};
  std::vector<std::int32_t> hexahedron{0, 1, 2, 3, 4, 5, 6, 7}, pyramid{4, 5, 6, 7, 8}, prism{1, 9, 5, 2, 10, 6},
      tetrahedron{9, 11, 10, 5};
  std::vector<double> velocity = std::vector<double>(36, 0.5);

  [[nodiscard]] std::vector<io::WindowData> mesh() const
  {
    const auto block = [](std::uint32_t element, const std::vector<std::int32_t>& nodes) {
      const auto n = nodes_per_element(element);
      return mullion_block{element, n, static_cast<std::int64_t>(nodes.size() / n), nodes.data()};
    };
    io::PaneData column{0, 1, 3, 2, column_x.data(), {block(MULLION_LINE2, column_lines)}, {}};
    io::PaneData plate{4,
                       2,
                       5,
                       4,
                       plate_x.data(),
                       {block(MULLION_QUADRILATERAL4, quadrilateral), block(MULLION_TRIANGLE3, triangle),
                        block(MULLION_LINE2, line), block(MULLION_POINT1, point)},
                       {{"tag", "1", "which part", MULLION_ELEMENT, 1, 4, nullptr, tag.data()}}};
    io::PaneData solid{1,
                       3,
                       12,
                       4,
                       solid_x.data(),
                       {block(MULLION_HEXAHEDRON8, hexahedron), block(MULLION_PYRAMID5, pyramid),
                        block(MULLION_PRISM6, prism), block(MULLION_TETRAHEDRON4, tetrahedron)},
                       {}};
    io::PaneData nothing{0, 3, 0, 0, nullptr, {}, {}};
    return {{"fluid/volume", {column}},
            {"structure/plate", {plate}},
            {"structure/solid", {solid}},
            {"driver/state", {nothing}}};
  }

  [[nodiscard]] std::vector<io::WindowData> fields() const
  {
    auto windows = mesh();
    windows[0].panes[0].fields = {
        {"coordinates", "m", "where the nodes are", MULLION_NODE, 1, 3, column_now.data(), nullptr},
        {"pressure", "Pa", {}, MULLION_ELEMENT, 1, 2, pressure.data(), nullptr},
        {"energy", "J", {}, MULLION_PANE, 1, 1, energy.data(), nullptr}};
    windows[1].panes[0].fields = {{"displacement", "m", {}, MULLION_NODE, 2, 5, displacement.data(), nullptr},
                                  {"stress", "Pa", {}, MULLION_ELEMENT, 4, 4, stress.data(), nullptr}};
    windows[2].panes[0].fields = {{"velocity", "m/s", {}, MULLION_NODE, 3, 12, velocity.data(), nullptr}};
    return windows;
  }
};

} // namespace mullion::testing
