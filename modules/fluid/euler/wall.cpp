// Reconstruction at the cells along a wall, by themselves.
#include "wall.hpp"

#include <algorithm>

namespace mullion::euler {

template <int D>
std::vector<WallFace<D>> wall_faces(const Mesh<D>& mesh, const Scheme<D>& scheme, const std::vector<Values<D>>& amounts,
                                    const Nodes<D>& x, const Nodes<D>& v, const std::vector<Index>& faces)
{
  std::vector<WallFace<D>> result;
  result.reserve(faces.size());
  std::vector<Vec<D>> ways, centroids;
  std::vector<std::array<double, D>> weights, offsets;
  for (const Index number : faces) {
    const auto& face = mesh.boundary[static_cast<std::size_t>(number)];
    const auto& nodes = mesh.face_nodes[static_cast<std::size_t>(face.face)];
    const auto cell = static_cast<std::size_t>(face.cell);
    const auto own = cell_shape(mesh, x, cell);
    const auto w = primitive<D>(scheme.gas, amounts[cell], own.volume);
    WallFace<D> wall;
    wall.area = area_of<D>(nodes, x);
    const Vec<D> n = wall.area.normalized();
    wall.distance = (middle_of<D>(nodes, x) - own.centroid).dot(n);

    // The cell's gradient, as a step would have it.
    stencil_distances(
        mesh, cell, [&](std::size_t c) { return c == cell ? own.centroid : cell_shape(mesh, x, c).centroid; }, ways);
    weights.resize(ways.size());
    gradient_weights<D>(ways.data(), ways.size(), weights.data());
    Slopes<D> slopes{};
    Spread<D> spread;
    const auto own_row = row_of<D>(w);
    double bend = 0.0; // sum (c_j . n) (d_j . n)^2
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const auto j = static_cast<std::size_t>(mesh.stencil[static_cast<std::size_t>(mesh.stencil_begin[cell]) + k]);
      const auto other = primitive<D>(scheme.gas, amounts[j], cell_shape(mesh, x, j).volume);
      double along_n = 0.0;
      for (int d = 0; d < D; ++d) along_n += weights[k][static_cast<std::size_t>(d)] * n[d];
      bend += along_n * ways[k].dot(n) * ways[k].dot(n);
      add_to_gradient<D>(weights[k], row_of<D>(other) - own_row, slopes, spread);
    }
    double g = 0.0;
    for (int d = 0; d < D; ++d) g += slopes[static_cast<std::size_t>(d)][D + 1] * n[d];

    auto at_wall = w;
    if (scheme.order == 2) {
      std::size_t wall_offset = 0;
      offsets.clear();
      for (auto k = mesh.cell_face_begin[cell]; k < mesh.cell_face_begin[cell + 1]; ++k) {
        const Index code = mesh.cell_faces[static_cast<std::size_t>(k)];
        Vec<D> to_face = middle_of<D>(mesh.face_nodes[static_cast<std::size_t>(code / 2)], x) - own.centroid;
        if (code % 2 == 1 && mesh.is_periodic())
          to_face -= mesh.shifts[mesh.face_shift[static_cast<std::size_t>(code / 2)]];
        if (code == 2 * face.face) wall_offset = offsets.size();
        offsets.emplace_back();
        for (int d = 0; d < D; ++d) offsets.back()[static_cast<std::size_t>(d)] = to_face[d];
      }
      if (scheme.limiter.limiter != Limiter::none)
        limit_gradient<D>(
            scheme.limiter, own.volume, spread, offsets.size(),
            [&](std::size_t k) -> const std::array<double, D>& { return offsets[k]; }, slopes);
      Gradient<D> gradient;
      for (std::size_t d = 0; d < D; ++d) put_row<D>(slopes[d], gradient[d]);
      Values<D> there;
      put_row<D>(value_at<D>(own_row, gradient, offsets[wall_offset]), there);
      if (is_gas<D>(there)) at_wall = there;
    }
    Vec<D> velocity = Vec<D>::Zero();
    int n_nodes = 0;
    for (const Index node : nodes)
      if (node >= 0) {
        velocity += v.col(node);
        ++n_nodes;
      }
    const double s = velocity.dot(n) / n_nodes;
    wall.pressure = wall_pressure<D>(scheme.gas, at_wall, along<D>(at_wall, n.data()) - s);
    wall.sound_speed = sound_speed<D>(scheme.gas, at_wall);
    wall.cell_gradient = g;
    const double d = wall.distance, e = d - 0.5 * bend;
    const double part = e > 0.0 ? 0.5 * d * d / e : 0.0; // a single cell: no curvature is known
    wall.gradient = (wall.pressure - w[D + 1] - g * part) / (d - part);
    result.push_back(wall);
  }
  return result;
}

template std::vector<WallFace<2>> wall_faces(const Mesh<2>&, const Scheme<2>&, const std::vector<Values<2>>&,
                                             const Nodes<2>&, const Nodes<2>&, const std::vector<Index>&);
template std::vector<WallFace<3>> wall_faces(const Mesh<3>&, const Scheme<3>&, const std::vector<Values<3>>&,
                                             const Nodes<3>&, const Nodes<3>&, const std::vector<Index>&);

} // namespace mullion::euler
