// Both versions, both encodings: numbers are read by one set of functions that know the encoding, so that the layout of
// each section is written down once.
#include "file_error.hpp"
#include "msh.hpp"
#include "numbers.hpp"
#include "raw_mesh.hpp"
#include "scanner.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <unordered_map>
#include <utility>

namespace mullion::mesh_files {
namespace {

using Key = std::pair<int, std::int64_t>; ///< dimension and number, of a physical group or an entity

struct Reader {
  Scanner in;
  int version = 4; ///< 2 or 4
  bool is_binary = false, is_swapped = false;
  RawMesh mesh;
  std::unordered_map<std::int64_t, Index> node_of_number;
  std::map<Key, std::string> names;                   ///< of physical groups
  std::map<Key, std::vector<std::int64_t>> physicals; ///< of each entity, version 4
  std::unordered_map<std::string, Element> known;     ///< version 2: an element is listed once a group

  std::int64_t integer(const char* what) { return number(Number::i32, what); }
  std::int64_t size(const char* what) { return number(Number::u64, what); }
  /// The number of a node or an element.
  std::int64_t tag(const char* what) { return version == 2 ? integer(what) : size(what); }
  double real(const char* what)
  {
    return is_binary ? real_at(in.raw(8, what).data(), Number::f64, is_swapped) : in.real(what);
  }
  /// Bytes that so many numbers take, at least.
  [[nodiscard]] std::size_t bytes(std::size_t integers, std::size_t sizes, std::size_t reals) const
  {
    return is_binary ? 4 * integers + 8 * (sizes + reals) : 2 * (integers + sizes + reals) - 1;
  }

private:
  std::int64_t number(Number type, const char* what)
  {
    return is_binary ? integer_at(in.raw(size_of(type), what).data(), type, is_swapped) : in.integer(what);
  }
};

std::string group_name(const Reader& r, Key physical)
{
  const auto name = r.names.find(physical);
  return name == r.names.end() ? std::to_string(physical.second) : name->second;
}

void read_names(Reader& r)
{
  const auto n = r.in.fits(r.in.integer("the number of names"), 6, "the number of names");
  for (std::size_t i = 0; i < n; ++i) {
    const auto dimension = r.in.integer("the dimension of a physical group");
    if (dimension < 0 || dimension > 3) r.in.fail(join("a group of dimension ", dimension), "dimensions are 0 to 3");
    const auto number = r.in.integer("the number of a physical group");
    r.names[{static_cast<int>(dimension), number}] = r.in.quoted("the name of a physical group");
  }
}

void add_node(Reader& r, std::int64_t number)
{
  const auto index = static_cast<Index>(n_nodes(r.mesh));
  if (!r.node_of_number.emplace(number, index).second)
    r.in.fail(join("a second node ", number), "each node has a number of its own");
  r.mesh.numbers.push_back(number);
}

void add_point(Reader& r)
{
  for (const char* what : {"the x of a node", "the y of a node", "the z of a node"})
    r.mesh.coordinates.push_back(r.real(what));
}

Shape shape_of(Reader& r, std::int64_t type)
{
  for (std::size_t s = 0; s < n_shapes; ++s)
    if (shape_facts[s].gmsh_type == type) return static_cast<Shape>(s);
  r.in.fail(join("an element of type ", type, " (", foreign_gmsh_type(type), ")"),
            "elements are linear: point, line, triangle, quadrangle, tetrahedron, hexahedron, prism or pyramid (save "
            "the mesh with Mesh.ElementOrder = 1)");
}

Element read_element(Reader& r, Shape shape, std::int64_t number)
{
  std::array<Index, most_nodes> nodes{};
  const auto n = static_cast<std::size_t>(facts(shape).n_nodes);
  for (std::size_t k = 0; k < n; ++k) {
    const auto node = r.tag("a node of an element");
    const auto index = r.node_of_number.find(node);
    if (index == r.node_of_number.end())
      r.in.fail(join("element ", number, " has the node ", node), "$Nodes, before it, has no node of that number");
    nodes[k] = index->second;
  }
  if (r.version == 4) return add_element(r.mesh, shape, {nodes.data(), n});
  // Version 2 lists an element of two physical groups twice.
  const std::string key =
      join(facts(shape).name, std::string_view(reinterpret_cast<const char*>(nodes.data()), n * sizeof(Index)));
  const auto known = r.known.find(key);
  if (known != r.known.end()) return known->second;
  return r.known[key] = add_element(r.mesh, shape, {nodes.data(), n});
}

// ---- version 2
// --------------------------------------------------------------------------------------------------------

void read_nodes_2(Reader& r)
{
  r.in.set_binary(false);
  const auto n = r.in.fits(r.in.integer("the number of nodes"), r.bytes(1, 0, 3), "the number of nodes");
  if (r.is_binary) r.in.line();
  r.in.set_binary(r.is_binary);
  for (std::size_t i = 0; i < n; ++i) {
    add_node(r, r.integer("the number of a node"));
    add_point(r);
  }
}

void read_element_2(Reader& r, Shape shape, std::int64_t number, std::int64_t n_tags)
{
  std::int64_t physical = 0; // the first tag; 0 is none
  for (std::int64_t t = 0; t < n_tags; ++t) {
    const auto tag = r.integer("a tag of an element");
    if (t == 0) physical = std::abs(tag);
  }
  const auto element = read_element(r, shape, number);
  if (physical != 0) add_to_group(r.mesh, group_name(r, {facts(shape).dimension, physical}), element);
}

void read_elements_2(Reader& r)
{
  r.in.set_binary(false);
  const auto n = r.in.fits(r.in.integer("the number of elements"), r.bytes(2, 0, 0), "the number of elements");
  if (r.is_binary) r.in.line();
  r.in.set_binary(r.is_binary);
  for (std::size_t i = 0; i < n;) {
    std::int64_t number = 0, n_here = 1;
    if (!r.is_binary) number = r.integer("the number of an element");
    const auto shape = shape_of(r, r.integer("the type of an element"));
    if (r.is_binary) n_here = r.integer("the number of elements of a block");
    const auto n_tags = r.integer("the number of tags");
    r.in.fits(n_tags, r.bytes(1, 0, 0), "the number of tags of an element");
    if (n_here < 1 || static_cast<std::size_t>(n_here) > n - i)
      r.in.fail(join("a block of ", n_here, " elements"), join("between 1 and ", n - i, " are left"));
    for (std::int64_t k = 0; k < n_here; ++k, ++i) {
      if (r.is_binary) number = r.integer("the number of an element");
      read_element_2(r, shape, number, n_tags);
    }
  }
}

// ---- version 4.1
// ------------------------------------------------------------------------------------------------------

void read_entities(Reader& r)
{
  std::array<std::size_t, 4> n{};
  for (auto& of_dimension : n)
    of_dimension = r.in.fits(r.size("the number of entities"), r.bytes(1, 1, 3), "the number of entities");
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::size_t i = 0; i < n[static_cast<std::size_t>(dimension)]; ++i) {
      const auto number = r.integer("the number of an entity");
      for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) r.real("a bound of an entity");
      auto& physicals = r.physicals[{dimension, number}];
      const char* what = "the number of physical groups of an entity";
      const auto n_physicals = r.in.fits(r.size(what), r.bytes(1, 0, 0), what);
      for (std::size_t k = 0; k < n_physicals; ++k) physicals.push_back(std::abs(r.integer("a physical group")));
      if (dimension == 0) continue;
      what = "the number of entities that bound another";
      const auto n_bounding = r.in.fits(r.size(what), r.bytes(1, 0, 0), what);
      for (std::size_t k = 0; k < n_bounding; ++k) r.integer("an entity that bounds another");
    }
}

