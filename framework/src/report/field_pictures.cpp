#include "report/field_pictures.hpp"

#include "io/atomic_file.hpp"
#include "io/hdf5_image.hpp"
#include "io/xdmf_index.hpp"
#include "report/html.hpp"
#include "report/plane_mesh.hpp"

#include <mullion/sdk/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace mullion::report {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_fields = 4; // of a window; with two pictures of the displacement they are six

// A displacement of less than this part of the mesh's extent is hard to see, so it is magnified in a second picture.
constexpr double visible_part = 0.02;
// Below this one it is nothing but the round-off of sums of steps: there is nothing to magnify.
constexpr double still_part = 1e-9;

/// An open file of the results.
class Opened {
public:
  explicit Opened(const fs::path& path) : image_(io::read_checked(path)), reader_(image_, path.string()) {}
  const io::ImageReader& operator*() const { return reader_; }
  const io::ImageReader* operator->() const { return &reader_; }

private:
  io::Bytes image_;
  io::ImageReader reader_;
};

struct Output {
  std::int64_t step = 0;
  double time = 0.0; ///< [s]
};

/// The last output that the index names; none if there is no index or it names none.
std::optional<Output> last_output(const fs::path& folder)
{
  const auto path = folder / "results.h5";
  if (!fs::exists(path)) return {};
  const Opened index(path);
  const auto steps = index->i64("/steps");
  const auto times = index->f64("/times");
  if (steps.empty()) return {};
  MULLION_REQUIRE(steps.size() == times.size(), Errc::io, "{}: {} steps but {} times", path.string(), steps.size(),
                  times.size());
  return Output{steps.back(), times.back()};
}

// ---- which fields --------------------------------------------------------------------------------------------------

struct Field {
  std::string name, unit;
  bool is_on_elements = false;
  std::size_t n_components = 1;

  /// Pressures and stresses first, then speeds, numbers such as Mach's, the rest; what is computed on elements before
  /// what is on nodes.
  [[nodiscard]] auto rank() const
  {
    return std::tuple(unit == "Pa" ? 0 : unit == "m/s" ? 1 : unit == "1" ? 2 : 3, !is_on_elements, name, unit);
  }
  bool operator<(const Field& other) const { return rank() < other.rank(); }
};

/// Where nodes are and how far they moved is what every picture shows, and no field to choose.
bool is_place(const std::string& name)
{
  const std::set<std::string> places{"geometry", "coordinates", "position", "displacement"};
  return places.contains(name);
}

std::optional<Field> describe(const io::ImageReader& output, const std::string& group, const std::string& name)
{
  const auto path = group + "/" + name;
  const auto location = output.text_attribute(path, "location");
  if (location == "pane" || is_place(name) || !output.holds_f64(path)) return {};
  const auto extents = output.extents(path);
  Field field{name, output.text_attribute(path, "unit"), location == "element",
              extents.size() == 1 ? 1 : static_cast<std::size_t>(extents.back())};
  const bool is_speed = field.n_components == 2 && field.unit == "m/s";
  if (field.n_components != 1 && !is_speed) return {};
  return field;
}

/// Scalars, and velocities by their magnitude, in the order in which they are drawn.
std::set<Field> fields_of(const io::ImageReader& output, const PlaneWindow& window)
{
  std::set<Field> fields;
  for (const auto& pane : window.panes) {
    if (!output.has(pane.group)) continue;
    for (const auto& name : output.names(pane.group))
      if (auto field = describe(output, pane.group, name)) fields.insert(std::move(*field));
  }
  return fields;
}

// ---- where and what ------------------------------------------------------------------------------------------------

