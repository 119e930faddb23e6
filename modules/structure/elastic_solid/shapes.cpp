#include "shapes.hpp"

#include <array>
#include <cmath>

namespace mullion::elastic_solid {
namespace {

bool is_simplex(Shape shape) { return shape == Shape::triangle3 || shape == Shape::tetrahedron4; }

/// 0 where the element is [-1, 1]^d with its nodes around: line, quadrilateral, hexahedron.
constexpr double corners[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                  {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

std::vector<QuadraturePoint> make_quadrature(Shape shape)
{
  const int d = mesh_files::facts(shape).dimension;
  std::vector<QuadraturePoint> points;
  if (shape == Shape::triangle3) { // degree 2
    for (int k = 0; k < 3; ++k) {
      Eigen::VectorXd xi = Eigen::VectorXd::Constant(2, 1.0 / 6.0);
      if (k < 2) xi[k] = 2.0 / 3.0;
      points.push_back({xi, 1.0 / 6.0});
    }
  } else if (shape == Shape::tetrahedron4) { // degree 2
    const double a = (5.0 - std::sqrt(5.0)) / 20.0;
    for (int k = 0; k < 4; ++k) {
      Eigen::VectorXd xi = Eigen::VectorXd::Constant(3, a);
      if (k < 3) xi[k] = 1.0 - 3.0 * a;
      points.push_back({xi, 1.0 / 24.0});
    }
  } else {
    const double g = 1.0 / std::sqrt(3.0);
    for (int k = 0; k < (1 << d); ++k) {
      Eigen::VectorXd xi(d);
      for (int i = 0; i < d; ++i) xi[i] = (k >> i) % 2 == 0 ? -g : g;
      points.push_back({xi, 1.0});
    }
  }
  return points;
}

} // namespace

ShapeValues shape_values(Shape shape, const Eigen::VectorXd& xi)
{
  const Eigen::Index n = mesh_files::facts(shape).n_nodes, d = mesh_files::facts(shape).dimension;
  ShapeValues s{Eigen::VectorXd(n), Eigen::MatrixXd(n, d)};
  if (is_simplex(shape)) {
    s.values[0] = 1.0 - xi.sum();
    s.values.tail(d) = xi;
    s.gradients.row(0).setConstant(-1.0);
    s.gradients.bottomRows(d).setIdentity();
    return s;
  }
  for (Eigen::Index a = 0; a < n; ++a) {
    std::array<double, 3> factor{1.0, 1.0, 1.0};
    for (Eigen::Index i = 0; i < d; ++i) factor[static_cast<std::size_t>(i)] = 0.5 * (1.0 + corners[a][i] * xi[i]);
    s.values[a] = factor[0] * factor[1] * factor[2];
    for (Eigen::Index i = 0; i < d; ++i) {
      double others = 1.0;
      for (Eigen::Index k = 0; k < d; ++k)
        if (k != i) others *= factor[static_cast<std::size_t>(k)];
      s.gradients(a, i) = 0.5 * corners[a][i] * others;
    }
  }
  return s;
}

const std::vector<QuadraturePoint>& quadrature(Shape shape)
{
  static const auto tables = [] { // constants, by shape
    std::array<std::vector<QuadraturePoint>, mesh_files::n_shapes> all;
    for (const auto s :
         {Shape::line2, Shape::triangle3, Shape::quadrilateral4, Shape::tetrahedron4, Shape::hexahedron8})
      all[static_cast<std::size_t>(s)] = make_quadrature(s);
    return all;
  }();
  return tables[static_cast<std::size_t>(shape)];
}

Eigen::MatrixXd reference_nodes(Shape shape)
{
  const Eigen::Index n = mesh_files::facts(shape).n_nodes, d = mesh_files::facts(shape).dimension;
  Eigen::MatrixXd nodes = Eigen::MatrixXd::Zero(d, n);
  if (is_simplex(shape)) nodes.rightCols(d).setIdentity();
  else
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index i = 0; i < d; ++i) nodes(i, a) = corners[a][i];
  return nodes;
}

Eigen::VectorXd reference_centre(Shape shape)
{
  const Eigen::Index d = mesh_files::facts(shape).dimension;
  return Eigen::VectorXd::Constant(d, is_simplex(shape) ? 1.0 / static_cast<double>(d + 1) : 0.0);
}

} // namespace mullion::elastic_solid
