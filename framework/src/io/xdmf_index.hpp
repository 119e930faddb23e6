// The text of results.xdmf, which tells ParaView how the datasets of mesh.h5 and of each output's file form grids.
// An output's grids are described once per arrangement of fields (a layout, with the step and the time left
// open) and every output of the same arrangement shares it, so that the index stays small in memory and its
// text depends on the list of outputs alone.
#pragma once

#include "io/snapshot.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace mullion::io {

/// "pane_<id>" of a window, with the window's name before it: the group in every results file.
[[nodiscard]] std::string pane_group(const WindowData& window, const PaneData& pane);

/// The name of an output: its step with at least nine digits, so that names sort as steps do.
[[nodiscard]] std::string output_name(std::int64_t step);

/// The outputs of an index as plain data, for a checkpoint: as many steps, times and layouts, and the few texts that
/// these number.
struct OutputList {
  std::vector<std::int64_t> steps;
  std::vector<double> times;
  std::vector<std::int64_t> layouts;
  std::vector<std::string> texts;
};

class XdmfIndex {
public:
  /// The meshes and the fixed fields of all later outputs.
  void set_mesh(const std::vector<WindowData>& windows);

  /// Append an output. `windows` are those of set_mesh, with the fields of this output.
  void add(std::int64_t step, double time, const std::vector<WindowData>& windows);
  void remove_last() { outputs_.pop_back(); }

  [[nodiscard]] OutputList list() const;
  /// @throws Error Errc::io: the lists differ in length, or number a layout that is not there
  void restore(const OutputList& list);

  struct Output {
    std::int64_t step;
    double time;
    const std::string* layout;
  };
  [[nodiscard]] const std::vector<Output>& outputs() const { return outputs_; }
  template <class Keep> void keep_if(Keep keep) { std::erase_if(outputs_, std::not_fn(keep)); }

  /// The whole file.
  [[nodiscard]] std::string text() const;

private:
  const std::string* intern(std::string layout);

  std::map<std::string, std::string> fixed_; ///< by pane group: topology and the fixed fields' attributes
  std::map<std::string, int> layouts_;       ///< the keys are the layouts; nodes of a map stay where they are
  std::vector<Output> outputs_;
};

} // namespace mullion::io
