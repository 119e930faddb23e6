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
  return apply(operators.load, traction);
}

Field loads_from_loads(const TransferOperators& operators, const SurfaceMesh& source, const FieldView& loads)
{
  if (operators.source_location == Location::faces) return loads_from_face_forces(operators.load, source, loads);
  if (operators.is_projection) return apply_transposed(operators.projection, loads);
  return loads_from_loads(operators.load, operators.source_mass, loads);
}

Field motion_of_source(const TransferOperators& operators, const FieldView& target_motion, Motion motion)
{
  // M_f^-1 (P^T M_f)^T = P: no system to solve, and no round-off of one.
  if (motion == Motion::interpolate || operators.is_projection) return apply(operators.projection, target_motion);
  return adjoint_motion(operators.nodal_load, operators.source_mass, target_motion);
}

} // namespace mullion::surface
