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
  OperatorSum matrix(n_rows, n_columns);
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
      for (std::size_t b = 0; b < column.size(); ++b) matrix.add(row[a], column[b], sum[a][b]);
    begin = end;
  }
  return matrix.finish();
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
  OperatorSum sum(n_rows, n_columns);
  for (const auto& e : entries) sum.add(e.row, e.column, e.value);
  return sum.finish();
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
  OperatorSum matrix(mesh.n_nodes(), mesh.n_nodes());
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f) {
    const auto nodes = mesh.face(f);
    double sum[4][4] = {};
    for (const auto& p : mass_rule(nodes.size())) {
      const auto n = shape_values(nodes.size(), p.xi);
      const double weight = p.weight * measure_density(mesh, f, p.xi);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = 0; b < nodes.size(); ++b) sum[a][b] += weight * n[a] * n[b];
    }
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < nodes.size(); ++b) matrix.add(nodes[a], nodes[b], sum[a][b]);
  }
  return matrix.finish();
}

Operator node_projection(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree)
{
  OperatorSum matrix(source.n_nodes(), target.n_nodes());
  for (std::int32_t i = 0; i < source.n_nodes(); ++i) {
    const auto closest = target_tree.closest(node_position(source, i));
    const auto [nodes, n] = nodal(target, closest.face, closest.xi);
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if (n[k] != 0.0) matrix.add(i, nodes[k], n[k]);
  }
  return matrix.finish();
}

Operator nearest_nodes(const SurfaceMesh& source, const SurfaceMesh& target)
{
  const NodeTree tree(target);
  OperatorSum matrix(source.n_nodes(), target.n_nodes());
  for (std::int32_t i = 0; i < source.n_nodes(); ++i) matrix.add(i, tree.closest(node_position(source, i)), 1.0);
  return matrix.finish();
}

Operator face_split(const SurfaceMesh& mesh)
{
  OperatorSum matrix(mesh.n_nodes(), mesh.n_faces());
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f)
    for (const auto node : mesh.face(f))
      matrix.add(node, f, face_measure(mesh, f) / static_cast<double>(mesh.face(f).size()));
  return matrix.finish();
}

Operator projected_load_operator(const SurfaceMesh& source, const Operator& projection, Location source_location)
{
  const Operator loads = source_location == Location::nodes ? native_mass(source) : face_split(source);
  OperatorSum matrix(projection.cols(), loads.cols()); // P^T M, term by term: by rows of both, in a fixed order
  for (Eigen::Index i = 0; i < projection.rows(); ++i)
    for (Operator::InnerIterator p(projection, i); p; ++p)
      for (Operator::InnerIterator m(loads, i); m; ++m)
        matrix.add(static_cast<std::int32_t>(p.col()), static_cast<std::int32_t>(m.col()), p.value() * m.value());
  return matrix.finish();
}

namespace {

// Plain loops: Eigen's products may change their last bit with the address of the field. The number of components is
// known to the compiler, which is worth a factor of two.

template <int n_components> void add_product(const Operator& a, const FieldView& field, Field& out)
{
  const double* in = field.data();
  const Eigen::Index stride = field.outerStride();
  for (Eigen::Index j = 0; j < a.rows(); ++j) {
    double sum[n_components] = {};
    for (Operator::InnerIterator it(a, j); it; ++it)
      for (int c = 0; c < n_components; ++c) sum[c] += it.value() * in[it.col() * stride + c];
    for (int c = 0; c < n_components; ++c) out(c, j) = sum[c];
  }
}

} // namespace

Field apply(const Operator& a, const FieldView& field)
{
  Field out = Field::Zero(field.rows(), a.rows());
  if (field.rows() == 3) add_product<3>(a, field, out);
  else if (field.rows() == 2) add_product<2>(a, field, out);
  else
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
