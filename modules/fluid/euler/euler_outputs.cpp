// What the module exports at the end of a step: primitive variables in the cells, tractions, loads and sums on the
// wall.
#include "euler.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler {

void Euler::write_outputs(const TimeStep&, const StepSums& sums, const NodeArray& wall_velocity)
{
  const auto coordinates = coordinates_.values();
  const auto& mesh = solver_->mesh();
  auto density = density_.now(), velocity = velocity_.now(), pressure = pressure_.now(), mach = mach_.now();
  const NodeArray nodes = coordinates;
  const bool is_placed = placed_.cols() == nodes.cols(); // the solver's geometry is that of these nodes
  for (std::size_t c = 0; c < mesh.n_cells; ++c) {
    const Index e = mesh.order[c];
    const double area = is_placed ? solver_->geometry().volume[c] : cell_shape(mesh, nodes, c).volume; // the same bits
    const auto w = primitive<2>(scheme_.gas, amounts_[c], area);
    density(0, e) = w[0];
    velocity(0, e) = w[1];
    velocity(1, e) = w[2];
    pressure(0, e) = w[3];
    mach(0, e) = std::sqrt(square_of_velocity<2>(w)) / euler::sound_speed<2>(scheme_.gas, w);
  }
  const auto mass = mass_.values(), energy = energy_.values();
  double total_mass = 0.0, total_energy = 0.0;
  for (Eigen::Index e = 0; e < mass.cols(); ++e) {
    total_mass += mass(0, e);
    total_energy += energy(0, e);
  }
  total_mass_.now()(0, 0) = total_mass;
  total_energy_.now()(0, 0) = total_energy;
  max_cfl_.now()(0, 0) = sums.courant;
  if (options_.time_stepping != "local" || sums.courant == 0.0) residual_.now()(0, 0) = sums.courant == 0.0 ? 1.0 : 0.0;

  const auto faces = wall_faces<2>(mesh, scheme_, amounts_, nodes, wall_velocity, wall_faces_);
  auto traction = traction_.now(), traction_mean = traction_mean_.now(), wall_pressure = wall_pressure_.now(),
       normal = normal_.now(), gradient = pressure_gradient_.now(), sound = sound_speed_.now(),
       spacing = wall_spacing_.now(), nodal = nodal_traction_.now(), nodal_mean = nodal_traction_mean_.now(),
       load = load_.now(), load_mean = load_mean_.now();
  nodal.setZero();
  nodal_mean.setZero();
  load.setZero();
  load_mean.setZero();
  std::vector<double> length(static_cast<std::size_t>(load.cols()), 0.0);
  Vec<2> force = Vec<2>::Zero();
  const auto volume_node = field("wall", "volume_node").indices();
  const auto wall_node = [&](Index node) {
    return std::lower_bound(volume_node.data(), volume_node.data() + volume_node.size(), node) - volume_node.data();
  };
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& face = faces[f];
    const auto e = static_cast<Eigen::Index>(f);
    const Vec<2> n = face.area.normalized();
    const double mean = sums.mean_pressure.empty() ? face.pressure : sums.mean_pressure[f];
    traction.col(e) = (face.pressure - options_.reference_pressure) * n;
    traction_mean.col(e) = (mean - options_.reference_pressure) * n;
    wall_pressure(0, e) = face.pressure;
    normal.col(e) = n;
    gradient(0, e) = options_.gradient == "cell" ? face.cell_gradient : face.gradient;
    sound(0, e) = face.sound_speed;
    spacing(0, e) = 2.0 * face.distance;
    const double size = face.area.norm();
    force += size * traction.col(e);
    for (const Index node : mesh.boundary_nodes(wall_faces_[f])) {
      const auto i = wall_node(node);
      load.col(i) += 0.5 * size * traction.col(e);
      load_mean.col(i) += 0.5 * size * traction_mean.col(e);
      nodal.col(i) += size * traction.col(e);
      nodal_mean.col(i) += size * traction_mean.col(e);
      length[static_cast<std::size_t>(i)] += size;
    }
  }
  for (Eigen::Index i = 0; i < load.cols(); ++i) {
    nodal.col(i) /= length[static_cast<std::size_t>(i)];
    nodal_mean.col(i) /= length[static_cast<std::size_t>(i)];
  }
  force_.now().col(0) = force;
  impulse_.now().col(0) = sums.impulse;
  work_.now()(0, 0) = sums.work;
}

} // namespace mullion::euler
