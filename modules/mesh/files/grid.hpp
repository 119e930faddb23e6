// The regular grids behind generated surfaces and boxes.
#pragma once

#include "generators.hpp"
#include "raw_mesh.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace mullion::mesh_files {

/// @throws FileError unless each number of cells is at least 1 and the mesh stays below 20 million cells
void check_cells(const std::vector<int>& n);

/// The nodes of a grid of so many cells on [0, 1]^d, the first direction fastest, perturbed.
std::vector<Eigen::VectorXd> unit_grid(const std::vector<int>& n, const Perturbation& perturb);

void add_grid_node(RawMesh& raw, const Eigen::VectorXd& x);

/// One quadrilateral, or two triangles, and what was added. @param is_odd  of cells that are cut in turn
std::vector<Element> add_grid_cell(RawMesh& raw, const std::array<Index, 4>& nodes, Cells cells, bool is_odd = false);

/// The cells of an n x m grid whose nodes were added in the order of unit_grid.
/// @return them, the first direction fastest
std::vector<Element> add_grid_cells(RawMesh& raw, int n, int m, Cells cells);

/// The groups of the sides of a domain in the plane.
struct SideNames {
  std::string left, right, top;
  std::vector<std::string> bottom; ///< of each of the n faces, or one for all
};

/// The image of the grid on the unit square, in the plane, with the group "volume" and its sides.
/// @param function  keeps the orientation
/// @throws FileError if an element is turned over
MeshFile domain(const Grid& grid, const std::vector<Eigen::VectorXd>& st,
                const std::function<Eigen::Vector2d(double s, double t)>& function, const SideNames& names);

/// unit_grid with the nodes on the sides all in their places.
std::vector<Eigen::VectorXd> unit_grid_with_fixed_sides(const std::vector<int>& n, const Perturbation& perturb);

/// Where the point s of [0, 1] goes if n equal parts become parts whose sizes grow by the same factor.
/// @param ratio  size of the last part by that of the first
double graded(double s, int n, double ratio);

} // namespace mullion::mesh_files
