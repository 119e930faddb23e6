// The structure of the benchmarks of large states: a few points at the interface, and beside them a state of a chosen
// size that is carried from step to step, so that a step costs the copy that arms it and next to nothing else.
#include "echo.hpp"

namespace mullion::bench {

class StoreStructure final : public Echo {
public:
  struct Options {
    int nodes = 10;
    int megabytes = 1;
    static constexpr auto table()
    {
      return std::tuple{
          parameter("nodes", &Options::nodes, "1", "number of points", at_least(1)),
          parameter("megabytes", &Options::megabytes, "1", "size of the state in 10^6 bytes", at_least(1))};
    }
  };
  explicit StoreStructure(const Options& options)
      : Echo({options.nodes}, "wet", "velocity", "traction"), options_(options)
  {
  }

  static std::vector<FieldSpec> fields()
  {
    return {output("wet", "velocity", Location::node, vector, "m/s", "0.5 traction + 1"),
            state("store", "values", Location::node, doubles_per_node, "1", "nobody reads them")};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("wet", "traction", Location::node, vector, "Pa", "on the structure")};
  }

  void define(const TimeStep& initial) override
  {
    Echo::define(initial);
    make_window("store", {point_pane(Coordinates::Zero(3, nodes_per_megabyte * options_.megabytes))});
    field("store", "values").now().setOnes();
  }
  void attach() override
  {
    Echo::attach();
    values_ = field("store", "values");
  }
  void step(const TimeStep& step) override
  {
    Echo::step(step);
    values_.now()(0, 0) += 1.0; // or a lost copy would be the same as a good one
  }

private:
  // A kilobyte a node: the mesh is small beside it.
  static constexpr std::uint32_t doubles_per_node = 125;
  static constexpr Eigen::Index nodes_per_megabyte = 1000;

  Options options_;
  Field values_;
};

} // namespace mullion::bench

MULLION_PLUGIN(mullion::bench::StoreStructure, "structure", "store_structure", "benchmark structure, large state");
