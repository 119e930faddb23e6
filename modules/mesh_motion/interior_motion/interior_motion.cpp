#include "interior_motion.hpp"

#include <utility>

namespace mullion::interior_motion {
namespace {

constexpr double poor_area_ratio = 0.2, poor_shape = 0.05; ///< below these a user should know

std::string place(const Eigen::VectorXd& x)
{
  std::string text;
  for (const double coordinate : x) text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", coordinate);
  return "(" + text + ")";
}

std::string without_blanks(const std::string& text)
{
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> words_of(const std::string& text)
{
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= text.size() && !without_blanks(text).empty();) {
    const auto comma = std::min(text.find(',', begin), text.size());
    words.push_back(without_blanks(text.substr(begin, comma - begin)));
    begin = comma + 1;
  }
  return words;
}

} // namespace

std::vector<FieldSpec> InteriorMotion::fields()
{
  using enum Location;
  return {
      output("volume", "velocity", node, vector, "m/s", "of the mesh"),
      state("volume", "coordinates", node, vector, "m", "of the nodes as this velocity moves them").overwritten(),
      output("volume", "min_area_ratio", pane, scalar, "1", "smallest area or volume by that in the reference mesh"),
      output("volume", "min_shape", pane, scalar, "1", "worst shape of an element: 1 is the best, 0 folded"),
      fixed("wall", "volume_node", node, scalar, "1", "number of the wall's node in volume").integer()};
}

std::vector<InputSpec> InteriorMotion::inputs()
{
  return {receive("wall", "velocity", Location::node, vector, "m/s", "of the wall"),
          receive("volume", "coordinates", Location::node, vector, "m", "where the fluid's nodes are before the step")
              .optional()};
}

void InteriorMotion::define(const TimeStep&)
{
  const auto volume = peer_pane("fluid", "volume");
  const auto wall = peer_pane("fluid", "");
  make_window("volume", {volume});
  make_window("wall", {wall});
  field("wall", "volume_node").index_now() = peer_indices("fluid", "", "volume_node");
  field("volume", "velocity").now().setZero();
  field("volume", "coordinates").now() = volume.coordinates;
  field("volume", "min_area_ratio").now()(0, 0) = 1.0;
  field("volume", "min_shape").now()(0, 0) = 1.0;
}

void InteriorMotion::attach()
{
  const auto volume = pane("volume");
  mesh_ = moving_mesh::mesh_of_blocks(volume.coordinates, volume.blocks);
  const auto complaint = moving_mesh::complaint_about(mesh_);
  MULLION_REQUIRE(complaint.empty(), Errc::shape, "the fluid's mesh: {}", complaint);
  const auto nodes = field("wall", "volume_node").indices();
  wall_nodes_.assign(nodes.data(), nodes.data() + nodes.size());
  for (const auto node : wall_nodes_)
    MULLION_REQUIRE(node >= 0 && node < mesh_.nodes.cols(), Errc::shape,
                    "the wall is said to have node {} of the volume; its nodes are 0 to {}", node,
                    mesh_.nodes.cols() - 1);

  measures_ = moving_mesh::element_measures(mesh_, mesh_.nodes);
  const auto sides = moving_sides();
  const auto given = moving_mesh::constraints(mesh_, wall_nodes_, sides);
  for (std::size_t s = 0; s < sides.size(); ++s)
    MULLION_REQUIRE(given.n_faces[s] > 0, Errc::config,
                    "{}: no face of the boundary lies on {}_{}; name flat sides of the fluid's mesh",
                    sides[s].is_free ? fmt::format("free = \"{}\"", options_.free)
                                     : fmt::format("slide = \"{}\"", options_.slide),
                    "xyz"[sides[s].axis], sides[s].is_upper ? "max" : "min");
  solver_ = solver(mesh_, measures_, given.is_given);
  MULLION_REQUIRE(
      solver_.is_regular(), Errc::shape,
      "part of the fluid's mesh can move without its wall and boundary; let fewer sides slide or be free than "
      "slide = \"{}\", free = \"{}\"",
      options_.slide, options_.free);

  velocity_ = field("volume", "velocity");
  coordinates_ = field("volume", "coordinates");
  min_area_ratio_ = field("volume", "min_area_ratio");
  min_shape_ = field("volume", "min_shape");
  wall_velocity_ = input("wall", "velocity");
  fluid_coordinates_ = input("volume", "coordinates");
}

std::vector<moving_mesh::Side> InteriorMotion::moving_sides() const
{
  std::vector<moving_mesh::Side> sides;
  for (const bool is_free : {false, true})
    for (const auto& word : words_of(is_free ? options_.free : options_.slide)) {
      const int axis = word.empty() ? -1 : static_cast<int>(std::string("xyz").find(word[0]));
      const bool is_side =
          axis >= 0 && axis < mesh_.dimension && (word.substr(1) == "_min" || word.substr(1) == "_max");
      MULLION_REQUIRE(is_side, Errc::config, "{} = \"{}\": \"{}\" is no side; there are x_min, x_max, y_min, y_max{}",
                      is_free ? "free" : "slide", is_free ? options_.free : options_.slide, word,
                      mesh_.dimension == 3 ? ", z_min, z_max" : "");
      const bool is_upper = word.substr(1) == "_max";
      for (const auto& side : sides)
        MULLION_REQUIRE(side.axis != axis || side.is_upper != is_upper, Errc::config,
                        "side {} is named twice, in slide = \"{}\" and free = \"{}\"; name it once", word,
                        options_.slide, options_.free);
      sides.push_back({axis, is_upper, is_free});
    }
  return sides;
}

void InteriorMotion::start(const TimeStep& initial)
{
  velocity_.now() = velocity_at(initial.end);
  coordinates_.now() = mesh_.nodes;
  write_quality(moving_mesh::quality_of(mesh_, measures_, mesh_.nodes));
}

void InteriorMotion::step(const TimeStep& step)
{
  // Before the first write: the committed level is what the own mesh starts from.
  Eigen::MatrixXd moved =
      fluid_coordinates_.is_connected() ? fluid_coordinates_.at(step.begin) : coordinates_.committed();
  const auto velocity = velocity_at(step.end);
  moved += step.dt * velocity;
  const auto quality = moving_mesh::quality_of(mesh_, measures_, moved);
  require_no_fold(quality, moved, step.end);
  warn_of(quality);
  velocity_.now() = velocity;
  coordinates_.now() = moved;
  write_quality(quality);
}

Eigen::MatrixXd InteriorMotion::velocity_at(double t)
{
  Eigen::MatrixXd velocity = Eigen::MatrixXd::Zero(mesh_.nodes.rows(), mesh_.nodes.cols());
  const auto wall = wall_velocity_.at(t);
  for (std::size_t k = 0; k < wall_nodes_.size(); ++k)
    velocity.col(wall_nodes_[k]) = wall.col(static_cast<Eigen::Index>(k));
  moving_mesh::complete_motion(solver_, velocity);
  return velocity;
}

void InteriorMotion::write_quality(const moving_mesh::Quality& quality) const
{
  min_area_ratio_.now()(0, 0) = quality.min_area_ratio;
  min_shape_.now()(0, 0) = quality.min_shape;
}

void InteriorMotion::warn_of(const moving_mesh::Quality& quality) const
{
  // Once: when the limit is passed, told from the committed outputs, because members keep no state.
  if (quality.min_area_ratio < poor_area_ratio && min_area_ratio_.committed()(0, 0) >= poor_area_ratio)
    log().warning("element {} around {} is down to {:.3g} of its reference size, below {}", quality.smallest,
                  place(moving_mesh::element_centre(mesh_, mesh_.nodes, quality.smallest)), quality.min_area_ratio,
                  poor_area_ratio);
  if (quality.min_shape < poor_shape && min_shape_.committed()(0, 0) >= poor_shape)
    log().warning("element {} around {} has the shape {:.3g} (1 is the best, 0 folded), below {}", quality.worst,
                  place(moving_mesh::element_centre(mesh_, mesh_.nodes, quality.worst)), quality.min_shape, poor_shape);
}

void InteriorMotion::require_no_fold(const moving_mesh::Quality& quality, const Eigen::MatrixXd& moved, double t) const
{
  MULLION_REQUIRE(
      !quality.is_folded, Errc::numeric,
      "the mesh would fold by t = {:.9g} s: element {} around {} (in the reference mesh {}), where a corner "
      "has {:.3g} of the element's reference size, expected more than 0; if the wall's motion is right, try "
      "elastic_mesh or a coarser mesh at the wall",
      t, quality.folded, place(moving_mesh::element_centre(mesh_, moved, quality.folded)),
      place(moving_mesh::element_centre(mesh_, mesh_.nodes, quality.folded)), quality.folded_ratio);
}

} // namespace mullion::interior_motion