/// Where the nodes are: `coordinates`, else `position`, else reference plus `displacement`, else reference. All of it
/// but `position` the results' `geometry` has already.
std::vector<Point> current_positions(const io::ImageReader& output, const PlanePane& pane)
{
  const auto is_node_vector = [&](const std::string& path) {
    return output.has(path) && output.holds_f64(path) && output.text_attribute(path, "location") == "node" &&
           output.text_attribute(path, "unit") == "m" && output.extents(path).size() == 2 &&
           output.extents(path)[1] == 2;
  };
  if (!output.has(pane.group)) return pane.reference;
  auto path = pane.group + "/geometry";
  if (!is_node_vector(pane.group + "/coordinates") && is_node_vector(pane.group + "/position"))
    path = pane.group + "/position";
  const auto values = output.f64(path);
  const auto n_components = static_cast<std::size_t>(output.extents(path).back());
  const auto n_nodes = pane.reference.size();
  MULLION_REQUIRE(n_components >= 2 && values.size() == n_components * n_nodes, Errc::io,
                  "{}: {} numbers, expected at least two for each of {} nodes", path, values.size(), n_nodes);
  std::vector<Point> now;
  for (std::size_t i = 0; i < n_nodes; ++i) now.push_back({values[n_components * i], values[n_components * i + 1]});
  return now;
}

double distance(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// One number an entity: the scalar, or the vector's magnitude.
std::vector<double> magnitudes(std::vector<double> values, std::size_t n_components)
{
  if (n_components == 1) return values;
  std::vector<double> lengths;
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) lengths.push_back(std::hypot(values[i], values[i + 1]));
  return lengths;
}

double mean_of_nodes(const std::vector<double>& values, const PlaneElement& element)
{
  double sum = 0.0;
  for (std::size_t c = 0; c < element.n_nodes; ++c) sum += values[element.nodes[c]];
  return sum / static_cast<double>(element.n_nodes);
}

Cell cell_at(const std::vector<Point>& positions, const PlaneElement& element, double value)
{
  Cell cell;
  cell.n_corners = element.n_nodes;
  for (std::size_t c = 0; c < element.n_nodes; ++c) cell.corners[c] = positions[element.nodes[c]];
  cell.value = value;
  return cell;
}

// ---- pictures ------------------------------------------------------------------------------------------------------

/// A window at one output.
struct Moved {
  const PlaneWindow& window;
  std::vector<std::vector<Point>> positions{}; ///< of the nodes, pane by pane
  std::string time{};                          ///< "t = 0.5 s"
};

void add_picture(Page& page, Picture picture)
{
  const auto n_drawn = static_cast<std::size_t>(std::count_if(picture.cells.begin(), picture.cells.end(), is_drawn));
  if (n_drawn == 0) {
    page.add(fmt::format("<p>{}: no value is finite, so there is no picture.</p>\n", escape(picture.title)));
    return;
  }
  const auto say = [&](const std::string& text) { picture.caption += (picture.caption.empty() ? "" : " ") + text; };
  if (const auto n = picture.cells.size() - n_drawn; n > 0)
    say(n == 1 ? "1 cell is not finite and left out." : fmt::format("{} cells are not finite and left out.", n));
  if (n_drawn > max_svg_cells) say(fmt::format("{} cells, all drawn; too many for an SVG.", n_drawn));
  page.add(std::move(picture));
}

Picture field_picture(const io::ImageReader& output, const Moved& moved, const Field& field)
{
  Picture picture;
  const auto what = field.n_components == 1 ? field.name : "magnitude of " + field.name;
  picture.name = file_name(moved.window.name + "-" + field.name);
  picture.title = fmt::format("{}: {} at {}", moved.window.name, what, moved.time);
  picture.label = field.unit.empty() ? what : fmt::format("{} [{}]", what, field.unit);
  if (!field.is_on_elements) picture.caption = "Of each cell the mean of its nodes.";
  for (std::size_t p = 0; p < moved.window.panes.size(); ++p) {
    const auto& pane = moved.window.panes[p];
    const auto path = pane.group + "/" + field.name;
    if (!output.has(path)) continue;
    const auto here = describe(output, pane.group, field.name);
    if (!here || *here < field || field < *here) continue; // of this name, but on others, or of another unit
    const auto values = magnitudes(output.f64(path), field.n_components);
    for (const auto& element : pane.elements)
      picture.cells.push_back(
          cell_at(moved.positions[p], element,
                  field.is_on_elements ? values.at(element.number) : mean_of_nodes(values, element)));
  }
  return picture;
}

