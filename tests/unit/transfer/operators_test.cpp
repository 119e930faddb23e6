// Matrices by hand, and how they are applied.
#include "surface/operators.hpp"

#include "support/surface_pairs.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

TEST_CASE("terms of one place are added in the order given")
{
  // 1e16 + 1 - 1e16 is 0 in this order and 1 in another.
  const std::vector<Entry> entries = {{1, 2, 1e16}, {0, 1, 4.0}, {1, 2, 1.0}, {1, 0, 3.0}, {1, 2, -1e16}, {0, 1, 5.0}};

  const Operator a = assembled(3, 3, entries);

  CHECK(a.nonZeros() == 3);
  CHECK(a.coeff(0, 1) == 9.0);
  CHECK(a.coeff(1, 0) == 3.0);
  CHECK(a.coeff(1, 2) == 0.0);
  CHECK(Eigen::VectorXd(a * Eigen::Vector3d(1.0, 2.0, 3.0)) == Eigen::Vector3d(18.0, 3.0, 0.0));
}

TEST_CASE("the mass matrix of two lines is h/6 of the textbook's")
{
  const auto mesh = polyline({{0.0, 0.0}, {6.0, 0.0}, {6.0, 12.0}});

  const Eigen::MatrixXd mass = native_mass(mesh);

  const Eigen::Matrix3d exact = (Eigen::Matrix3d() << 2, 1, 0, 1, 6, 2, 0, 2, 4).finished();
  CHECK((mass - exact).cwiseAbs().maxCoeff() < 1e-14);
}

TEST_CASE("the mass matrices of a triangle and a rectangle are the textbook's")
{
  SurfaceMesh mesh;
  mesh.nodes = Eigen::MatrixXd{{0.0, 3.0, 3.0, 0.0}, {0.0, 0.0, 8.0, 8.0}, {0.0, 0.0, 0.0, 0.0}};
  mesh.face_begin = {0, 3};
  mesh.face_nodes = {0, 1, 2}; // area 12: A/12 (1 + delta)
  const Eigen::MatrixXd triangle = native_mass(mesh);
  CHECK((triangle.topLeftCorner(3, 3) - Eigen::Matrix3d(Eigen::Matrix3d::Ones() + Eigen::Matrix3d::Identity()))
            .cwiseAbs()
            .maxCoeff() < 1e-14);

  mesh.face_begin = {0, 4};
  mesh.face_nodes = {0, 1, 2, 3}; // area 24: A/36 of 4 on the diagonal, 2 beside it, 1 across
  const Eigen::MatrixXd rectangle = native_mass(mesh) * 1.5;
  const Eigen::Matrix4d exact = (Eigen::Matrix4d() << 4, 2, 1, 2, 2, 4, 2, 1, 1, 2, 4, 2, 2, 1, 2, 4).finished();
  CHECK((rectangle - exact).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("node projection of a finer mesh interpolates, of a node beyond the end takes the end")
{
  const auto source = polyline({{0.0, 0.1}, {0.25, 0.1}, {0.5, 0.1}, {1.2, 0.1}}), target = along(flat, 2);

  const Eigen::MatrixXd p = node_projection(source, target, FaceTree(target));

  const Eigen::MatrixXd exact{{1.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  CHECK((p - exact).cwiseAbs().maxCoeff() < 1e-15);
}

TEST_CASE("nearest neighbours have one entry a row")
{
  const auto source = along(flat, 5), target = along(flat, 2);

  const Eigen::MatrixXd p = nearest_nodes(source, target);

  // 0.0 and 0.2 to node 0; 0.4 and 0.6 to node 1; 0.8 and 1.0 to node 2.
  const Eigen::MatrixXd exact{{1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
  CHECK(p == exact);
}

TEST_CASE("face forces are split equally among a face's nodes")
{
  const Eigen::MatrixXd split = face_split(polyline({{0.0, 0.0}, {2.0, 0.0}, {2.0, 4.0}}));

  CHECK(split == Eigen::MatrixXd{{1.0, 0.0}, {1.0, 2.0}, {0.0, 2.0}});
}

TEST_CASE("load operators by hand: two source faces over one target face")
{
  const auto source = along(flat, 2), target = along(flat, 1);
  const auto points = refined(source, target).points;

  const Eigen::MatrixXd facial = load_operator(source, target, points, Location::faces);
  const Eigen::MatrixXd nodal = load_operator(source, target, points, Location::nodes);

  // integral of 1 - x over each half; of (1 - x) times the three hats.
  CHECK((facial - Eigen::MatrixXd{{3.0 / 8, 1.0 / 8}, {1.0 / 8, 3.0 / 8}}).cwiseAbs().maxCoeff() < 1e-15);
  CHECK(
      (nodal - Eigen::MatrixXd{{5.0 / 24, 6.0 / 24, 1.0 / 24}, {1.0 / 24, 6.0 / 24, 5.0 / 24}}).cwiseAbs().maxCoeff() <
      1e-15);
}

TEST_CASE("identical meshes: the load operator is the mass matrix")
{
  const auto mesh = along(arc, 9);

  const Eigen::MatrixXd b = load_operator(mesh, mesh, refined(mesh, mesh).points, Location::nodes);

  CHECK((b - Eigen::MatrixXd(native_mass(mesh))).cwiseAbs().maxCoeff() < 1e-15);
}

TEST_CASE("operators act on each component, and their transposes are adjoint")
{
  const Operator a = assembled(2, 3, std::vector<Entry>{{0, 0, 1.0}, {0, 2, 2.0}, {1, 1, 3.0}});
  const Field field{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};

  CHECK(apply(a, field) == Field{{7.0, 6.0}, {16.0, 15.0}});
  CHECK(apply_transposed(a, Field{{1.0, 10.0}}) == Field{{1.0, 30.0, 2.0}});
}

TEST_CASE("the address of a field does not change the result")
{
  const auto source = along(arc, 40), target = along(arc, 31);
  const Operator b = load_operator(source, target, refined(source, target).points, Location::nodes);
  const Field field = Field::Random(3, source.n_nodes());
  const Field first = apply(b, field);
  for (Eigen::Index offset = 1; offset < 8; ++offset) {
    Eigen::VectorXd memory(field.size() + offset);
    Eigen::Map<Field> moved(memory.data() + offset, field.rows(), field.cols());
    moved = field;

    CHECK(apply(b, moved) == first);
  }
}
