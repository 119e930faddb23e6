// A fluid without physics on any mesh in two or three dimensions: its nodes go where the mesh motion sends them, and it
// pulls at nothing. For tests of mesh motions in a run.
#include "files/read.hpp"

#include <mullion/sdk/plugin.hpp>

#include <map>
#include <vector>

namespace mullion::test {

class CarriedMeshFluid final : public Module {
public:
  struct Options {
    std::string mesh = "box_arch:34x16";
    std::string wall = "shell";
    static constexpr auto table()
    {
      return std::tuple{parameter("mesh", &Options::mesh, "", "a file or a generator's text"),
                        parameter("wall", &Options::wall, "", "the group that is the wall")};
    }
  };
  explicit CarriedMeshFluid(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields()
  {
    using enum Location;
    return {state("volume", "coordinates", node, vector, "m", "where the nodes are"),
            output("volume", "distance", pane, scalar, "m", "largest of any node from its reference place"),
            output("wall", "traction", element, vector, "Pa", "none"),
            output("wall", "work", pane, scalar, "J", "none"),
            output("wall", "impulse", pane, vector, "N s", "none"),
            fixed("wall", "volume_node", node, scalar, "1", "number of the node in volume").integer()};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("volume", "velocity", Location::node, vector, "m/s", "of the nodes")};
  }

  void define(const TimeStep&) override
  {
    const auto mesh = mesh_files::read_or_generate(options_.mesh);
    Pane volume{0, mesh.nodes, {}};
    for (const auto& [shape, connectivity] : mesh.blocks)
      if (mesh_files::facts(shape).dimension == mesh.dimension)
        volume.blocks.push_back({static_cast<ElementType>(shape), connectivity}); // the numbers are the same
    make_window("volume", {volume});

    const auto surface = mesh_files::interface_of(mesh, options_.wall);
    Pane wall{0, surface.nodes, {}};
    for (const auto& [shape, connectivity] : surface.blocks)
      wall.blocks.push_back({static_cast<ElementType>(shape), connectivity});
    make_window("wall", {wall});
    std::map<std::int64_t, Index> place;
    for (std::size_t i = 0; i < mesh.node_numbers.size(); ++i) place[mesh.node_numbers[i]] = static_cast<Index>(i);
    auto volume_node = field("wall", "volume_node").index_now();
    for (std::size_t k = 0; k < surface.node_numbers.size(); ++k)
      volume_node(0, static_cast<Eigen::Index>(k)) = place.at(surface.node_numbers[k]);

    field("volume", "coordinates").now() = mesh.nodes;
    field("volume", "distance").now().setZero();
    for (const char* none : {"traction", "work", "impulse"}) field("wall", none).now().setZero();
  }
  void attach() override
  {
    reference_ = pane("volume").coordinates;
    coordinates_ = field("volume", "coordinates");
    distance_ = field("volume", "distance");
    velocity_ = input("volume", "velocity");
    for (const char* name : {"traction", "work", "impulse"}) nothing_.push_back(field("wall", name));
  }
  void step(const TimeStep& step) override
  {
    auto x = coordinates_.now();
    x += step.dt * velocity_.at(step.end);
    distance_.now()(0, 0) = (x - reference_).colwise().norm().maxCoeff();
    for (const auto& nothing : nothing_) nothing.now().setZero();
  }

private:
  Options options_;
  Coordinates reference_; ///< derived from the window's pane
  Field coordinates_, distance_;
  std::vector<Field> nothing_;
  Input velocity_;
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::CarriedMeshFluid, "fluid", "carried_mesh_fluid",
               "test fluid: a mesh that is carried along");
