// Regular grids and boxes.
#include "file_error.hpp"
#include "generators.hpp"
#include "grid.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mullion::mesh_files {
namespace {

/// Random numbers of our own, because those of std differ between libraries: Steele, Lea and Flood's SplitMix64.
struct Random {
  std::uint64_t state;
  /// In [-1, 1).
  double next()
  {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }
};

} // namespace

void check_cells(const std::vector<int>& n)
{
  constexpr double most = 2.0e7;
  double product = 1.0;
  for (const int cells : n) {
    if (cells < 1) throw FileError(join("a mesh of ", cells, " cells in a direction; there is at least 1"));
    product *= cells;
  }
  if (product > most) throw FileError(join("a mesh of ", product, " cells; up to ", most, " are generated"));
}

std::vector<Eigen::VectorXd> unit_grid(const std::vector<int>& n, const Perturbation& perturb)
{
  check_cells(n);
  const auto d = n.size();
  // Two edges of a corner stay a right-handed pair if 1 - 2p > 2p, three a right-handed triple if 1 - 2p > 4p.
  const double limit = d == 2 ? 0.25 : 1.0 / 6.0;
  if (!(perturb.part >= 0.0 && perturb.part < limit))
    throw FileError(
        join("perturb = ", perturb.part, "; it is at least 0 and below ", limit, ", or elements could turn over"));
  Random random{perturb.seed};
  std::vector<Eigen::VectorXd> nodes;
  std::vector<int> at(d, 0);
  while (true) {
    Eigen::VectorXd x(static_cast<Eigen::Index>(d));
    for (std::size_t k = 0; k < d; ++k) {
      const double shift = perturb.part * random.next(); // drawn for each node, moved or not
      const bool is_on_side = at[k] == 0 || at[k] == n[k];
      x[static_cast<Eigen::Index>(k)] = is_on_side ? static_cast<double>(at[k]) / n[k] : (at[k] + shift) / n[k];
    }
    nodes.push_back(x);
    std::size_t k = 0;
    while (k < d && ++at[k] > n[k]) at[k++] = 0;
    if (k == d) return nodes;
  }
}

void add_grid_node(RawMesh& raw, const Eigen::VectorXd& x)
{
  for (Eigen::Index k = 0; k < 3; ++k) raw.coordinates.push_back(k < x.size() ? x[k] : 0.0);
  raw.numbers.push_back(static_cast<std::int64_t>(raw.numbers.size()));
}

namespace {

/// Is the diagonal between the corners b and d Delaunay's choice? Where the angles across from a and c sum up to more
/// than pi, the other one is better.
bool is_cut_from_b_to_d(const RawMesh& raw, const std::array<Index, 4>& nodes)
{
  const auto x = [&](std::size_t k) {
    return Eigen::Map<const Eigen::Vector3d>(raw.coordinates.data() + 3 * static_cast<std::size_t>(nodes[k]));
  };
  const auto cosine_and_sine = [](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    return Eigen::Vector2d(u.dot(v), u.cross(v).norm());
  };
  const auto at_a = cosine_and_sine(x(1) - x(0), x(3) - x(0)), at_c = cosine_and_sine(x(3) - x(2), x(1) - x(2));
  // sin(alpha + gamma) > 0: cutting from b to d leaves alpha and gamma across the cut, and they sum up to less than pi.
  return at_a[1] * at_c[0] + at_a[0] * at_c[1] > 0.0;
}

} // namespace

std::vector<Element> add_grid_cell(RawMesh& raw, const std::array<Index, 4>& nodes, Cells cells, bool is_odd)
{
  const auto& [a, b, c, d] = nodes;
  if (cells == Cells::quads) return {add_element(raw, Shape::quadrilateral4, nodes)};
  const bool is_other =
      (cells == Cells::alternating && is_odd) || (cells == Cells::delaunay && is_cut_from_b_to_d(raw, nodes));
  if (is_other)
    return {add_element(raw, Shape::triangle3, std::array{a, b, d}),
            add_element(raw, Shape::triangle3, std::array{b, c, d})};
  return {add_element(raw, Shape::triangle3, std::array{a, b, c}),
          add_element(raw, Shape::triangle3, std::array{a, c, d})};
}

