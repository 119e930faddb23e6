// Faces from elements, a cell order that keeps neighbours close, and the stencils of the gradients.
#include "mesh.hpp"

#include <algorithm>
#include <numeric>

namespace mullion::euler {

namespace {

const ShapeFaces triangle{3, {{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}}}};
const ShapeFaces quadrilateral{4, {{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}}}};
const ShapeFaces tetrahedron{4, {{{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}}}};
const ShapeFaces pyramid{5, {{{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}}};
const ShapeFaces prism{5, {{{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}}};
const ShapeFaces hexahedron{6, {{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}}};

/// One side of a face, as one of its cells sees it.
template <int D> struct Side {
  FaceNodes<D> key{}; ///< its nodes, ascending: the same for both sides
  Index cell = 0;
  int face = 0;
};

/// A face of the mesh before cells have their final numbers; b = -1 on the boundary.
template <int D> struct Link {
  CellFace a, b{-1, 0};
  int patch = -1;
  std::uint8_t shift = 0; ///< b's place plus this is where a sees it
};

struct CellAt {
  const Connectivity* connectivity;
  Shape shape;
  Eigen::Index column;
};

template <int D> std::vector<CellAt> cells_of(const MeshSource<D>& source)
{
  std::vector<CellAt> cells;
  for (const auto& block : source.blocks) {
    faces_of(block.shape, D); // is it one of ours?
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) cells.push_back({&block.connectivity, block.shape, e});
  }
  if (cells.empty()) throw MeshError("the mesh has no cells");
  return cells;
}

template <int D> FaceNodes<D> nodes_of(const std::vector<CellAt>& cells, const CellFace& face)
{
  const auto& cell = cells[static_cast<std::size_t>(face.cell)];
  FaceNodes<D> nodes{};
  for (int k = 0; k < most_face_nodes<D>; ++k) {
    const int local = faces_of(cell.shape, D).nodes[static_cast<std::size_t>(face.face)][static_cast<std::size_t>(k)];
    nodes[static_cast<std::size_t>(k)] = local < 0 ? -1 : (*cell.connectivity)(local, cell.column);
  }
  return nodes;
}

template <int D> Vec<D> middle(const MeshSource<D>& source, const FaceNodes<D>& nodes)
{
  Vec<D> sum = Vec<D>::Zero();
  int n = 0;
  for (const Index node : nodes)
    if (node >= 0) {
      sum += source.nodes.col(node);
      ++n;
    }
  return sum / n;
}

template <int D> std::string place(const Vec<D>& x)
{
  std::string text = "(" + std::to_string(x[0]);
  for (int d = 1; d < D; ++d) text += ", " + std::to_string(x[d]);
  return text + ") m";
}

template <int D> std::vector<Link<D>> pair_sides(const MeshSource<D>& source, const std::vector<CellAt>& cells)
{
  std::vector<Side<D>> sides;
  sides.reserve(cells.size() * most_cell_faces<D>);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int f = 0; f < faces_of(cells[c].shape, D).n_faces; ++f) {
      Side<D> side{nodes_of<D>(cells, {static_cast<Index>(c), f}), static_cast<Index>(c), f};
      std::sort(side.key.begin(), side.key.end());
      sides.push_back(side);
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side<D>& l, const Side<D>& r) { return l.key != r.key ? l.key < r.key : l.cell < r.cell; });
  std::vector<Link<D>> links;
  links.reserve(sides.size() / 2 + 1);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].key == sides[i].key) ++end;
    const CellFace a{sides[i].cell, sides[i].face};
    if (end - i > 2)
      throw MeshError("the face at " + place<D>(middle(source, nodes_of<D>(cells, a))) + " belongs to " +
                      std::to_string(end - i) + " cells; a face has one or two");
    Link<D> link{a, {-1, 0}, source.patch_of_face(a.face, a.cell), 0};
    if (end - i == 2) link.b = {sides[i + 1].cell, sides[i + 1].face};
    else if (link.patch < 0)
      throw MeshError("the boundary face at " + place<D>(middle(source, nodes_of<D>(cells, a))) +
                      " belongs to no patch");
    links.push_back(link);
    i = end;
  }
  return links;
}

