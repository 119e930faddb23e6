// Matrices summed up term by term, also where rows are long and terms of one entry come far apart.
#include "surface/operator_sum.hpp"

#include <doctest/doctest.h>

using namespace mullion::surface;

TEST_CASE("terms of one entry are added, columns ascend, empty rows stay empty")
{
  OperatorSum sum(3, 4);
  sum.add(2, 3, 1.0), sum.add(0, 2, 2.0), sum.add(2, 0, 4.0), sum.add(2, 3, 8.0);

  const Operator matrix = sum.finish();

  CHECK(Eigen::MatrixXd(matrix) == Eigen::MatrixXd{{0, 0, 2, 0}, {0, 0, 0, 0}, {4, 0, 0, 9}});
  CHECK(matrix.nonZeros() == 3);
}

TEST_CASE("a row longer than is searched through keeps its sum and has every column once")
{
  constexpr int n = 1000, rounds = 5; // a face of a coarse mesh beside a thousand fine ones
  OperatorSum sum(1, n);
  for (int round = 0; round < rounds; ++round)
    for (int column = n - 1; column >= 0; --column) sum.add(0, column, column);

  const Operator matrix = sum.finish();

  CHECK(matrix.nonZeros() == n);
  bool is_sum = true;
  for (int column = 0; column < n; ++column) is_sum = is_sum && matrix.coeff(0, column) == rounds * column; // integers
  CHECK(is_sum);
}
