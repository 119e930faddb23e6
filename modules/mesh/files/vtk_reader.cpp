// The legacy format. Its binary numbers have the largest byte first, always.
#include "file_error.hpp"
#include "numbers.hpp"
#include "scanner.hpp"
#include "vtk.hpp"
#include "vtk_cells.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

namespace mullion::mesh_files {
namespace {

struct Reader {
  Scanner in;
  bool is_binary = false;
  bool is_swapped = is_little_endian();
  RawMesh mesh;
  Fail fail() const
  {
    return [this](const std::string& found, const std::string& right) { in.fail(found, right); };
  }
};

std::string upper(std::string_view word)
{
  std::string out(word);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::toupper(c); });
  return out;
}

std::optional<Number> type_of(std::string_view name)
{
  static constexpr std::pair<const char*, Number> types[] = {
      {"float", Number::f32},         {"double", Number::f64},        {"char", Number::i8},
      {"unsigned_char", Number::u8},  {"short", Number::i16},         {"unsigned_short", Number::u16},
      {"int", Number::i32},           {"unsigned_int", Number::u32},  {"long", Number::i64},
      {"unsigned_long", Number::u64}, {"vtktypeint32", Number::i32},  {"vtktypeint64", Number::i64},
      {"vtktypeuint32", Number::u32}, {"vtktypeuint64", Number::u64}, {"vtkIdType", Number::i32}};
  for (const auto& [known, type] : types)
    if (name == known) return type;
  return {};
}

Number read_type(Reader& r)
{
  const auto name = r.in.word();
  const auto type = type_of(name);
  if (!type) r.in.fail(join("a number type \"", shown(name), '"'), "float, double, int, long or another one of VTK");
  return *type;
}

std::size_t read_count(Reader& r, std::size_t numbers_each, const char* what)
{
  return r.in.fits(r.in.integer(what), numbers_each, what); // each number has a byte at least
}

std::vector<double> reals(Reader& r, std::size_t n, Number type)
{
  std::vector<double> values;
  if (!r.is_binary) {
    for (std::size_t i = 0; i < n; ++i) values.push_back(r.in.real("a coordinate"));
    return values;
  }
  r.in.line();
  const auto size = size_of(type);
  const auto bytes = r.in.raw(n * size, "the data");
  for (std::size_t i = 0; i < n; ++i) values.push_back(real_at(bytes.data() + i * size, type, r.is_swapped));
  return values;
}

std::vector<std::int64_t> integers(Reader& r, std::size_t n, Number type)
{
  if (is_real(type)) r.in.fail("real numbers", "integers");
  std::vector<std::int64_t> values;
  if (!r.is_binary) {
    for (std::size_t i = 0; i < n; ++i) values.push_back(r.in.integer("a number of a cell or a point"));
    return values;
  }
  r.in.line();
  const auto size = size_of(type);
  const auto bytes = r.in.raw(n * size, "the data");
  for (std::size_t i = 0; i < n; ++i) values.push_back(integer_at(bytes.data() + i * size, type, r.is_swapped));
  return values;
}

/// The points of each cell, one cell after the other.
struct Cells {
  std::vector<std::int64_t> nodes;
  std::vector<std::size_t> ends; ///< of each cell in `nodes`
  [[nodiscard]] std::size_t size() const { return ends.size(); }
  [[nodiscard]] std::span<const std::int64_t> operator[](std::size_t c) const
  {
    const auto begin = c == 0 ? 0 : ends[c - 1];
    return std::span(nodes).subspan(begin, ends[c] - begin);
  }
};

/// "CELLS n size" with, for each cell, the number of its points and these; from 5.1 on, offsets and points apart.
Cells read_cells(Reader& r)
{
  const auto n = read_count(r, 1, "the number of cells");
  const auto size = read_count(r, 1, "the size of the list of cells");
  Cells cells;
  if (!r.is_binary || n > 0)
    if (r.in.next_word() == "OFFSETS") {
      r.in.expect("OFFSETS");
      const auto offsets = integers(r, n, read_type(r));
      r.in.expect("CONNECTIVITY");
      cells.nodes = integers(r, size, read_type(r));
      for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
        if (offsets[c] < 0 || offsets[c + 1] < offsets[c] || static_cast<std::size_t>(offsets[c + 1]) > size)
          r.in.fail(join("offsets ", offsets[c], ", ", offsets[c + 1]), join("they grow from 0 to ", size));
        cells.ends.push_back(static_cast<std::size_t>(offsets[c + 1]));
      }
      if (!offsets.empty() && offsets.front() != 0) r.in.fail(join("the first offset ", offsets.front()), "it is 0");
      return cells;
    }
  const auto list = integers(r, size, Number::i32);
  std::size_t at = 0;
  for (std::size_t c = 0; c < n; ++c) {
    if (at >= size || list[at] < 0 || static_cast<std::size_t>(list[at]) > size - at - 1)
      r.in.fail(
          join("cell ", c, " goes beyond the end of the list of cells"),
          join("the list holds ", size, " numbers: that of a cell's points, and these, for each of ", n, " cells"));
    const auto count = static_cast<std::size_t>(list[at]);
    cells.nodes.insert(cells.nodes.end(), list.begin() + static_cast<std::ptrdiff_t>(at + 1),
                       list.begin() + static_cast<std::ptrdiff_t>(at + 1 + count));
    cells.ends.push_back(cells.nodes.size());
    at += 1 + count;
  }
  if (at != size) r.in.fail(join("the cells take ", at, " numbers"), join("the list announced ", size));
  return cells;
}