/// Joins the faces of periodic patches: the link of the second patch goes, that of the first becomes an inner one.
template <int D>
void join_periodic(const MeshSource<D>& source, const std::vector<CellAt>& cells, std::vector<Link<D>>& links,
                   std::vector<Vec<D>>& shifts)
{
  shifts.assign(1, Vec<D>::Zero());
  for (const auto& pair : source.periodic) {
    std::vector<std::size_t> first, second;
    Vec<D> to_second = Vec<D>::Zero();
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (links[i].b.cell >= 0) continue;
      if (links[i].patch == pair.first) first.push_back(i);
      if (links[i].patch == pair.second) second.push_back(i);
    }
    if (first.size() != second.size() || first.empty())
      throw MeshError("periodic boundaries have " + std::to_string(first.size()) + " and " +
                      std::to_string(second.size()) + " faces; they must have the same number of them");
    for (const auto i : first) to_second -= middle(source, nodes_of<D>(cells, links[i].a));
    for (const auto i : second) to_second += middle(source, nodes_of<D>(cells, links[i].a));
    to_second /= static_cast<double>(first.size());
    // The direction in which the boundary extends: faces are matched along the sorted images of their middles.
    struct Place {
      Vec<D> x;
      std::size_t link;
    };
    const auto places = [&](const std::vector<std::size_t>& of, const Vec<D>& moved) {
      std::vector<Place> result;
      for (const auto i : of) result.push_back({middle(source, nodes_of<D>(cells, links[i].a)) + moved, i});
      return result;
    };
    const auto left = places(first, to_second);
    auto right = places(second, Vec<D>::Zero());
    for (const auto& face : left) {
      const auto nodes = nodes_of<D>(cells, links[face.link].a);
      const double size = (source.nodes.col(nodes[0]) - source.nodes.col(nodes[1])).norm();
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < right.size(); ++k)
        if ((right[k].x - face.x).squaredNorm() < (right[nearest].x - face.x).squaredNorm()) nearest = k;
      if (right.empty() || (right[nearest].x - face.x).norm() > 1e-6 * size)
        throw MeshError("the periodic face at " + place<D>(face.x - to_second) + " has no partner at " +
                        place<D>(face.x));
      links[face.link].b = links[right[nearest].link].a;
      links[face.link].shift = static_cast<std::uint8_t>(shifts.size()); // b + shift: seen from a
      links[right[nearest].link].a.cell = -1;                            // gone
      right[nearest] = right.back();
      right.pop_back();
    }
    shifts.push_back(-to_second);
    shifts.push_back(to_second); // the same, seen from b
  }
  std::erase_if(links, [](const Link<D>& link) { return link.a.cell < 0; });
}

/// Reverse Cuthill-McKee: breadth first from a cell of few neighbours, numbers given backwards.
template <int D> std::vector<Index> near_order(std::size_t n_cells, const std::vector<Link<D>>& links)
{
  std::vector<Index> begin(n_cells + 1, 0), list;
  for (const auto& link : links)
    if (link.b.cell >= 0) {
      ++begin[static_cast<std::size_t>(link.a.cell) + 1];
      ++begin[static_cast<std::size_t>(link.b.cell) + 1];
    }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  list.resize(static_cast<std::size_t>(begin.back()));
  auto at = begin;
  for (const auto& link : links)
    if (link.b.cell >= 0) {
      list[static_cast<std::size_t>(at[static_cast<std::size_t>(link.a.cell)]++)] = link.b.cell;
      list[static_cast<std::size_t>(at[static_cast<std::size_t>(link.b.cell)]++)] = link.a.cell;
    }
  const auto degree = [&](Index c) {
    return begin[static_cast<std::size_t>(c) + 1] - begin[static_cast<std::size_t>(c)];
  };
  std::vector<Index> seeds(n_cells), order;
  std::iota(seeds.begin(), seeds.end(), 0);
  std::stable_sort(seeds.begin(), seeds.end(), [&](Index l, Index r) { return degree(l) < degree(r); });
  std::vector<bool> is_taken(n_cells, false);
  order.reserve(n_cells);
  for (const Index seed : seeds) {
    if (is_taken[static_cast<std::size_t>(seed)]) continue;
    is_taken[static_cast<std::size_t>(seed)] = true;
    order.push_back(seed);
    for (std::size_t head = order.size() - 1; head < order.size(); ++head) {
      const auto c = static_cast<std::size_t>(order[head]);
      const auto found = order.size();
      for (auto k = begin[c]; k < begin[c + 1]; ++k) {
        const Index other = list[static_cast<std::size_t>(k)];
        if (is_taken[static_cast<std::size_t>(other)]) continue;
        is_taken[static_cast<std::size_t>(other)] = true;
        order.push_back(other);
      }
      std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(found), order.end(),
                       [&](Index l, Index r) { return degree(l) < degree(r); });
    }
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// One cell that a gradient sees, and across which shift.
struct Seen {
  Index cell;
  std::uint8_t shift;
  auto operator<=>(const Seen&) const = default;
};

/// Number of this shift among `shifts`, added if it is new.
template <int D> std::uint8_t number_of_shift(std::vector<Vec<D>>& shifts, const Vec<D>& shift, double size)
{
  for (std::size_t k = 0; k < shifts.size(); ++k)
    if ((shifts[k] - shift).norm() < 1e-6 * size) return static_cast<std::uint8_t>(k);
  if (shifts.size() == 255) throw MeshError("periodic boundaries at more than 254 distances");
  shifts.push_back(shift);
  return static_cast<std::uint8_t>(shifts.size() - 1);
}

/// Nodes that periodic boundaries make one: each node's class.
template <int D>
std::vector<Index> node_classes(const MeshSource<D>& source, const std::vector<CellAt>& cells,
                                const std::vector<Link<D>>& links, const std::vector<Vec<D>>& shifts)
{
  std::vector<Index> parent(static_cast<std::size_t>(source.nodes.cols()));
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](Index i) {
    while (parent[static_cast<std::size_t>(i)] != i) i = parent[static_cast<std::size_t>(i)];
    return i;
  };
  for (const auto& link : links) {
    if (link.shift == 0) continue;
    const auto a = nodes_of<D>(cells, link.a), b = nodes_of<D>(cells, link.b);
    for (const Index i : a) {
      if (i < 0) continue;
      Index best = -1;
      double distance = 0.0;
      for (const Index j : b) {
        if (j < 0) continue;
        const double d = (source.nodes.col(j) + shifts[link.shift] - source.nodes.col(i)).norm();
        if (best < 0 || d < distance) {
          best = j;
          distance = d;
        }
      }
      const Index low = std::min(root(i), root(best)), high = std::max(root(i), root(best));
      parent[static_cast<std::size_t>(high)] = low;
    }
  }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(static_cast<Index>(i));
  return parent;
}

