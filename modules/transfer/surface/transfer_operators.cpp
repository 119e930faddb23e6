#include "transfer_operators.hpp"

#include <utility>

namespace mullion::surface {

TransferOperators operators_of_projection(const SurfaceMesh& source, const SurfaceMesh& target, Operator projection,
                                          Location source_location, SourceMass source_mass)
{
  TransferOperators result;
  result.source_location = source_location;
  result.is_projection = true;
  result.nodal_load = projected_load_operator(source, projection, Location::nodes);
  result.load = source_location == Location::nodes ? result.nodal_load
                                                   : projected_load_operator(source, projection, source_location);
  result.projection = std::move(projection);
  if (source_mass == SourceMass::factorised) result.source_mass = mass_matrix(native_mass(source));
  result.target_mass = mass_matrix(native_mass(target));
  return result;
}

void add_rigid_links(TransferOperators& operators, const SurfaceMesh& source, const SurfaceMesh& target,
                     const FaceTree& target_tree)
{
  const auto& p = operators.projection;
  const auto forces = operators.source_location == Location::nodes ? native_mass(source) : face_split(source);
  operators.load_link = link_of_forces(source, target, target_tree, p, forces);
  operators.motion_link = link_of_nodes(source, target, target_tree, p);
}

TransferOperators operators_of_points(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                                      const PointSet& set, Location source_location, MassMetric mass,
                                      SourceMass source_mass)
{
  TransferOperators result;
  result.source_location = source_location;
  result.nodal_load = load_operator(source, target, set.points, Location::nodes);
  result.load = source_location == Location::nodes ? result.nodal_load
                                                   : load_operator(source, target, set.points, source_location);
  result.projection = node_projection(source, target, target_tree);
  const bool is_same = mass == MassMetric::same;
  if (source_mass == SourceMass::factorised)
    result.source_mass = mass_matrix(is_same ? surface::source_mass(source, set.points) : native_mass(source));
  result.target_mass = mass_matrix(is_same ? target_mass(target, set.points) : native_mass(target));
  return result;
}

Field loads_from_traction(const TransferOperators& operators, const FieldView& traction)
{
  Field loads = apply(operators.load, traction);
  if (!operators.load_link.is_empty()) operators.load_link.add_loads(traction, loads);
  return loads;
}

Field loads_from_loads(const TransferOperators& operators, const SurfaceMesh& source, const FieldView& loads)
{
  if (operators.source_location == Location::faces)
    return loads_from_traction(operators, traction_of_face_forces(source, loads));
  if (!operators.is_projection) return loads_from_traction(operators, solve(operators.source_mass, loads));
  Field result = apply_transposed(operators.projection, loads);
  if (!operators.motion_link.is_empty()) operators.motion_link.add_loads(loads, result);
  return result;
}

Field motion_of_source(const TransferOperators& operators, const FieldView& target_motion, Motion motion)
{
  // M_f^-1 (P^T M_f)^T = P: no system to solve, and no round-off of one.
  if (motion == Motion::interpolate || operators.is_projection) {
    Field result = apply(operators.projection, target_motion);
    if (!operators.motion_link.is_empty()) operators.motion_link.add_motion(target_motion, result);
    return result;
  }
  if (operators.nodal_link.is_empty())
    return adjoint_motion(operators.nodal_load, operators.source_mass, target_motion);
  Field weighted = apply_transposed(operators.nodal_load, target_motion);
  operators.nodal_link.add_motion(target_motion, weighted);
  return solve(operators.source_mass, weighted);
}

} // namespace mullion::surface
