#include "operators.hpp"

#include "quadrature_rules.hpp"
#include "shape_functions.hpp"

#include <algorithm>

namespace mullion::surface {

namespace {

/// What one side contributes at a point: entities and their values there.
struct Values {
  std::span<const std::int32_t> entities;
  ShapeValues n;
};

Values nodal(const SurfaceMesh& mesh, std::int32_t face, const double* xi)
{
  const auto nodes = mesh.face(face);
  return {nodes, shape_values(nodes.size(), xi)};
}

/// Sum over the points of weight * row values * column values; consecutive points of one pair of faces are summed
/// before they become entries, since an overlay has many of those.
template <typename Rows, typename Columns>
Operator integrated(std::int64_t n_rows, std::int64_t n_columns, std::span<const IntegrationPoint> points, Rows rows,
                    Columns columns)
{
  std::vector<Entry> entries;
  for (std::size_t begin = 0; begin < points.size();) {
    const auto is_same = [&](const IntegrationPoint& p) {
      return p.source_face == points[begin].source_face && p.target_face == points[begin].target_face;
    };
    double sum[4][4] = {};
    std::size_t end = begin;
    for (; end < points.size() && is_same(points[end]); ++end) {
      const auto row = rows(points[end]).n, column = columns(points[end]).n;
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b) sum[a][b] += points[end].weight * row[a] * column[b];
    }
    const auto row = rows(points[begin]).entities, column = columns(points[begin]).entities;
    for (std::size_t a = 0; a < row.size(); ++a)
      for (std::size_t b = 0; b < column.size(); ++b) entries.push_back({row[a], column[b], sum[a][b]});
    begin = end;
  }
  return assembled(n_rows, n_columns, entries);
}

/// The source's side of a point, whose field is nodal or facial.
auto source_values(const SurfaceMesh& source, Location location)
{
  return [&source, location](const IntegrationPoint& p) {
    if (location == Location::nodes) return nodal(source, p.source_face, p.source_xi);
    return Values{std::span(&p.source_face, 1), {1.0, 0.0, 0.0, 0.0}};
  };
}

std::int64_t n_entities(const SurfaceMesh& mesh, Location location)
{
  return location == Location::nodes ? mesh.n_nodes() : mesh.n_faces();
}

} // namespace

Operator assembled(std::int64_t n_rows, std::int64_t n_columns, std::span<const Entry> entries)
{
  // Entries by row, in the order given (a counting sort), then by column within a row.
  std::vector<std::size_t> begin(static_cast<std::size_t>(n_rows) + 1, 0);
  for (const auto& e : entries) ++begin[static_cast<std::size_t>(e.row) + 1];
  for (std::size_t row = 0; row < static_cast<std::size_t>(n_rows); ++row) begin[row + 1] += begin[row];
  std::vector<Entry> sorted(entries.size());
  auto next = begin;
  for (const auto& e : entries) sorted[next[static_cast<std::size_t>(e.row)]++] = e;

  Operator matrix(n_rows, n_columns);
  matrix.reserve(static_cast<Eigen::Index>(entries.size()));
  for (std::int64_t row = 0; row < n_rows; ++row) {
    const auto first = sorted.begin() + static_cast<std::ptrdiff_t>(begin[static_cast<std::size_t>(row)]);
    const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(begin[static_cast<std::size_t>(row) + 1]);
    std::stable_sort(first, last, [](const Entry& a, const Entry& b) { return a.column < b.column; });
    matrix.startVec(row);
    for (auto it = first; it != last;) {
      double sum = 0.0;
      const auto column = it->column;
      for (; it != last && it->column == column; ++it) sum += it->value;
      matrix.insertBackByOuterInner(row, column) = sum;
    }
  }
  matrix.finalize();
  return matrix;
}

Operator load_operator(const SurfaceMesh& source, const SurfaceMesh& target, std::span<const IntegrationPoint> points,
                       Location source_location)
{
  return integrated(
      target.n_nodes(), n_entities(source, source_location), points,
      [&](const IntegrationPoint& p) { return nodal(target, p.target_face, p.target_xi); },
      source_values(source, source_location));
}

Operator target_mass(const SurfaceMesh& target, std::span<const IntegrationPoint> points)
{
  const auto values = [&](const IntegrationPoint& p) { return nodal(target, p.target_face, p.target_xi); };
  return integrated(target.n_nodes(), target.n_nodes(), points, values, values);
}

