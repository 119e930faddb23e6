#include "generator_text.hpp"

#include "file_error.hpp"
#include "generators.hpp"
#include "scanner.hpp"

#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <set>

namespace mullion::mesh_files {
namespace {

std::vector<std::string> split(const std::string& text, char separator)
{
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) parts.emplace_back();
    else parts.back() += c;
  }
  return parts;
}

/// A generator's text in pieces. Each piece that a generator asks for is taken off; what is left is unknown.
class Pieces {
public:
  explicit Pieces(const std::string& text) : text_(text)
  {
    const auto colon = text.find(':');
    name_ = text.substr(0, colon);
    auto parts = split(text.substr(colon + 1), ',');
    for (const auto& n : split(parts.front(), 'x')) {
      std::int64_t value = 0;
      if (!to_number(n, value) || value < 1 || value > 20'000'000)
        fail(join("\"", n, "\" as a number of cells"), "integers from 1 on, say 32x24");
      cells_.push_back(static_cast<int>(value));
    }
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const auto equals = parts[i].find('=');
      const auto key = parts[i].substr(0, equals);
      if (!options_.emplace(key, equals == std::string::npos ? "" : parts[i].substr(equals + 1)).second)
        fail(join("\"", key, "\" twice"), "each option once");
    }
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<int>& cells() const { return cells_; }

  void expect_cells(std::size_t n, const char* right) const
  {
    if (cells_.size() != n) fail(join(cells_.size(), " numbers of cells"), right);
  }

  /// Which of some words is there: its number, 0 if none is.
  std::size_t one_of(std::initializer_list<const char*> words)
  {
    std::size_t found = 0;
    const char* before = nullptr;
    for (const auto* word = words.begin(); word != words.end(); ++word) {
      if (!take_word(*word)) continue;
      if (before != nullptr) fail(join("both ", before, " and ", *word), "one of them");
      before = *word;
      found = static_cast<std::size_t>(word - words.begin());
    }
    return found;
  }

  Cells shapes() { return static_cast<Cells>(one_of({"quads", "triangles", "alternating", "delaunay"})); }

  double number(const char* key, double otherwise)
  {
    const auto value = list(key, ':', Eigen::VectorXd::Constant(1, otherwise));
    if (value.size() != 1) fail(join(key, " of ", value.size(), " numbers"), "one number");
    return value[0];
  }

  double angle(const char* key, double otherwise) { return number(key, otherwise) * std::numbers::pi / 180.0; }

  /// Numbers with separators; as many as there are otherwise, if `is_fixed`.
  Eigen::VectorXd list(const char* key, char separator, const Eigen::VectorXd& otherwise, bool is_fixed = true)
  {
    known_.insert(key);
    const auto option = options_.find(key);
    if (option == options_.end()) return otherwise;
    const auto parts = split(option->second, separator);
    Eigen::VectorXd values(static_cast<Eigen::Index>(parts.size()));
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (!to_number(parts[i], values[static_cast<Eigen::Index>(i)]) ||
          !std::isfinite(values[static_cast<Eigen::Index>(i)]))
        fail(join("\"", parts[i], "\" in ", key), join("numbers, with ", separator, " between them"));
    if (is_fixed && values.size() != otherwise.size())
      fail(join(key, " of ", values.size(), " numbers"), join(otherwise.size(), ", with ", separator, " between them"));
    options_.erase(option);
    return values;
  }

  Perturbation perturbation()
  {
    const double part = number("perturb", 0.0), seed = number("seed", 1.0);
    if (!(seed >= 0.0 && seed < 0x1p53) || seed != std::floor(seed))
      fail(join("the seed ", seed), "an integer from 0 on");
    return {part, static_cast<std::uint64_t>(seed)};
  }

  void expect_all_used() const
  {
    if (options_.empty()) return;
    std::string known;
    for (const auto& option : known_) known += join(known.empty() ? "" : ", ", option);
    fail(join("the option \"", options_.begin()->first, '"'), join("it takes ", known));
  }

  [[noreturn]] void fail(const std::string& found, const std::string& right) const
  {
    throw FileError(join("mesh \"", text_, "\": ", found, "; ", right));
  }

private:
  bool take_word(const char* word)
  {
    known_.insert(word);
    const auto option = options_.find(word);
    if (option == options_.end()) return false;
    if (!option->second.empty()) fail(join(word, " = ", option->second), join(word, " alone"));
    options_.erase(option);
    return true;
  }

  std::string text_, name_;
  std::vector<int> cells_;
  std::map<std::string, std::string> options_;
  std::set<std::string> known_;
};

Grid grid(Pieces& p)
{
  p.expect_cells(2, "two, say 32x24");
  const auto cells = p.shapes();
  return {p.cells()[0], p.cells()[1], cells, p.perturbation()};
}

MeshFile line_of(Pieces& p)
{
  p.expect_cells(1, "one, say 10");
  const auto from = p.list("from", ':', Eigen::Vector2d(0.0, 0.0), false);
  const auto to = p.list("to", ':', Eigen::Vector2d(1.0, 0.0), false);
  p.expect_all_used();
  return line(p.cells()[0], from, to);
}

MeshFile arc_of(Pieces& p)
{
  p.expect_cells(1, "one, say 20");
  const double radius = p.number("radius", 1.0), from = p.angle("from", 0.0), angle = p.angle("angle", 90.0);
  const Eigen::Vector2d centre = p.list("centre", ':', Eigen::Vector2d(0.0, 0.0));
  p.expect_all_used();
  return arc(p.cells()[0], radius, from, angle, centre);
}

