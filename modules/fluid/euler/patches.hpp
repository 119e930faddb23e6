// Which patches a boundary has, in a fixed order that follows from the texts of the case alone: so a process that only
// sees the windows knows them as well as the one that read the mesh.
#pragma once

#include "boundary.hpp"
#include "mesh.hpp"

#include <string>
#include <vector>

namespace mullion::euler {

/// Groups by condition, as texts with commas.
struct PatchTexts {
  std::string moving_wall, slip_wall, symmetry, farfield, prescribed;
  std::string subsonic_inflow, subsonic_outflow, supersonic_inflow, supersonic_outflow;
  std::string periodic; ///< "a:b, c:d"
};

struct Patches {
  std::vector<std::string> names; ///< groups; the patch's number is the place in this list
  std::vector<Kind> kinds;        ///< of each
  int n_moving = 0;               ///< the first so many are the coupled wall
  std::vector<PeriodicPair> periodic;
};

/// @throws MeshError for a group that is named twice
Patches patches_of(const PatchTexts& texts);

/// Bit k of a node: it lies on the k-th group in alphabetical order; groups beyond 31 are left out.
/// @param n_nodes  of the mesh
std::vector<Index> group_bits(const Mesh<2>& mesh, const std::vector<std::string>& names, std::size_t n_nodes);

} // namespace mullion::euler
