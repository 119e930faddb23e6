// The fluid's wall of CIBC: means between faces and nodes, and which nodes its rim has.
#include "cibc/wall_faces.hpp"

#include <doctest/doctest.h>

using namespace mullion::cibc;

TEST_CASE("a point wall hands its value through to the bit")
{
  const auto wall = wall_faces(Eigen::MatrixXd::Constant(1, 1, 0.3), {Faces::Zero(1, 1)});
  const Eigen::MatrixXd value = Eigen::MatrixXd::Constant(1, 1, 0.1 + 0.2);

  CHECK(mean_on_faces(wall, value) == value);
  CHECK(mean_on_nodes(wall, value) == value);
  CHECK(wall.is_at_rim[0] == 0);
}

TEST_CASE("a face has the mean of its nodes, a node the mean of its faces by their lengths")
{
  Eigen::MatrixXd x(2, 3);
  x << 0, 1, 1, 0, 0, 3; // lengths 1 and 3
  Faces lines(2, 2);
  lines << 0, 1, 1, 2;
  const auto wall = wall_faces(x, {lines});

  Eigen::MatrixXd nodal(1, 3), facial(1, 2);
  nodal << 2, 4, 8;
  facial << 4, 8;
  CHECK(mean_on_faces(wall, nodal) == (Eigen::MatrixXd(1, 2) << 3, 6).finished());
  CHECK(mean_on_nodes(wall, facial) == (Eigen::MatrixXd(1, 3) << 4, (4 + 3 * 8) / 4.0, 8).finished());
  CHECK(wall.is_at_rim == std::vector<std::uint8_t>{1, 0, 1});
}

TEST_CASE("a closed surface has no rim, a quadrilateral beside a triangle has one around both")
{
  Eigen::MatrixXd x(3, 5);
  x << 0, 1, 1, 0, 2, 0, 0, 1, 1, 0.5, 0, 0, 0, 0, 0;
  Faces quad(4, 1), triangle(3, 1);
  quad << 0, 1, 2, 3;
  triangle << 1, 4, 2;
  const auto wall = wall_faces(x, {triangle, quad});
  CHECK(wall.measures == std::vector<double>{0.5, 1.0}); // in the order of the blocks
  CHECK(wall.is_at_rim == std::vector<std::uint8_t>{1, 1, 1, 1, 1});

  Eigen::MatrixXd corners(3, 4);
  corners << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
  Faces sides(3, 4);
  sides << 0, 0, 0, 1, 2, 1, 3, 2, 1, 3, 2, 3;
  CHECK(wall_faces(corners, {sides}).is_at_rim == std::vector<std::uint8_t>{0, 0, 0, 0});
}
