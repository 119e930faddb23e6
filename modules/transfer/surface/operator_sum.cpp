#include "operator_sum.hpp"

#include <algorithm>
#include <utility>

namespace mullion::surface {

namespace {

/// How far back a row is searched for an entry to add to. Terms come face by face, so an entry is met again soon, or it
/// stands once more in the list and finish() adds both: a row of a coarse mesh beside a fine one is long.
constexpr int n_blocks_searched = 8;

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

} // namespace

OperatorSum::OperatorSum(std::int64_t n_rows, std::int64_t n_columns)
    : n_columns_(n_columns), last_(static_cast<std::size_t>(n_rows), -1)
{
}

void OperatorSum::add(std::int32_t row, std::int32_t column, double value)
{
  std::int32_t& last = last_[index(row)];
  std::int32_t at = last;
  for (int searched = 0; at >= 0 && searched < n_blocks_searched; ++searched) {
    Block& block = blocks_[index(at)];
    for (int k = 0; k < block.n; ++k)
      if (block.columns[index(k)] == column) {
        block.values[index(k)] += value;
        return;
      }
    at = block.before;
  }
  if (last < 0 || blocks_[index(last)].n == Block::capacity) {
    blocks_.push_back({{}, {}, 0, last});
    last = static_cast<std::int32_t>(blocks_.size()) - 1;
  }
  Block& block = blocks_[index(last)];
  block.columns[index(block.n)] = column;
  block.values[index(block.n)] = value;
  ++block.n;
}

Operator OperatorSum::finish()
{
  const auto n_rows = static_cast<std::int64_t>(last_.size());
  std::vector<std::pair<std::int32_t, double>> row; // column, value
  const auto collect = [&](std::int64_t r) {
    row.clear();
    for (std::int32_t at = last_[static_cast<std::size_t>(r)]; at >= 0; at = blocks_[index(at)].before) {
      const Block& block = blocks_[index(at)];
      for (int k = block.n - 1; k >= 0; --k) row.emplace_back(block.columns[index(k)], block.values[index(k)]);
    }
    std::reverse(row.begin(), row.end()); // as they came
    std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  };

  Eigen::Index n_entries = 0;
  for (const Block& block : blocks_) n_entries += block.n; // at least as many as there will be
  Operator matrix(n_rows, n_columns_);
  matrix.reserve(n_entries);
  for (std::int64_t r = 0; r < n_rows; ++r) {
    collect(r);
    matrix.startVec(r);
    for (auto it = row.begin(); it != row.end();) {
      double sum = 0.0;
      const auto column = it->first;
      for (; it != row.end() && it->first == column; ++it) sum += it->second;
      matrix.insertBackByOuterInner(r, column) = sum;
    }
  }
  matrix.finalize();
  last_.clear();
  blocks_.clear();
  blocks_.shrink_to_fit();
  return matrix;
}

} // namespace mullion::surface