std::vector<Element> add_grid_cells(RawMesh& raw, int n, int m, Cells cells)
{
  const auto node = [&](int i, int j) { return static_cast<Index>(i + (n + 1) * j); };
  std::vector<Element> added;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
      for (const auto& element : add_grid_cell(raw, {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)},
                                               cells, (i + j) % 2 == 1))
        added.push_back(element);
  return added;
}

std::vector<Eigen::VectorXd> unit_grid_with_fixed_sides(const std::vector<int>& n, const Perturbation& perturb)
{
  auto nodes = unit_grid(n, perturb);
  const auto in_place = unit_grid(n, {});
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if ((in_place[i].array() == 0.0).any() || (in_place[i].array() == 1.0).any()) nodes[i] = in_place[i];
  return nodes;
}

double graded(double s, int n, double ratio)
{
  if (n == 1 || ratio == 1.0) return s;
  const double log_factor = std::log(ratio) / (n - 1);
  return std::expm1(s * n * log_factor) / std::expm1(n * log_factor);
}

namespace {

/// Every corner of every element in the plane turns to the left.
void check_turns(const RawMesh& raw)
{
  for (const auto shape : {Shape::triangle3, Shape::quadrilateral4}) {
    const auto n = static_cast<std::size_t>(facts(shape).n_nodes);
    const auto& nodes = raw.connectivity[static_cast<std::size_t>(shape)];
    for (std::size_t first = 0; first < nodes.size(); first += n)
      for (std::size_t k = 0; k < n; ++k) {
        const auto x = [&](std::size_t corner) {
          return Eigen::Map<const Eigen::Vector2d>(raw.coordinates.data() +
                                                   3 * static_cast<std::size_t>(nodes[first + corner % n]));
        };
        const Eigen::Vector2d u = x(k + 1) - x(k), v = x(k + n - 1) - x(k);
        if (!(u[0] * v[1] - u[1] * v[0] > 0.0))
          throw FileError(join("cell ", first / n, " turns over near (", x(k)[0], ", ", x(k)[1],
                               "); take a smaller perturb or skew, or sizes that leave it room"));
      }
  }
}

} // namespace

MeshFile domain(const Grid& grid, const std::vector<Eigen::VectorXd>& st,
                const std::function<Eigen::Vector2d(double s, double t)>& function, const SideNames& names)
{
  const int n = grid.n, m = grid.m;
  RawMesh raw;
  for (const auto& at : st) add_grid_node(raw, function(at[0], at[1]));
  for (const auto& cell : add_grid_cells(raw, n, m, grid.cells)) add_to_group(raw, "volume", cell);
  check_turns(raw);
  const auto node = [&](int i, int j) { return static_cast<Index>(i + (n + 1) * j); };
  // Counterclockwise, so that the normal, to the right of a line, points outward.
  const auto side = [&](const std::string& name, Index a, Index b) {
    add_to_group(raw, name, add_element(raw, Shape::line2, std::array{a, b}));
  };
  for (int j = 0; j < m; ++j) side(names.left, node(0, j + 1), node(0, j));
  for (int j = 0; j < m; ++j) side(names.right, node(n, j), node(n, j + 1));
  for (int i = 0; i < n; ++i)
    side(names.bottom[names.bottom.size() == 1 ? 0 : static_cast<std::size_t>(i)], node(i, 0), node(i + 1, 0));
  for (int i = 0; i < n; ++i) side(names.top, node(i + 1, m), node(i, m));
  return finished(std::move(raw), 2);
}

namespace {

void check_box(const Eigen::VectorXd& size)
{
  for (const double length : size)
    if (!(length > 0.0) || !std::isfinite(length))
      throw FileError(join("a box with a side of ", length, " m; sides are above 0"));
}

void check_ratio(const Eigen::VectorXd& ratio)
{
  for (const double r : ratio)
    if (!(r > 0.0) || !std::isfinite(r))
      throw FileError(join("the ratio ", r, " of the last cell's size to the first's; it is above 0"));
}

} // namespace