/// The stencils of cells that take all that share a node.
template <int D>
void add_node_neighbours(const MeshSource<D>& source, const std::vector<CellAt>& cells,
                         const std::vector<Link<D>>& links, std::vector<Vec<D>>& shifts,
                         std::vector<std::vector<Seen>>& seen)
{
  const auto is_simplex = [&](std::size_t c) { return (*cells[c].connectivity).rows() == D + 1; };
  bool any = false;
  for (std::size_t c = 0; c < cells.size() && !any; ++c) any = is_simplex(c);
  if (!any) return;
  const auto classes = node_classes(source, cells, links, shifts);
  std::vector<std::vector<std::pair<Index, Index>>> around(classes.size()); // of a class: cells, and their own node
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (Eigen::Index k = 0; k < cells[c].connectivity->rows(); ++k) {
      const Index node = (*cells[c].connectivity)(k, cells[c].column);
      around[static_cast<std::size_t>(classes[static_cast<std::size_t>(node)])].emplace_back(static_cast<Index>(c),
                                                                                             node);
    }
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!is_simplex(c)) continue;
    auto& list = seen[c];
    list.clear();
    for (Eigen::Index k = 0; k < cells[c].connectivity->rows(); ++k) {
      const Index node = (*cells[c].connectivity)(k, cells[c].column);
      for (const auto& [other, its] : around[static_cast<std::size_t>(classes[static_cast<std::size_t>(node)])]) {
        if (other == static_cast<Index>(c) && its == node) continue;
        std::uint8_t shift = 0;
        if (its != node) {
          const Vec<D> apart = source.nodes.col(node) - source.nodes.col(its);
          shift = number_of_shift(shifts, apart, apart.norm());
        }
        list.push_back({other, shift});
      }
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

} // namespace

const ShapeFaces& faces_of(Shape shape, int dimension)
{
  if (dimension == 2) {
    if (shape == Shape::triangle3) return triangle;
    if (shape == Shape::quadrilateral4) return quadrilateral;
  } else {
    if (shape == Shape::tetrahedron4) return tetrahedron;
    if (shape == Shape::pyramid5) return pyramid;
    if (shape == Shape::prism6) return prism;
    if (shape == Shape::hexahedron8) return hexahedron;
  }
  throw MeshError(std::string("elements of the shape ") + mesh_files::facts(shape).name + " are no cells in " +
                  std::to_string(dimension) + " dimensions");
}

