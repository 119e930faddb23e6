// A circular arch over a flat floor: the solid, and the gas that flows over it or is shut in above it.
#include "file_error.hpp"
#include "generators.hpp"
#include "grid.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace mullion::mesh_files {
namespace {

void check_positive(double value, const char* what)
{
  if (!(value > 0.0) || !std::isfinite(value)) throw FileError(join(what, " is ", value, "; it is above 0"));
}

void check_arch(const Arch& arch)
{
  check_positive(arch.length, "the length of an arch");
  check_positive(arch.thickness, "the thickness of an arch");
  if (!(arch.angle > 0.0 && arch.angle < std::numbers::pi))
    throw FileError(join("an arch over ", arch.angle, " rad; it is above 0 and below pi"));
  if (!(0.5 * arch.thickness < arch.length / arch.angle))
    throw FileError(join("an arch of the thickness ", arch.thickness, " m and the radius ", arch.length / arch.angle,
                         " m; the thickness is below twice the radius"));
}

double outer_radius(const Arch& arch) { return arch.length / arch.angle + 0.5 * arch.thickness; }
double half_chord(const Arch& arch) { return outer_radius(arch) * std::sin(0.5 * arch.angle); }

/// The point at s of [0, 1] along the arch, from x < 0 on, on a circle about the centre that both faces have.
Eigen::Vector2d on_arch(const Arch& arch, double radius, double s)
{
  const double phi = (s - 0.5) * arch.angle;
  return {radius * std::sin(phi), radius * std::cos(phi) - outer_radius(arch) * std::cos(0.5 * arch.angle)};
}

/// Nodes on the floor, from left to right, and which of the faces between them are the arch's.
struct Floor {
  std::vector<Eigen::Vector2d> nodes;
  std::vector<std::string> names;
};

/// Widths of the cells beside the arch, until the way is covered.
std::vector<double> widths(double first, double growth, double largest, double way)
{
  std::vector<double> all;
  for (double covered = 0.0, width = growth * first; covered < way * (1.0 - 1e-12); width *= growth) {
    all.push_back(std::min(width, largest));
    covered += all.back();
    check_cells({static_cast<int>(all.size())});
  }
  return all;
}

/// @param left, right  widths of the cells beside the arch, away from it
Floor floor_of(const Arch& arch, int n_faces, const std::vector<double>& left, const std::vector<double>& right)
{
  Floor floor;
  double x = -half_chord(arch);
  for (const double width : left) floor.nodes.emplace(floor.nodes.begin(), x -= width, 0.0);
  floor.nodes.emplace_back(-half_chord(arch), 0.0);
  for (int i = 1; i < n_faces; ++i)
    floor.nodes.push_back(on_arch(arch, outer_radius(arch), static_cast<double>(i) / n_faces));
  floor.nodes.emplace_back(half_chord(arch), 0.0);
  x = half_chord(arch);
  for (const double width : right) floor.nodes.emplace_back(x += width, 0.0);
  floor.names.assign(left.size(), "floor");
  floor.names.insert(floor.names.end(), static_cast<std::size_t>(n_faces), "shell");
  floor.names.insert(floor.names.end(), right.size(), "floor");
  return floor;
}

/// The ratio of the last row's height to the first's with which n rows sum up to the height.
/// @throws FileError where rows of that first height would fill it otherwise
double ratio_of_rows(int n, double first, double height)
{
  const auto sum = [&](double ratio) { return first / graded(1.0 / n, n, ratio); };
  double low = 1e-6, high = 1e6; // the sum grows with the ratio
  if (n == 1 || !(sum(low) < height && height < sum(high)))
    throw FileError(join(n, " rows from ", first, " m on cannot fill the height of ", height,
                         " m; take other numbers of rows or faces"));
  for (int i = 0; i < 200; ++i) { // until the two are neighbours
    const double middle = std::sqrt(low * high);
    (sum(middle) < height ? low : high) = middle;
  }
  return low;
}

/// The rows between the floor and a flat roof: (s, t) counts columns and rows evenly.
MeshFile above(const Floor& floor, const Arch& arch, double height, Grid grid, int n_faces, const char* left,
               const char* right)
{
  grid.n = static_cast<int>(floor.names.size());
  check_cells({grid.n, grid.m});
  const double rise = on_arch(arch, outer_radius(arch), 0.5)[1];
  if (!(height > rise))
    throw FileError(join("a roof at ", height, " m over an arch that is ", rise, " m high; it lies above the arch"));
  const double ratio = ratio_of_rows(grid.m, 2.0 * half_chord(arch) / n_faces, height);
  return domain(grid, unit_grid_with_fixed_sides({grid.n, grid.m}, grid.perturb),
                [&](double s, double t) -> Eigen::Vector2d {
                  const double at = s * grid.n;
                  const bool is_node = std::abs(at - std::round(at)) < 1e-9;
                  const auto i = static_cast<std::size_t>(is_node ? std::round(at) : std::floor(at));
                  Eigen::Vector2d x = floor.nodes[i];
                  if (!is_node) x += (at - std::floor(at)) * (floor.nodes[i + 1] - x);
                  const double eta = graded(t, grid.m, ratio);
                  return {x[0], t == 1.0 ? height : x[1] + (height - x[1]) * eta};
                },
                {left, right, "roof", floor.names});
}

} // namespace

MeshFile solid_arch(const Grid& grid, const Arch& arch)
{
  check_arch(arch);
  const double inner = arch.length / arch.angle - 0.5 * arch.thickness;
  auto at_ends = [&](double s, double t) -> Eigen::Vector2d {
    const bool is_end_of_outer_face = t == 1.0 && (s == 0.0 || s == 1.0);
    if (is_end_of_outer_face) return {s == 0.0 ? -half_chord(arch) : half_chord(arch), 0.0}; // without round-off
    return on_arch(arch, t == 1.0 ? outer_radius(arch) : inner + t * arch.thickness, s);
  };
  return domain(grid, unit_grid_with_fixed_sides({grid.n, grid.m}, grid.perturb), at_ends,
                {"start", "end", "wet", {"inner"}});
}

MeshFile duct_over_arch(const Grid& grid, const Arch& arch, const ArchSurroundings& around)
{
  check_arch(arch);
  check_cells({grid.n, grid.m});
  check_positive(around.height, "the height of a duct");
  check_positive(around.largest, "the largest cell of a duct");
  if (!(around.growth >= 1.0) || !std::isfinite(around.growth))
    throw FileError(join("cells that grow by the factor ", around.growth, "; it is at least 1"));
  const double end = half_chord(arch), face = 2.0 * end / grid.n;
  if (!(around.left < -end && end < around.right) || !std::isfinite(around.right - around.left))
    throw FileError(
        join("a duct from ", around.left, " m to ", around.right, " m; the arch takes ", -end, " to ", end));
  const auto floor = floor_of(arch, grid.n, widths(face, around.growth, around.largest, -end - around.left),
                              widths(face, around.growth, around.largest, around.right - end));
  return above(floor, arch, around.height, grid, grid.n, "inlet", "outlet");
}

MeshFile box_over_arch(const Grid& grid, const Arch& arch, double height, double growth)
{
  check_arch(arch);
  check_cells({grid.n, grid.m});
  check_positive(height, "the height of a box");
  check_positive(growth, "the growth of a box's cells");
  const std::vector<double> beside = {growth * 2.0 * half_chord(arch) / grid.n};
  return above(floor_of(arch, grid.n, beside, beside), arch, height, grid, grid.n, "left", "right");
}

} // namespace mullion::mesh_files
