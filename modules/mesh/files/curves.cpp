// Curves and the surfaces that are images of a grid.
#include "file_error.hpp"
#include "generators.hpp"
#include "grid.hpp"
#include "raw_mesh.hpp"

#include <cmath>
#include <numbers>

namespace mullion::mesh_files {
namespace {

void check_positive(double value, const char* what)
{
  if (!(value > 0.0) || !std::isfinite(value)) throw FileError(join(what, " is ", value, "; it is above 0"));
}

} // namespace

MeshFile polyline(int n, const std::function<Eigen::VectorXd(double s)>& function)
{
  check_cells({n});
  RawMesh raw;
  const auto dimension = function(0.0).size();
  for (int i = 0; i <= n; ++i) add_grid_node(raw, function(static_cast<double>(i) / n));
  for (Index i = 0; i < n; ++i) add_element(raw, Shape::line2, std::array{i, i + 1});
  return finished(std::move(raw), static_cast<int>(dimension));
}

MeshFile line(int n, const Eigen::VectorXd& from, const Eigen::VectorXd& to)
{
  if (from.size() != to.size() || from.size() < 1 || from.size() > 3)
    throw FileError(join("a line from a point of ", from.size(), " coordinates to one of ", to.size(),
                         "; both have the same number, 1 to 3"));
  if (from == to) throw FileError("a line ends where it begins; its ends are two points");
  return polyline(n, [&](double s) -> Eigen::VectorXd { return (1.0 - s) * from + s * to; });
}

MeshFile arc(int n, double radius, double from, double angle, const Eigen::Vector2d& centre)
{
  check_positive(radius, "the radius of an arc");
  if (!(std::abs(angle) > 0.0 && std::abs(angle) < 2.0 * std::numbers::pi))
    throw FileError(join("an arc over ", angle, " rad; it is not 0 and less than a full circle"));
  return polyline(n, [&](double s) -> Eigen::VectorXd {
    const double a = from + s * angle;
    return centre + radius * Eigen::Vector2d(std::cos(a), std::sin(a));
  });
}

MeshFile surface(const Grid& grid, const std::function<Eigen::Vector3d(double s, double t)>& function)
{
  const auto st = unit_grid({grid.n, grid.m}, grid.perturb);
  RawMesh raw;
  for (const auto& at : st) add_grid_node(raw, function(at[0], at[1]));
  add_grid_cells(raw, grid.n, grid.m, grid.cells);
  return finished(std::move(raw), 3);
}

MeshFile rectangle(const Grid& grid, double length_x, double length_y, const Eigen::Vector3d& origin)
{
  check_positive(length_x, "the length of a rectangle");
  check_positive(length_y, "the width of a rectangle");
  return surface(grid, [&](double s, double t) -> Eigen::Vector3d {
    return origin + Eigen::Vector3d(s * length_x, t * length_y, 0.0);
  });
}

MeshFile spherical_cap(int n, int m, Cells cells, double radius, double angle)
{
  check_cells({n, m});
  check_positive(radius, "the radius of a cap");
  if (m < 3) throw FileError(join("a cap of ", m, " cells around; there are at least 3"));
  if (!(angle > 0.0 && angle < std::numbers::pi))
    throw FileError(join("a cap of the angle ", angle, " rad; it is between 0 and pi"));
  RawMesh raw;
  add_grid_node(raw, Eigen::Vector3d(0.0, 0.0, radius));
  for (int ring = 1; ring <= n; ++ring)
    for (int j = 0; j < m; ++j) {
      const double polar = angle * ring / n, around = 2.0 * std::numbers::pi * j / m;
      add_grid_node(raw, radius * Eigen::Vector3d(std::sin(polar) * std::cos(around),
                                                  std::sin(polar) * std::sin(around), std::cos(polar)));
    }
  const auto node = [&](int ring, int j) { return static_cast<Index>(1 + (ring - 1) * m + j % m); };
  for (int j = 0; j < m; ++j) add_element(raw, Shape::triangle3, std::array{0, node(1, j), node(1, j + 1)});
  for (int ring = 1; ring < n; ++ring)
    for (int j = 0; j < m; ++j)
      add_grid_cell(raw, {node(ring, j), node(ring + 1, j), node(ring + 1, j + 1), node(ring, j + 1)}, cells);
  return finished(std::move(raw), 3);
}

MeshFile wing_panel(const Grid& grid, const Wing& wing)
{
  check_positive(wing.span, "the span of a wing");
  check_positive(wing.root, "the root chord of a wing");
  check_positive(wing.tip, "the tip chord of a wing");
  if (!(std::abs(wing.sweep) < 0.5 * std::numbers::pi))
    throw FileError(join("a wing with the sweep ", wing.sweep, " rad; it is between -pi/2 and pi/2"));
  return surface(grid, [&](double s, double t) {
    const double chord = wing.root + t * (wing.tip - wing.root);
    const double along = (s - 0.25) * chord, up = wing.camber * chord * 4.0 * s * (1.0 - s);
    const double c = std::cos(t * wing.twist), n = std::sin(t * wing.twist);
    const double quarter = t * wing.span * std::tan(wing.sweep) + 0.25 * chord;
    return Eigen::Vector3d(quarter + c * along + n * up, t * wing.span, -n * along + c * up);
  });
}

} // namespace mullion::mesh_files
