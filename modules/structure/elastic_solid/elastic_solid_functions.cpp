// What others may ask of the module by name: its largest step, its frequencies, what a duct takes from them, its mesh.
#include "elastic_solid.hpp"

#include "files/file_error.hpp"
#include "files/hand_out.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace mullion::elastic_solid {

double ElasticSolid::max_dt()
{
  if (!is_explicit()) return std::numeric_limits<double>::max();
  if (!critical_step_) critical_step_ = 2.0 / highest_frequency(system_, mass_solver());
  return *critical_step_ * options_.substeps;
}

Modes ElasticSolid::modes_to(double mode, const char* function)
{
  MULLION_REQUIRE(mode >= 1.0 && mode == std::floor(mode) && mode <= static_cast<double>(system_.free.size()),
                  Errc::config, "{}({}): modes are numbered from 1 to {}", function, mode, system_.free.size());
  const int k = static_cast<int>(mode);
  auto found = k <= modes().angular_frequencies.size() ? modes() : lowest_modes(system_, k);
  MULLION_REQUIRE(k <= found.angular_frequencies.size(), Errc::numeric, "{}({}): the modal analysis did not converge",
                  function, mode);
  return found;
}

double ElasticSolid::frequency(double mode)
{
  return modes_to(mode, "frequency").angular_frequencies[static_cast<int>(mode) - 1] / (2.0 * std::numbers::pi);
}

double ElasticSolid::vacuum_frequency(double step)
{
  const double hertz = frequency(1), omega = 2.0 * std::numbers::pi * hertz;
  if (is_static()) return hertz;
  return numerical_frequency(omega, step / options_.substeps, newmark_parameters()) / (2.0 * std::numbers::pi);
}

double ElasticSolid::write_mesh(double file)
{
  try {
    return mesh_files::write_mesh_to(options_.mesh, 0, file);
  } catch (const mesh_files::FileError& error) {
    throw Error(Errc::io, error.what());
  }
}

double ElasticSolid::list_boundaries(double file)
{
  try {
    return mesh_files::list_boundaries_to(options_.mesh, 0, file);
  } catch (const mesh_files::FileError& error) {
    throw Error(Errc::io, error.what());
  }
}

Radiation ElasticSolid::radiation(const char* function, double mode, const Duct& duct)
{
  MULLION_REQUIRE(solid_.dimension() == 2, Errc::config, "{}: the duct is one of the plane, the body is in 3D",
                  function);
  MULLION_REQUIRE(duct.height > 0.0 && duct.density > 0.0 && duct.sound_speed > 0.0 &&
                      std::abs(duct.speed) < duct.sound_speed,
                  Errc::config,
                  "{}: a duct of height {} m, speed {} m/s, density {} kg/m^3, speed of sound {} m/s; height, density "
                  "and speed of sound are above 0, and the flow is slower than sound",
                  function, duct.height, duct.speed, duct.density, duct.sound_speed);
  const auto found = modes_to(mode, function);
  const auto k = static_cast<Eigen::Index>(mode) - 1;
  MULLION_REQUIRE(found.angular_frequencies[k] > 0.0, Errc::config, "{}({}): that is a rigid motion", function, mode);
  const Eigen::MatrixXd nodes = solid_.nodes(Eigen::all, wet_nodes_);
  const auto wall =
      wall_of(nodes, wet_surface_, found.shapes.col(k).reshaped(2, solid_.n_nodes())(Eigen::all, wet_nodes_));
  MULLION_REQUIRE(!wall.empty(), Errc::config,
                  "{}: the wet surface is no floor: there it is upright, and its displacement along y unbounded",
                  function);
  return duct_radiation(wall, solid_.thickness, found.angular_frequencies[k], duct);
}

double ElasticSolid::radiation_rate(double mode, double height, double speed, double density, double sound_speed)
{
  return radiation("radiation_rate", mode, {height, speed, density, sound_speed}).growth;
}

double ElasticSolid::radiation_shift(double mode, double height, double speed, double density, double sound_speed)
{
  return radiation("radiation_shift", mode, {height, speed, density, sound_speed}).shift;
}

} // namespace mullion::elastic_solid