/// Number of blocks and of things in all blocks, and two bounds that nobody needs.
std::pair<std::size_t, std::size_t> read_block_head(Reader& r, std::size_t bytes_each)
{
  const auto n_blocks = r.in.fits(r.size("the number of blocks"), r.bytes(3, 1, 0), "the number of blocks");
  const auto n = r.in.fits(r.size("the number of entries"), bytes_each, "the number of entries");
  r.size("the smallest number");
  r.size("the largest number");
  return {n_blocks, n};
}

void check_sum(Reader& r, std::size_t found, std::size_t announced, const char* what)
{
  if (found != announced)
    r.in.fail(join("the blocks hold ", found, ' ', what), join("the section announced ", announced));
}

void read_nodes_4(Reader& r)
{
  const auto [n_blocks, n] = read_block_head(r, r.bytes(0, 1, 3));
  for (std::size_t b = 0; b < n_blocks; ++b) {
    const auto dimension = r.integer("the dimension of an entity");
    r.integer("the number of an entity");
    const bool is_parametric = r.integer("whether nodes are parametric") != 0;
    if (dimension < 0 || dimension > 3) r.in.fail(join("an entity of dimension ", dimension), "dimensions are 0 to 3");
    const auto n_here = r.in.fits(r.size("the number of nodes"), r.bytes(0, 1, 3), "the number of nodes of a block");
    for (std::size_t i = 0; i < n_here; ++i) add_node(r, r.size("the number of a node"));
    for (std::size_t i = 0; i < n_here; ++i) {
      add_point(r);
      for (int k = 0; is_parametric && k < dimension; ++k) r.real("a parameter of a node");
    }
  }
  check_sum(r, n_nodes(r.mesh), n, "nodes");
}

