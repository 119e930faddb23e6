// What the probe modules of both sides do alike: turn the texts of a case (a mesh, expressions) into panes and
// functions, with errors that name the parameter.
#pragma once

#include "expressions/expression.hpp"
#include "files/file_error.hpp"
#include "files/read.hpp"
#include "probes/sampled_surface.hpp"

#include <mullion/sdk/module.hpp>

#include <string>
#include <utility>

namespace mullion::probe_module {

/// The surface that the options `mesh` and `group` name.
/// @throws Error Errc::config
inline Pane read_pane(const std::string& text, const std::string& group)
{
  std::string place; // what the error does not say itself
  try {
    const auto mesh = mesh_files::read_or_generate(text);
    place = fmt::format("mesh = \"{}\": ", text);
    const auto surface = mesh_files::interface_of(mesh, group);
    Pane pane{0, surface.nodes, {}};
    for (const auto& [shape, connectivity] : surface.blocks)
      pane.blocks.push_back({static_cast<ElementType>(shape), connectivity}); // the numbers are the same
    return pane;
  } catch (const mesh_files::FileError& error) {
    throw Error(Errc::config, place + error.what());
  }
}

/// @param along  "normal" or "components"
/// @throws Error Errc::config, with the parameter's name
inline expressions::VectorExpression compiled(const char* parameter, const std::string& text, const std::string& along,
                                              Eigen::Index dimension)
{
  const auto meant = along == "normal" ? expressions::Along::normal : expressions::Along::components;
  try {
    return {text, meant, dimension};
  } catch (const expressions::ExpressionError& error) {
    throw Error(Errc::config, fmt::format("{}: {}", parameter, error.what()));
  }
}

/// The pane of a window, ready for sampling. @param text  the option `mesh`, for messages
/// @throws Error Errc::shape: it cannot be a surface
inline probes::SampledSurface sampled_pane(const Pane& pane, const std::string& text, bool is_reversed)
{
  auto mesh = surface::mesh_of_blocks(pane.coordinates, pane.blocks);
  const auto complaint = surface::complaint_about(mesh);
  MULLION_REQUIRE(complaint.empty(), Errc::shape, "mesh = \"{}\": {}", text, complaint);
  return probes::sampled(std::move(mesh), is_reversed);
}

} // namespace mullion::probe_module
