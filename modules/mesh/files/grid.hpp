// The regular grids behind generated surfaces and boxes.
#pragma once

#include "generators.hpp"
#include "raw_mesh.hpp"

#include <array>
#include <vector>

namespace mullion::mesh_files {

/// @throws FileError unless each number of cells is at least 1 and the mesh stays below 20 million cells
void check_cells(const std::vector<int>& n);

/// The nodes of a grid of so many cells on [0, 1]^d, the first direction fastest, perturbed.
std::vector<Eigen::VectorXd> unit_grid(const std::vector<int>& n, const Perturbation& perturb);

void add_grid_node(RawMesh& raw, const Eigen::VectorXd& x);

/// One quadrilateral, or two triangles, and what was added.
std::vector<Element> add_grid_cell(RawMesh& raw, const std::array<Index, 4>& nodes, Cells cells);

/// The cells of an n x m grid whose nodes were added in the order of unit_grid.
void add_grid_cells(RawMesh& raw, int n, int m, Cells cells);

} // namespace mullion::mesh_files