Operator source_mass(const SurfaceMesh& source, std::span<const IntegrationPoint> points)
{
  const auto values = source_values(source, Location::nodes);
  return integrated(source.n_nodes(), source.n_nodes(), points, values, values);
}

Operator native_mass(const SurfaceMesh& mesh)
{
  std::vector<IntegrationPoint> points;
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f)
    for (const auto& p : face_rule(mesh.face(f).size(), 2))
      points.push_back({f, f, {p.xi[0], p.xi[1]}, {p.xi[0], p.xi[1]}, p.weight * measure_density(mesh, f, p.xi)});
  return source_mass(mesh, points);
}

Operator facial_mean(const SurfaceMesh& source, const SurfaceMesh& target, std::span<const IntegrationPoint> points,
                     Location source_location)
{
  auto mean = integrated(
      target.n_faces(), n_entities(source, source_location), points,
      [](const IntegrationPoint& p) {
        return Values{std::span(&p.target_face, 1), {1.0, 0.0, 0.0, 0.0}};
      },
      source_values(source, source_location));
  std::vector<double> measure(static_cast<std::size_t>(target.n_faces()), 0.0);
  for (const auto& p : points) measure[static_cast<std::size_t>(p.target_face)] += p.weight;
  for (Eigen::Index f = 0; f < mean.rows(); ++f)
    for (Operator::InnerIterator it(mean, f); it; ++it) // a row without points has no entry
      it.valueRef() /= measure[static_cast<std::size_t>(f)];
  return mean;
}

Operator node_projection(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree)
{
  std::vector<Entry> entries;
  for (std::int32_t i = 0; i < source.n_nodes(); ++i) {
    const auto closest = target_tree.closest(node_position(source, i));
    const auto [nodes, n] = nodal(target, closest.face, closest.xi);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (n[k] != 0.0) entries.push_back({i, nodes[k], n[k]});
  }
  return assembled(source.n_nodes(), target.n_nodes(), entries);
}

Operator nearest_nodes(const SurfaceMesh& source, const SurfaceMesh& target)
{
  const NodeTree tree(target);
  std::vector<Entry> entries;
  for (std::int32_t i = 0; i < source.n_nodes(); ++i)
    entries.push_back({i, tree.closest(node_position(source, i)), 1.0});
  return assembled(source.n_nodes(), target.n_nodes(), entries);
}

Operator face_split(const SurfaceMesh& mesh)
{
  std::vector<Entry> entries;
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f)
    for (const auto node : mesh.face(f))
      entries.push_back({node, f, face_measure(mesh, f) / static_cast<double>(mesh.face(f).size())});
  return assembled(mesh.n_nodes(), mesh.n_faces(), entries);
}

Operator projected_load_operator(const SurfaceMesh& source, const Operator& projection, Location source_location)
{
  const Operator loads = source_location == Location::nodes ? native_mass(source) : face_split(source);
  std::vector<Entry> entries; // P^T M, term by term: by rows of both, in a fixed order
  for (Eigen::Index i = 0; i < projection.rows(); ++i)
    for (Operator::InnerIterator p(projection, i); p; ++p)
      for (Operator::InnerIterator m(loads, i); m; ++m)
        entries.push_back(
            {static_cast<std::int32_t>(p.col()), static_cast<std::int32_t>(m.col()), p.value() * m.value()});
  return assembled(projection.cols(), loads.cols(), entries);
}

// Plain loops: Eigen's products may change their last bit with the address of the field.

Field apply(const Operator& a, const FieldView& field)
{
  Field out = Field::Zero(field.rows(), a.rows());
  for (Eigen::Index j = 0; j < a.rows(); ++j)
    for (Operator::InnerIterator it(a, j); it; ++it)
      for (Eigen::Index c = 0; c < field.rows(); ++c) out(c, j) += it.value() * field(c, it.col());
  return out;
}

Field apply_transposed(const Operator& a, const FieldView& field)
{
  Field out = Field::Zero(field.rows(), a.cols());
  for (Eigen::Index j = 0; j < a.rows(); ++j)
    for (Operator::InnerIterator it(a, j); it; ++it)
      for (Eigen::Index c = 0; c < field.rows(); ++c) out(c, it.col()) += it.value() * field(c, j);
  return out;
}

} // namespace mullion::surface
