#include "run/snapshot.hpp"

namespace mullion::run {

std::vector<io::WindowData> snapshot_of(Session& session, shm::Storage storage)
{
  const auto& control = session.control();
  std::vector<io::WindowData> out;
  for (std::uint32_t w = 0; w < control.n_windows; ++w) {
    if (control.windows[w].owner != shm::Owner::module) continue;
    const auto& view = session.windows().view(w);
    auto& window = out.emplace_back();
    window.name = control.windows[w].name;
    for (std::uint32_t p = 0; p < view.header().n_panes; ++p) {
      auto& pane = window.panes.emplace_back();
      const auto raw = view.pane(p, pane.blocks);
      pane.id = raw.id;
      pane.dimension = raw.dimension;
      pane.n_nodes = raw.n_nodes;
      pane.n_elements = raw.n_elements;
      pane.reference_coordinates = raw.coordinates;
      const auto fields = view.fields();
      for (std::uint32_t f = 0; f < fields.size(); ++f) {
        if (fields[f].pane != p || static_cast<shm::Storage>(fields[f].storage) != storage) continue;
        const auto* data = session.windows().locate(w, f, 1, control.epoch.load()).data;
        io::FieldData field;
        field.name = fields[f].name;
        field.unit = fields[f].unit;
        field.location = fields[f].location;
        field.components = fields[f].components;
        field.entities = fields[f].entities;
        if (fields[f].scalar == MULLION_I32) field.i32 = reinterpret_cast<const std::int32_t*>(data);
        else field.f64 = reinterpret_cast<const double*>(data);
        pane.fields.push_back(std::move(field));
      }
    }
  }
  return out;
}

} // namespace mullion::run
