#include "stretch_1d.hpp"

#include "stretch.hpp"

namespace mullion::stretch_1d {

std::vector<FieldSpec> Stretch1d::fields()
{
  return {
      output("volume", "velocity", Location::node, vector, "m/s", "of the mesh"),
      fixed("wall", "volume_node", Location::node, scalar, "1", "number of the wall's node in volume").integer(),
  };
}

std::vector<InputSpec> Stretch1d::inputs()
{
  return {receive("wall", "velocity", Location::node, vector, "m/s", "of the wall")};
}

void Stretch1d::define(const TimeStep&)
{
  const auto volume = peer_pane("fluid", "volume");
  const auto wall = peer_pane("fluid", "");
  MULLION_REQUIRE(volume.coordinates.rows() == 1 && wall.coordinates.cols() == 1, Errc::shape,
                  "it moves 1D meshes with one wall point; the fluid has {} dimensions and {} wall nodes",
                  volume.coordinates.rows(), wall.coordinates.cols());
  make_window("volume", {volume});
  make_window("wall", {wall});
  field("wall", "volume_node").index_now() = peer_indices("fluid", "", "volume_node");
  field("volume", "velocity").now().setZero();
}

void Stretch1d::attach()
{
  const auto mesh = pane("volume");
  const auto n = static_cast<std::size_t>(mesh.coordinates.cols());
  const auto wall_node = static_cast<std::size_t>(field("wall", "volume_node").indices()(0, 0));
  MULLION_REQUIRE(wall_node == 0 || wall_node == n - 1, Errc::shape,
                  "the wall is node {} of {}, expected an end of the line", wall_node, n);
  xi_.resize(n);
  relative_positions({mesh.coordinates.data(), n}, wall_node == 0 ? n - 1 : 0, wall_node, xi_);
  velocity_ = field("volume", "velocity");
  wall_velocity_ = input("wall", "velocity");
}

void Stretch1d::step(const TimeStep& step) { stretch(xi_, wall_velocity_.at(step.end)(0, 0), flat(velocity_.now())); }

} // namespace mullion::stretch_1d