/// How far the nodes have moved, drawn `factor` times as far.
Picture displacement_picture(const Moved& moved, double factor)
{
  Picture picture;
  picture.name = file_name(moved.window.name + "-displacement" + (factor == 1.0 ? "" : "-magnified"));
  picture.title = fmt::format("{}: displacement at {}", moved.window.name, moved.time);
  if (factor != 1.0) picture.title += fmt::format(", drawn {:g} times as large", factor);
  picture.label = "displacement [m]";
  picture.caption = "Of each cell the mean of its nodes' magnitudes. Orange: the boundary before it moved.";
  for (std::size_t p = 0; p < moved.window.panes.size(); ++p) {
    const auto& pane = moved.window.panes[p];
    std::vector<Point> drawn;
    std::vector<double> lengths;
    for (std::size_t i = 0; i < pane.reference.size(); ++i) {
      const auto &from = pane.reference[i], &to = moved.positions[p][i];
      drawn.push_back({from.x + factor * (to.x - from.x), from.y + factor * (to.y - from.y)});
      lengths.push_back(distance(from, to));
    }
    for (const auto& element : pane.elements)
      picture.cells.push_back(cell_at(drawn, element, mean_of_nodes(lengths, element)));
    for (const auto& [a, b] : boundary_edges(pane)) picture.outline.push_back({pane.reference[a], pane.reference[b]});
  }
  return picture;
}

/// How far the node moved that moved farthest [m]; nodes at no finite place do not count.
double largest_displacement(const Moved& moved)
{
  double largest = 0.0;
  for (std::size_t p = 0; p < moved.window.panes.size(); ++p)
    for (std::size_t i = 0; i < moved.positions[p].size(); ++i)
      if (const double d = distance(moved.window.panes[p].reference[i], moved.positions[p][i]); std::isfinite(d))
        largest = std::max(largest, d);
  return largest;
}

void add_window(Page& page, const io::ImageReader& output, const Moved& moved)
{
  std::string others;
  std::size_t n_drawn = 0;
  for (const auto& field : fields_of(output, moved.window)) {
    if (n_drawn++ < max_fields) add_picture(page, field_picture(output, moved, field));
    else others += (others.empty() ? "" : ", ") + field.name;
  }
  const double largest = largest_displacement(moved), size = extent(moved.window);
  if (largest > still_part * size) {
    add_picture(page, displacement_picture(moved, 1.0));
    if (largest < visible_part * size) add_picture(page, displacement_picture(moved, magnification(largest, size)));
  }
  if (!others.empty())
    page.add(fmt::format("<p>{} has more fields, which results.xdmf shows: {}</p>\n", escape(moved.window.name),
                         escape(others)));
}

} // namespace

double magnification(double largest, double extent)
{
  const double wanted = 0.1 * extent / largest;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double digit : {5.0, 2.0})
    if (digit * decade <= wanted) return digit * decade;
  return decade;
}

void add_field_pictures(Page& page, const fs::path& folder)
{
  const auto last = last_output(folder);
  if (!last) return;
  const auto mesh_file = folder / "results" / "mesh.h5";
  const auto output_file = folder / "results" / (io::output_name(last->step) + ".h5");
  for (const auto& file : {mesh_file, output_file})
    if (!fs::exists(file)) {
      page.add("<h2>Fields</h2>\n<p>There is no " + escape(file.filename().string()) +
               " in results/, though results.h5 names it.</p>\n");
      return;
    }
  const auto windows = read_plane_windows(*Opened(mesh_file), mesh_file.string());
  if (windows.empty()) return;
  const Opened output(output_file);
  page.add("<h2>Fields</h2>\n" + fmt::format("<p>The last output, of step {}, t = {} s; each mesh where it lay "
                                             "then.</p>\n",
                                             last->step, last->time));
  for (const auto& window : windows) {
    Moved moved{window};
    moved.time = fmt::format("t = {:.6g} s", last->time);
    for (const auto& pane : window.panes) moved.positions.push_back(current_positions(*output, pane));
    add_window(page, *output, moved);
  }
}

} // namespace mullion::report
