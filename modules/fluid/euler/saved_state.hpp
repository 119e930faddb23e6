// First states from files: a table of cells from any tool, or what another run of this module has written.
#pragma once

#include "gas.hpp"
#include "mesh.hpp"

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace mullion::euler {

/// The file, what is wrong with it, what would be right.
class SavedStateError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Amounts of all cells, as the blocks count.
///
/// A file *.csv has a header with the columns x, y, rho, u, v, p in any order (others are ignored) and a line a cell
/// [m, kg/m^3, m/s, Pa]; each cell takes the line at its centroid, which is met to 1e-6 of its size. A file *.h5 is one
/// of a run's results (docs/formats/results.md) of the same mesh with the nodes at the same places; of one instance.
///
/// @param nodes  (2 x n) [m];  centroid, volume: of the cells, as the blocks count
/// @throws SavedStateError
std::vector<Values<2>> saved_state(const std::string& file, const Gas& gas, const Eigen::Matrix2Xd& nodes,
                                   std::span<const Vec<2>> centroid, std::span<const double> volume);

} // namespace mullion::euler
