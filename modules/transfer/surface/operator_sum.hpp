// A sparse matrix that is summed up term by term. A large interface makes a hundred million terms for ten million
// entries: what belongs to one entry is added at once, so that little more than the matrix itself is kept.
#pragma once

#include <Eigen/SparseCore>

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

namespace mullion::surface {

/// Rows are what is written, columns what is read.
using Operator = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The matrix that is the sum of its terms. The same terms in the same order make the same bits.
class OperatorSum {
public:
  OperatorSum(std::int64_t n_rows, std::int64_t n_columns);

  void add(std::int32_t row, std::int32_t column, double value);

  /// The matrix, columns ascending in each row. Leaves nothing behind.
  [[nodiscard]] Operator finish();

private:
  /// Some entries of a row, in the order in which they came first.
  struct Block {
    static constexpr int capacity = 8;
    std::array<double, capacity> values;
    std::array<std::int32_t, capacity> columns;
    std::int32_t n;
    std::int32_t before; ///< the row's block before this one; -1: none
  };

  std::int64_t n_columns_;
  std::vector<std::int32_t> last_; ///< each row's last block; -1: the row is empty
  std::deque<Block> blocks_;       ///< grows without moving what it holds
};

} // namespace mullion::surface
