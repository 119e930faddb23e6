#include "point_transfer.hpp"

#include <limits>

namespace mullion::point_transfer {

std::vector<FieldSpec> PointTransfer::fields()
{
  return {
      output("structure_side", "traction", Location::node, vector, "Pa", "acts on the structure"),
      output("fluid_side", "velocity", Location::node, vector, "m/s", "of the wall"),
      output("fluid_side", "displacement", Location::node, vector, "m", "of the wall; 0 if none is received"),
  };
}

std::vector<InputSpec> PointTransfer::inputs()
{
  return {
      receive("fluid_side", "traction", Location::element, vector, "Pa", "acts on the structure"),
      receive("structure_side", "velocity", Location::node, vector, "m/s", "of the wet surface").optional(),
      receive("structure_side", "displacement", Location::node, vector, "m", "of the wet surface").optional(),
  };
}

void PointTransfer::define(const TimeStep&)
{
  const auto fluid = peer_pane("fluid", ""), structure = peer_pane("structure", "");
  for (const auto* side : {&fluid, &structure})
    for (const auto& block : side->blocks)
      MULLION_REQUIRE(block.type == ElementType::point1, Errc::shape,
                      "it joins interfaces that consist of points; one side has lines or faces: use another transfer");
  make_window("fluid_side", {fluid});
  make_window("structure_side", {structure});
  field("structure_side", "traction").now().setZero();
  field("fluid_side", "velocity").now().setZero();
  field("fluid_side", "displacement").now().setZero();
}

void PointTransfer::attach()
{
  const auto fluid = pane("fluid_side"), structure = pane("structure_side");
  const auto n = fluid.coordinates.cols();
  MULLION_REQUIRE(n == structure.coordinates.cols(), Errc::shape,
                  "the fluid's interface has {} points, the structure's {}; they must be the same points", n,
                  structure.coordinates.cols());
  MULLION_REQUIRE(fluid.coordinates.rows() == structure.coordinates.rows(), Errc::shape,
                  "the fluid's interface has {} coordinates a node, the structure's {}", fluid.coordinates.rows(),
                  structure.coordinates.rows());
  structure_of_fluid_.assign(static_cast<std::size_t>(n), -1);
  std::vector<bool> is_taken(static_cast<std::size_t>(n), false);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index nearest = 0;
    const double gap2 =
        (structure.coordinates.colwise() - fluid.coordinates.col(i)).colwise().squaredNorm().minCoeff(&nearest);
    MULLION_REQUIRE(
        gap2 <= options_.gap_tolerance * options_.gap_tolerance, Errc::shape,
        "fluid point {} and the structure's nearest point {} lie {} m apart, more than gap_tolerance = {} m; "
        "check where the two interfaces lie",
        i, nearest, std::sqrt(gap2), options_.gap_tolerance);
    MULLION_REQUIRE(!is_taken[static_cast<std::size_t>(nearest)], Errc::shape,
                    "structure point {} is the nearest to two fluid points", nearest);
    is_taken[static_cast<std::size_t>(nearest)] = true;
    structure_of_fluid_[static_cast<std::size_t>(i)] = static_cast<Index>(nearest);
  }
  node_of_face_.clear();
  for (const auto& block : fluid.blocks)
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) node_of_face_.push_back(block.connectivity(0, e));
  traction_ = field("structure_side", "traction");
  velocity_ = field("fluid_side", "velocity");
  displacement_ = field("fluid_side", "displacement");
  received_traction_ = input("fluid_side", "traction");
  received_velocity_ = input("structure_side", "velocity");
  received_displacement_ = input("structure_side", "displacement");
}

void PointTransfer::loads(const TimeStep&)
{
  const auto from = received_traction_.newest();
  auto to = traction_.now();
  for (std::size_t face = 0; face < node_of_face_.size(); ++face)
    to.col(structure_of_fluid_[static_cast<std::size_t>(node_of_face_[face])]) =
        from.col(static_cast<Eigen::Index>(face));
}

void PointTransfer::motion(const TimeStep&)
{
  const auto carry = [&](const Input& received, const Field& result) {
    auto to = result.now();
    if (!received.is_connected()) {
      to.setZero();
      return;
    }
    const auto from = received.newest();
    for (std::size_t i = 0; i < structure_of_fluid_.size(); ++i)
      to.col(static_cast<Eigen::Index>(i)) = from.col(structure_of_fluid_[i]);
  };
  carry(received_velocity_, velocity_);
  carry(received_displacement_, displacement_);
}

} // namespace mullion::point_transfer
