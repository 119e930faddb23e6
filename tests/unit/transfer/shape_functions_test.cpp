// Shape functions at the nodes and in between, and the inverse of the bilinear map.
#include "surface/shape_functions.hpp"

#include <doctest/doctest.h>

#include <numeric>

using namespace mullion::surface;

namespace {

SurfaceMesh one_face(const Eigen::MatrixXd& nodes)
{
  SurfaceMesh mesh;
  mesh.dimension = static_cast<int>(nodes.rows());
  mesh.nodes = nodes;
  mesh.face_begin = {0, static_cast<std::int32_t>(nodes.cols())};
  mesh.face_nodes.resize(static_cast<std::size_t>(nodes.cols()));
  std::iota(mesh.face_nodes.begin(), mesh.face_nodes.end(), 0);
  return mesh;
}

SurfaceMesh warped_quadrilateral()
{
  Eigen::MatrixXd nodes(3, 4);
  nodes << 0.0, 2.0, 1.7, 0.1, //
      0.0, 0.1, 1.5, 1.0,      //
      0.0, 0.2, -0.1, 0.1;
  return one_face(nodes);
}

} // namespace

TEST_CASE("shape functions are one at their node and zero at the others, and sum to one in between")
{
  const std::vector<std::vector<std::array<double, 2>>> corners = {
      {{0, 0}, {1, 0}}, {{0, 0}, {1, 0}, {0, 1}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (const auto& face : corners) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const auto n = shape_values(face.size(), face[k].data());
      for (std::size_t l = 0; l < 4; ++l) CHECK(n[l] == (k == l ? 1.0 : 0.0));
    }
    const double xi[2] = {0.3, 0.45};
    const auto n = shape_values(face.size(), xi);
    CHECK(n[0] + n[1] + n[2] + n[3] == doctest::Approx(1.0).epsilon(1e-15));
  }
}

TEST_CASE("the densities of a line, a triangle and a rectangle are their sizes")
{
  const double xi[2] = {0.2, 0.3};

  const auto line = one_face(Eigen::MatrixXd{{0.0, 3.0}, {0.0, 4.0}});
  const auto triangle = one_face(Eigen::MatrixXd{{0.0, 2.0, 0.0}, {0.0, 0.0, 3.0}, {0.0, 0.0, 0.0}});
  const auto rectangle = one_face(Eigen::MatrixXd{{0.0, 2.0, 2.0, 0.0}, {0.0, 0.0, 3.0, 3.0}, {1.0, 1.0, 1.0, 1.0}});
  CHECK(measure_density(line, 0, xi) == doctest::Approx(5.0).epsilon(1e-15));
  CHECK(measure_density(triangle, 0, xi) == doctest::Approx(6.0).epsilon(1e-15)); // twice the area
  CHECK(measure_density(rectangle, 0, xi) == doctest::Approx(6.0).epsilon(1e-15));
}

TEST_CASE("tangents are the derivatives of the mapping")
{
  const auto mesh = warped_quadrilateral();
  const double xi[2] = {0.35, 0.8}, h = 1e-6;
  const double ahead[2] = {xi[0] + h, xi[1]}, behind[2] = {xi[0] - h, xi[1]};
  const double above[2] = {xi[0], xi[1] + h}, below[2] = {xi[0], xi[1] - h};

  const auto t = tangents(mesh, 0, xi);

  // Bilinear: central differences are exact but for the round-off 1e-16 / h.
  CHECK((t.xi - (map_to_space(mesh, 0, ahead) - map_to_space(mesh, 0, behind)) / (2.0 * h)).norm() < 1e-9);
  CHECK((t.eta - (map_to_space(mesh, 0, above) - map_to_space(mesh, 0, below)) / (2.0 * h)).norm() < 1e-9);
}

TEST_CASE("the bilinear map is inverted for points on the face and, along its normal, beside it")
{
  const auto mesh = warped_quadrilateral();
  for (const double a : {0.0, 0.1, 0.5, 0.9, 1.0})
    for (const double b : {0.0, 0.33, 1.0})
      for (const double gap : {0.0, 0.05}) {
        const double xi[2] = {a, b};
        const auto [t, s] = tangents(mesh, 0, xi);
        const Point x = map_to_space(mesh, 0, xi) + gap * t.cross(s).normalized();

        double found[2] = {0.5, 0.5};
        invert_quadrilateral(mesh, 0, x, found);

        // On the face Gauss-Newton converges quadratically, beside it at the rate gap * curvature = 0.02 a step.
        CHECK(found[0] == doctest::Approx(a).epsilon(1e-12));
        CHECK(found[1] == doctest::Approx(b).epsilon(1e-12));
      }
}