void read_points(Reader& r)
{
  const auto n = read_count(r, 3, "the number of points");
  if (n_nodes(r.mesh) > 0) r.in.fail("a second list of POINTS", "one is what is read");
  add_vtk_points(r.mesh, reals(r, 3 * n, read_type(r)));
}

/// A FIELD, which may stand anywhere: passed over.
void skip_field(Reader& r)
{
  r.in.word(); // its name
  const auto n_arrays = read_count(r, 1, "the number of arrays of a field");
  for (std::size_t a = 0; a < n_arrays; ++a) {
    r.in.word();
    const auto n_components = read_count(r, 1, "the number of components of an array");
    const auto n = read_count(r, std::max<std::size_t>(n_components, 1), "the number of entries of an array");
    const auto name = r.in.word();
    const auto type = type_of(name);
    if (!type) r.in.fail(join("an array of type \"", shown(name), "\" in a FIELD"), "numbers: save it without");
    reals(r, n_components * n, *type);
  }
}

/// METADATA reaches to the next empty line.
void skip_metadata(Reader& r)
{
  r.in.line();
  while (r.in.remaining() > 0 && !r.in.line().empty()) {
  }
}

void read_polydata(Reader& r, PolyCells kind)
{
  const auto cells = read_cells(r);
  for (std::size_t c = 0; c < cells.size(); ++c) add_vtk_poly_cell(r.mesh, kind, cells[c], r.fail());
}

void read_unstructured(Reader& r, const Cells& cells)
{
  const auto n = read_count(r, 1, "the number of cell types");
  if (n != cells.size()) r.in.fail(join(n, " cell types"), join("as many as cells: ", cells.size()));
  const auto types = integers(r, n, Number::i32);
  for (std::size_t c = 0; c < n; ++c) add_vtk_cell(r.mesh, types[c], cells[c], r.fail());
}

void read_sections(Reader& r, bool is_polydata)
{
  std::optional<Cells> cells;
  while (true) {
    const auto section = r.in.word();
    const auto keyword = upper(section);
    if (keyword.empty() || keyword == "CELL_DATA" || keyword == "POINT_DATA") break; // the mesh is complete
    if (keyword == "POINTS") read_points(r);
    else if (keyword == "FIELD") skip_field(r);
    else if (keyword == "METADATA") skip_metadata(r);
    else if (is_polydata && keyword == "VERTICES") read_polydata(r, PolyCells::vertices);
    else if (is_polydata && keyword == "LINES") read_polydata(r, PolyCells::lines);
    else if (is_polydata && keyword == "POLYGONS") read_polydata(r, PolyCells::polygons);
    else if (is_polydata && keyword == "TRIANGLE_STRIPS") read_polydata(r, PolyCells::strips);
    else if (!is_polydata && keyword == "CELLS" && !cells) cells = read_cells(r);
    else if (!is_polydata && keyword == "CELL_TYPES" && cells) {
      read_unstructured(r, *cells);
      return;
    } else
      r.in.fail(join("found \"", shown(section), '"'),
                is_polydata ? "expected POINTS, VERTICES, LINES, POLYGONS or TRIANGLE_STRIPS"
                            : "expected POINTS, CELLS, and then CELL_TYPES, once each");
  }
  if (!is_polydata) r.in.fail("the mesh ends without CELL_TYPES", "POINTS, CELLS and CELL_TYPES");
}

} // namespace

MeshFile parse_vtk(const std::string& file, std::string_view bytes, int dimension)
{
  Reader r{.in = Scanner(file, bytes), .mesh = {}};
  if (r.in.line().substr(0, 22) != "# vtk DataFile Version")
    r.in.fail("another first line", "\"# vtk DataFile Version 3.0\" or alike");
  r.in.line(); // title
  const auto encoding = r.in.word();
  if (upper(encoding) != "ASCII" && upper(encoding) != "BINARY")
    r.in.fail(join("found \"", shown(encoding), '"'), "expected ASCII or BINARY");
  r.is_binary = upper(encoding) == "BINARY";
  r.in.set_binary(r.is_binary);
  r.in.expect("DATASET");
  const auto kind = r.in.word();
  if (upper(kind) != "POLYDATA" && upper(kind) != "UNSTRUCTURED_GRID")
    r.in.fail(join("a data set ", shown(kind)), "POLYDATA or UNSTRUCTURED_GRID");
  read_sections(r, upper(kind) == "POLYDATA");
  try {
    return finished(std::move(r.mesh), dimension);
  } catch (const FileError& error) {
    throw FileError(join(file, ": ", error.what()));
  }
}

} // namespace mullion::mesh_files