MeshFile rectangle_of(Pieces& p)
{
  const auto cells = grid(p);
  const auto size = p.list("size", 'x', Eigen::Vector2d(1.0, 1.0));
  const Eigen::Vector3d origin = p.list("origin", ':', Eigen::Vector3d(0.0, 0.0, 0.0));
  p.expect_all_used();
  return rectangle(cells, size[0], size[1], origin);
}

MeshFile cap_of(Pieces& p)
{
  p.expect_cells(2, "two, rings x cells around, say 8x32");
  const auto cells = p.shapes();
  const double radius = p.number("radius", 1.0), angle = p.angle("angle", 60.0);
  p.expect_all_used();
  return spherical_cap(p.cells()[0], p.cells()[1], cells, radius, angle);
}

MeshFile wing_of(Pieces& p)
{
  const auto cells = grid(p);
  const Wing wing{p.number("span", 1.0), p.number("root", 1.0), p.number("tip", 1.0),
                  p.angle("sweep", 0.0), p.angle("twist", 0.0), p.number("camber", 0.0)};
  p.expect_all_used();
  return wing_panel(cells, wing);
}

MeshFile box_of(Pieces& p)
{
  if (p.cells().size() == 2) {
    const auto cells = grid(p);
    const Eigen::Vector2d size = p.list("size", 'x', Eigen::Vector2d(1.0, 1.0));
    const Eigen::Vector2d origin = p.list("origin", ':', Eigen::Vector2d(0.0, 0.0));
    const Division division{p.list("ratio", ':', Eigen::Vector2d(1.0, 1.0)), p.number("skew", 0.0)};
    p.expect_all_used();
    return box_2d(cells, size, origin, division);
  }
  p.expect_cells(3, "two in the plane or three in space, say 8x8x4");
  const auto volumes = static_cast<Volumes>(p.one_of({"hexes", "tets"}));
  const auto perturb = p.perturbation();
  const Eigen::Vector3d size = p.list("size", 'x', Eigen::Vector3d(1.0, 1.0, 1.0));
  const Eigen::Vector3d origin = p.list("origin", ':', Eigen::Vector3d(0.0, 0.0, 0.0));
  const Eigen::Vector3d ratio = p.list("ratio", ':', Eigen::Vector3d(1.0, 1.0, 1.0));
  p.expect_all_used();
  return box_3d({p.cells()[0], p.cells()[1], p.cells()[2]}, volumes, size, origin, perturb, ratio);
}

Arch arch(Pieces& p)
{
  const Arch usual;
  return {p.number("length", usual.length), p.number("thickness", usual.thickness),
          p.angle("angle", usual.angle * 180.0 / std::numbers::pi)};
}

MeshFile arch_of(Pieces& p)
{
  const auto cells = grid(p);
  const auto shape = arch(p);
  p.expect_all_used();
  return solid_arch(cells, shape);
}

MeshFile duct_arch_of(Pieces& p)
{
  const auto cells = grid(p);
  const auto shape = arch(p);
  const ArchSurroundings usual;
  const ArchSurroundings around{p.number("height", usual.height), p.number("growth", usual.growth),
                                p.number("largest", usual.largest), p.number("left", usual.left),
                                p.number("right", usual.right)};
  p.expect_all_used();
  return duct_over_arch(cells, shape, around);
}

MeshFile box_arch_of(Pieces& p)
{
  const auto cells = grid(p);
  const auto shape = arch(p);
  const double height = p.number("height", 0.2), growth = p.number("growth", 1.04);
  p.expect_all_used();
  return box_over_arch(cells, shape, height, growth);
}

MeshFile bump_of(Pieces& p)
{
  const auto cells = grid(p);
  const double height = p.number("height", 0.1);
  p.expect_all_used();
  return channel_with_bump(cells, height);
}

MeshFile cook_of(Pieces& p)
{
  const auto cells = grid(p);
  p.expect_all_used();
  return cooks_membrane(cells);
}

const std::map<std::string, MeshFile (*)(Pieces&)>& generators()
{
  static const std::map<std::string, MeshFile (*)(Pieces&)> all = {
      {"line", line_of}, {"arc", arc_of},   {"rectangle", rectangle_of}, {"cap", cap_of},           {"wing", wing_of},
      {"box", box_of},   {"arch", arch_of}, {"duct_arch", duct_arch_of}, {"box_arch", box_arch_of}, {"bump", bump_of},
      {"cook", cook_of}};
  return all;
}

} // namespace

bool is_generator_text(const std::string& text)
{
  const auto colon = text.find(':');
  return colon != std::string::npos && generators().contains(text.substr(0, colon));
}

MeshFile generated(const std::string& text)
{
  if (!is_generator_text(text)) {
    std::string known;
    for (const auto& [name, make] : generators()) known += join(known.empty() ? "" : ", ", name);
    throw FileError(join("mesh \"", text, "\": no generator; there are ", known, ", each followed by a colon"));
  }
  Pieces pieces(text);
  try {
    return generators().at(pieces.name())(pieces);
  } catch (const FileError& error) {
    if (std::string(error.what()).rfind("mesh \"", 0) == 0) throw;
    throw FileError(join("mesh \"", text, "\": ", error.what()));
  }
}

} // namespace mullion::mesh_files