template <int D> Mesh<D> build_mesh(const MeshSource<D>& source)
{
  const auto cells = cells_of(source);
  auto links = pair_sides(source, cells);
  Mesh<D> mesh;
  mesh.n_nodes = static_cast<std::size_t>(source.nodes.cols());
  mesh.n_cells = cells.size();
  join_periodic(source, cells, links, mesh.shifts);
  mesh.n_faces = links.size();
  mesh.order = near_order(mesh.n_cells, links);
  std::vector<Index> number(mesh.n_cells);
  for (std::size_t c = 0; c < mesh.n_cells; ++c)
    number[static_cast<std::size_t>(mesh.order[c])] = static_cast<Index>(c);

  // Faces by owner, then neighbour; boundary faces behind the inner ones of the same owner.
  const bool is_periodic = !source.periodic.empty();
  for (auto& link : links) {
    if (link.b.cell < 0) continue;
    if (number[static_cast<std::size_t>(link.b.cell)] < number[static_cast<std::size_t>(link.a.cell)]) {
      std::swap(link.a, link.b);
      if (link.shift != 0) ++link.shift; // the opposite stands behind each
    }
  }
  const auto sort_key = [&](const Link<D>& link) {
    const Index neighbour =
        link.b.cell < 0 ? std::numeric_limits<Index>::max() : number[static_cast<std::size_t>(link.b.cell)];
    return std::tuple(number[static_cast<std::size_t>(link.a.cell)], neighbour, link.a.face);
  };
  std::sort(links.begin(), links.end(), [&](const Link<D>& l, const Link<D>& r) { return sort_key(l) < sort_key(r); });

  mesh.face_begin.assign(mesh.n_cells + 1, 0);
  mesh.cell_face_begin.assign(mesh.n_cells + 1, 0);
  mesh.face_nodes.reserve(links.size());
  mesh.owner.reserve(links.size());
  mesh.neighbour.reserve(links.size());
  std::vector<std::vector<Seen>> seen(mesh.n_cells); // as the blocks count
  for (std::size_t f = 0; f < links.size(); ++f) {
    const auto& link = links[f];
    const Index owner = number[static_cast<std::size_t>(link.a.cell)];
    mesh.face_nodes.push_back(nodes_of<D>(cells, link.a));
    mesh.owner.push_back(owner);
    ++mesh.face_begin[static_cast<std::size_t>(owner) + 1];
    ++mesh.cell_face_begin[static_cast<std::size_t>(owner) + 1];
    if (is_periodic) mesh.face_shift.push_back(link.shift);
    if (link.b.cell < 0) {
      mesh.neighbour.push_back(-1 - static_cast<Index>(mesh.boundary.size()));
      mesh.boundary.push_back({static_cast<Index>(f), owner, link.patch, link.a});
      continue;
    }
    const Index neighbour = number[static_cast<std::size_t>(link.b.cell)];
    mesh.neighbour.push_back(neighbour);
    ++mesh.cell_face_begin[static_cast<std::size_t>(neighbour) + 1];
    const auto back =
        static_cast<std::uint8_t>(link.shift == 0 ? 0 : (link.shift % 2 == 1 ? link.shift + 1 : link.shift - 1));
    seen[static_cast<std::size_t>(link.a.cell)].push_back({link.b.cell, link.shift});
    seen[static_cast<std::size_t>(link.b.cell)].push_back({link.a.cell, back});
  }
  std::partial_sum(mesh.face_begin.begin(), mesh.face_begin.end(), mesh.face_begin.begin());
  std::partial_sum(mesh.cell_face_begin.begin(), mesh.cell_face_begin.end(), mesh.cell_face_begin.begin());
  mesh.cell_faces.resize(static_cast<std::size_t>(mesh.cell_face_begin.back()));
  auto at = mesh.cell_face_begin;
  for (std::size_t f = 0; f < links.size(); ++f) {
    const auto owner = static_cast<std::size_t>(number[static_cast<std::size_t>(links[f].a.cell)]);
    mesh.cell_faces[static_cast<std::size_t>(at[owner]++)] = static_cast<Index>(2 * f);
    if (mesh.neighbour[f] >= 0)
      mesh.cell_faces[static_cast<std::size_t>(at[static_cast<std::size_t>(mesh.neighbour[f])]++)] =
          static_cast<Index>(2 * f + 1);
  }

  add_node_neighbours(source, cells, links, mesh.shifts, seen);
  mesh.stencil_begin.assign(1, 0);
  for (std::size_t c = 0; c < mesh.n_cells; ++c) {
    auto& list = seen[static_cast<std::size_t>(mesh.order[c])];
    for (auto& entry : list) entry.cell = number[static_cast<std::size_t>(entry.cell)];
    std::sort(list.begin(), list.end());
    for (const auto& entry : list) {
      mesh.stencil.push_back(entry.cell);
      if (is_periodic) mesh.stencil_shift.push_back(entry.shift);
    }
    mesh.stencil_begin.push_back(static_cast<Index>(mesh.stencil.size()));
    std::vector<Seen>().swap(list);
  }
  return mesh;
}

template Mesh<2> build_mesh(const MeshSource<2>&);
template Mesh<3> build_mesh(const MeshSource<3>&);

} // namespace mullion::euler