MeshFile box_2d(const Grid& grid, const Eigen::Vector2d& size, const Eigen::Vector2d& origin, const Division& division)
{
  check_box(size);
  check_ratio(division.ratio);
  const auto wave = [](double at) { return std::sin(2.0 * std::numbers::pi * at); };
  return domain(grid, unit_grid({grid.n, grid.m}, grid.perturb),
                [&](double s, double t) -> Eigen::Vector2d {
                  const Eigen::Vector2d at(graded(s, grid.n, division.ratio[0]), graded(t, grid.m, division.ratio[1]));
                  const Eigen::Vector2d x = origin + at.cwiseProduct(size);
                  const bool is_on_side =
                      s == 0.0 || s == 1.0 || t == 0.0 || t == 1.0; // where a wave is 0 but for round-off
                  if (division.skew == 0.0 || is_on_side) return x;
                  return x + Eigen::Vector2d::Constant(division.skew * wave(at[0]) * wave(at[1]));
                },
                {"x_min", "x_max", "y_max", {"y_min"}});
}

namespace {

using Corners = std::array<Index, 8>; ///< of a grid cell: corner i + 2j + 4k

/// Six tetrahedra along the diagonal from corner 0 to corner 7 (Kuhn): those of neighbouring cells fit together.
void add_tets(RawMesh& raw, const Corners& c)
{
  constexpr int paths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
  for (const auto& [a, b] : paths)
    add_to_group(raw, "volume",
                 add_element(raw, Shape::tetrahedron4,
                             std::array{c[0], c[static_cast<std::size_t>(a)], c[static_cast<std::size_t>(b)], c[7]}));
}

/// A face of a cell; the first corner and the third are on its Kuhn diagonal.
void add_side(RawMesh& raw, const char* name, const Corners& c, const std::array<std::size_t, 4>& face, Volumes volumes)
{
  const auto cells = volumes == Volumes::hexes ? Cells::quads : Cells::triangles;
  for (const auto& element : add_grid_cell(raw, {c[face[0]], c[face[1]], c[face[2]], c[face[3]]}, cells))
    add_to_group(raw, name, element);
}

} // namespace

MeshFile box_3d(const Eigen::Vector3i& n, Volumes volumes, const Eigen::Vector3d& size, const Eigen::Vector3d& origin,
                const Perturbation& perturb, const Eigen::Vector3d& ratio)
{
  check_box(size);
  check_ratio(ratio);
  RawMesh raw;
  for (auto at : unit_grid({n[0], n[1], n[2]}, perturb)) {
    for (int k = 0; k < 3; ++k) at[k] = graded(at[k], n[k], ratio[k]);
    add_grid_node(raw, origin + at.cwiseProduct(size));
  }
  const auto corners = [&](int i, int j, int k) {
    Corners c;
    for (int corner = 0; corner < 8; ++corner)
      c[static_cast<std::size_t>(corner)] =
          static_cast<Index>((i + corner % 2) + (n[0] + 1) * ((j + corner / 2 % 2) + (n[1] + 1) * (k + corner / 4)));
    return c;
  };
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const auto c = corners(i, j, k);
        if (volumes == Volumes::tets) add_tets(raw, c);
        else
          add_to_group(
              raw, "volume",
              add_element(raw, Shape::hexahedron8, std::array{c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6]}));
      }
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const auto c = corners(i, j, k);
        if (i == 0) add_side(raw, "x_min", c, {0, 4, 6, 2}, volumes);
        if (i == n[0] - 1) add_side(raw, "x_max", c, {1, 3, 7, 5}, volumes);
        if (j == 0) add_side(raw, "y_min", c, {0, 1, 5, 4}, volumes);
        if (j == n[1] - 1) add_side(raw, "y_max", c, {2, 6, 7, 3}, volumes);
        if (k == 0) add_side(raw, "z_min", c, {0, 2, 3, 1}, volumes);
        if (k == n[2] - 1) add_side(raw, "z_max", c, {4, 5, 7, 6}, volumes);
      }
  return finished(std::move(raw), 3);
}

} // namespace mullion::mesh_files
