#include "surface_mesh.hpp"

#include "shape_functions.hpp"
#include "words.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mullion::surface {

namespace {

/// A polyline has one direction: no node begins two faces or ends two, unless it is a branch.
std::string complaint_about_directions(const SurfaceMesh& mesh)
{
  const auto n = static_cast<std::size_t>(mesh.n_nodes());
  std::vector<int> n_begins(n, 0), n_ends(n, 0);
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f) {
    ++n_begins[static_cast<std::size_t>(mesh.face(f)[0])];
    ++n_ends[static_cast<std::size_t>(mesh.face(f)[1])];
  }
  for (std::size_t i = 0; i < n; ++i)
    if (n_begins[i] + n_ends[i] == 2 && n_begins[i] != 1)
      return words("two faces meet against each other in ", place_of_node(mesh, static_cast<std::int64_t>(i)),
                   "; the faces of a polyline all go one way");
  return "";
}

std::string complaint_about_face(const SurfaceMesh& mesh, std::int64_t f)
{
  const auto nodes = mesh.face(f);
  const bool fits = mesh.dimension == 2 ? nodes.size() == 2 : nodes.size() == 3 || nodes.size() == 4;
  if (!fits)
    return words("face ", f, " has ", nodes.size(), " nodes; in ", mesh.dimension, "D it must have ",
                 mesh.dimension == 2 ? "2" : "3 or 4");
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (nodes[k] < 0 || nodes[k] >= mesh.n_nodes())
      return words("face ", f, " names node ", nodes[k], "; the nodes are 0 to ", mesh.n_nodes() - 1);
    for (std::size_t l = 0; l < k; ++l)
      if (nodes[l] == nodes[k]) return words("face ", f, " names node ", nodes[k], " twice");
  }
  return "";
}

} // namespace

std::string complaint_about(const SurfaceMesh& mesh)
{
  if (mesh.dimension != 2 && mesh.dimension != 3)
    return words("dimension ", mesh.dimension, "; a surface lies in 2 or 3 dimensions");
  if (mesh.nodes.cols() > 0 && mesh.nodes.rows() != mesh.dimension)
    return words("nodes have ", mesh.nodes.rows(), " coordinates in ", mesh.dimension, " dimensions");
  if (mesh.n_faces() == 0) return "no faces; a surface needs at least one";
  if (mesh.face_begin.front() != 0 || mesh.face_begin.back() != static_cast<std::int64_t>(mesh.face_nodes.size()) ||
      !std::is_sorted(mesh.face_begin.begin(), mesh.face_begin.end()))
    return words("face_begin must rise from 0 to ", mesh.face_nodes.size(), ", the number of entries of face_nodes");
  for (std::int64_t i = 0; i < mesh.n_nodes(); ++i)
    if (!mesh.nodes.col(i).allFinite()) return words("the coordinates of ", place_of_node(mesh, i), " are not finite");
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f)
    if (auto complaint = complaint_about_face(mesh, f); !complaint.empty()) return complaint;
  if (static_cast<std::int64_t>(degenerate_faces(mesh).size()) == mesh.n_faces())
    return words("no face has ", mesh.dimension == 2 ? "a length" : "an area", "; are all nodes at one place?");
  return mesh.dimension == 2 ? complaint_about_directions(mesh) : "";
}

Point node_position(const SurfaceMesh& mesh, std::int64_t node)
{
  return {mesh.nodes(0, node), mesh.nodes(1, node), mesh.dimension == 2 ? 0.0 : mesh.nodes(2, node)};
}

Point face_centre(const SurfaceMesh& mesh, std::int64_t f)
{
  Point sum = Point::Zero();
  for (const auto node : mesh.face(f)) sum += node_position(mesh, node);
  return sum / static_cast<double>(mesh.face(f).size());
}

double face_measure(const SurfaceMesh& mesh, std::int64_t f)
{
  const double middle[2] = {0.0, 0.0};
  if (mesh.face(f).size() == 2) return measure_density(mesh, f, middle);
  if (mesh.face(f).size() == 3) return 0.5 * measure_density(mesh, f, middle);
  const double offset = 0.5 / std::numbers::sqrt3;
  double sum = 0.0;
  for (const double a : {0.5 - offset, 0.5 + offset})
    for (const double b : {0.5 - offset, 0.5 + offset}) {
      const double xi[2] = {a, b};
      sum += 0.25 * measure_density(mesh, f, xi);
    }
  return sum;
}

Point face_normal(const SurfaceMesh& mesh, std::int64_t f)
{
  const auto nodes = mesh.face(f);
  const auto x = [&](std::size_t k) { return node_position(mesh, nodes[k]); };
  Point normal;
  if (nodes.size() == 2) {
    const Point d = x(1) - x(0);
    normal = {d.y(), -d.x(), 0.0};
  } else if (nodes.size() == 3) normal = (x(1) - x(0)).cross(x(2) - x(0));
  else normal = (x(2) - x(0)).cross(x(3) - x(1));
  const double length = normal.norm();
  return length > 0.0 ? Point(normal / length) : Point::Zero();
}

double face_size(const SurfaceMesh& mesh, std::int64_t f)
{
  const double measure = face_measure(mesh, f);
  return mesh.dimension == 2 ? measure : std::sqrt(measure);
}

double mean_face_size(const SurfaceMesh& mesh)
{
  double sum = 0.0;
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f) sum += face_size(mesh, f);
  return mesh.n_faces() == 0 ? 0.0 : sum / static_cast<double>(mesh.n_faces());
}

double total_measure(const SurfaceMesh& mesh)
{
  double sum = 0.0;
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f) sum += face_measure(mesh, f);
  return sum;
}

std::vector<std::int32_t> degenerate_faces(const SurfaceMesh& mesh)
{
  std::vector<std::int32_t> found;
  if (mesh.n_faces() == 0) return found;
  const double smallest = 1e-12 * total_measure(mesh) / static_cast<double>(mesh.n_faces());
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f)
    if (!(face_measure(mesh, f) > smallest)) found.push_back(static_cast<std::int32_t>(f));
  return found;
}

namespace {

std::string coordinates(const SurfaceMesh& mesh, const Point& x)
{
  return mesh.dimension == 2 ? words("(", x.x(), ", ", x.y(), ") m")
                             : words("(", x.x(), ", ", x.y(), ", ", x.z(), ") m");
}

} // namespace

std::string place_of_face(const SurfaceMesh& mesh, std::int64_t f)
{
  return words("face ", f, " at ", coordinates(mesh, face_centre(mesh, f)));
}

std::string place_of_node(const SurfaceMesh& mesh, std::int64_t node)
{
  return words("node ", node, " at ", coordinates(mesh, node_position(mesh, node)));
}

} // namespace mullion::surface