void read_elements_4(Reader& r)
{
  const auto [n_blocks, n] = read_block_head(r, r.bytes(0, 2, 0));
  std::size_t found = 0;
  for (std::size_t b = 0; b < n_blocks; ++b) {
    const auto dimension = r.integer("the dimension of an entity");
    const auto entity = r.integer("the number of an entity");
    const auto shape = shape_of(r, r.integer("the type of an element"));
    if (dimension != facts(shape).dimension)
      r.in.fail(join("elements ", facts(shape).name, " on an entity of dimension ", dimension),
                join("they belong on one of dimension ", facts(shape).dimension));
    const auto n_here =
        r.in.fits(r.size("the number of elements"), r.bytes(0, 2, 0), "the number of elements of a block");
    const auto physicals = r.physicals.find({static_cast<int>(dimension), entity});
    for (std::size_t i = 0; i < n_here; ++i) {
      const auto number = r.size("the number of an element");
      const auto element = read_element(r, shape, number);
      if (physicals == r.physicals.end()) continue;
      for (const auto physical : physicals->second)
        add_to_group(r.mesh, group_name(r, {facts(shape).dimension, physical}), element);
    }
    found += n_here;
  }
  check_sum(r, found, n, "elements");
}

// ---- the file
// ---------------------------------------------------------------------------------------------------------

void read_format(Reader& r)
{
  r.in.expect("$MeshFormat");
  const auto version = r.in.word();
  if (version == "4.1") r.version = 4;
  else if (version.substr(0, 1) == "2") r.version = 2;
  else
    r.in.fail(join("version ", shown(version), " of the format"), "versions 2.2 and 4.1 are read (gmsh -format msh41)");
  const auto encoding = r.in.integer("0 for a text file or 1 for a binary one");
  if (encoding != 0 && encoding != 1) r.in.fail(join("encoding ", encoding), "0 is a text file, 1 a binary one");
  const auto size = r.in.integer("the size of a number, 8");
  if (size != 8) r.in.fail(join("numbers of ", size, " bytes"), "they have 8");
  r.is_binary = encoding == 1;
  if (r.is_binary) {
    r.in.line();
    const auto one = r.in.raw(4, "the number 1, which tells the order of bytes");
    r.is_swapped = integer_at(one.data(), Number::i32, false) != 1;
    if (integer_at(one.data(), Number::i32, r.is_swapped) != 1)
      r.in.fail("another number", "the number 1, which tells the order of bytes");
  }
  r.in.expect("$EndMeshFormat");
}

/// Pass a section that says nothing about the mesh itself.
void skip(Reader& r, const std::string& end)
{
  while (r.in.remaining() > 0)
    if (const auto line = r.in.line(); line.size() >= end.size() && line.substr(line.size() - end.size()) == end)
      return;
  r.in.fail("the file ends", join("expected ", end));
}

} // namespace

MeshFile parse_msh(const std::string& file, std::string_view bytes, int dimension)
{
  Reader r{Scanner(file, bytes), 4, false, false, {}, {}, {}, {}, {}};
  read_format(r);
  bool has_nodes = false, has_elements = false;
  while (true) {
    r.in.set_binary(false);
    const auto section = r.in.word();
    if (section.empty()) break;
    if (section.front() != '$') r.in.fail(join("found \"", shown(section), '"'), "expected a section, $Name");
    const auto end = join("$End", section.substr(1));
    const bool is_nodes = section == "$Nodes", is_elements = section == "$Elements";
    if ((is_nodes && has_nodes) || (is_elements && has_elements))
      r.in.fail(join("a second section ", section), "one is what is read");
    if (section == "$PartitionedEntities") r.in.fail("a partitioned mesh", "save it unpartitioned (gmsh -part 0)");
    if (section == "$PhysicalNames") read_names(r);
    else if (is_nodes || is_elements || (section == "$Entities" && r.version == 4)) {
      if (r.is_binary) r.in.line();
      r.in.set_binary(r.is_binary);
      if (is_nodes) r.version == 2 ? read_nodes_2(r) : read_nodes_4(r);
      else if (is_elements) r.version == 2 ? read_elements_2(r) : read_elements_4(r);
      else read_entities(r);
    } else {
      skip(r, end);
      continue;
    }
    r.in.set_binary(false);
    has_nodes = has_nodes || is_nodes;
    has_elements = has_elements || is_elements;
    r.in.expect(end);
  }
  if (!has_nodes || !has_elements)
    r.in.fail(has_nodes ? "the file has no $Elements" : "the file has no $Nodes", "a mesh has both");
  try {
    return finished(std::move(r.mesh), dimension);
  } catch (const FileError& error) {
    throw FileError(join(file, ": ", error.what()));
  }
}

} // namespace mullion::mesh_files
