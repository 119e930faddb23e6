// First states: amounts in the cells from a function of place, at the centroid or averaged over the cell.
#pragma once

#include "gas.hpp"
#include "mesh.hpp"

#include <functional>
#include <vector>

namespace mullion::euler {

enum class Average {
  centroid,  ///< the value there
  quadrature ///< of the conserved values: 2 x 2 Gauss points of a quadrilateral, three of a triangle
};

template <int D> using StateFunction = std::function<Values<D>(const Vec<D>& x)>; ///< (rho, u, p)

/// Amounts in all cells, in the mesh's own order.
template <int D>
void set_amounts(const MeshSource<D>& source, const Mesh<D>& mesh, const Gas& gas, const std::vector<double>& volume,
                 const std::vector<Vec<D>>& centroid, const StateFunction<D>& state, Average average,
                 std::vector<Values<D>>& amounts);

} // namespace mullion::euler
