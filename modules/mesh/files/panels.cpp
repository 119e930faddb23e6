// Domains in the plane that published test problems are posed on.
#include "file_error.hpp"
#include "generators.hpp"
#include "grid.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace mullion::mesh_files {

MeshFile channel_with_bump(const Grid& grid, double height)
{
  if (!(height > 0.0 && height < 0.5))
    throw FileError(join("a bump of the height ", height, "; it is above 0 and below 0.5, a half circle's"));
  if (grid.n % 3 != 0)
    throw FileError(join(grid.n, " cells along a channel whose bump takes the middle third; their number is a multiple "
                                 "of 3"));
  const double radius =
      (0.25 + height * height) / (2.0 * height); // of the circle through (1, 0), (1.5, height), (2, 0)
  const auto floor = [&](double x) {
    const double along = x - 1.5;
    return std::abs(along) < 0.5 ? std::sqrt(radius * radius - along * along) - (radius - height) : 0.0;
  };
  std::vector<std::string> names(static_cast<std::size_t>(grid.n), "floor");
  for (int i = grid.n / 3; i < 2 * grid.n / 3; ++i) names[static_cast<std::size_t>(i)] = "bump";
  return domain(grid, unit_grid_with_fixed_sides({grid.n, grid.m}, grid.perturb),
                [&](double s, double t) -> Eigen::Vector2d {
                  const double x = 3.0 * s, y = floor(x);
                  return {x, t == 1.0 ? 1.0 : y + (1.0 - y) * t};
                },
                {"inlet", "outlet", "roof", names});
}

MeshFile cooks_membrane(const Grid& grid)
{
  return domain(grid, unit_grid_with_fixed_sides({grid.n, grid.m}, grid.perturb),
                [](double s, double t) -> Eigen::Vector2d {
                  return {48.0 * s, 44.0 * s * (1.0 - t) + t * (44.0 * (1.0 - s) + 60.0 * s)};
                },
                {"left", "right", "top", {"bottom"}});
}

} // namespace mullion::mesh_files
