#include "read.hpp"

#include "file_error.hpp"
#include "generator_text.hpp"
#include "msh.hpp"
#include "vtk.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace mullion::mesh_files {
namespace {

bool ends_in(const std::string& text, const char* ending) { return text.ends_with(ending); }

} // namespace

MeshFile read_mesh(const std::string& file, int dimension)
{
  using Parse = MeshFile (*)(const std::string&, std::string_view, int);
  const Parse parse = ends_in(file, ".msh") ? parse_msh : ends_in(file, ".vtk") ? parse_vtk : parse_vtu;
  if (parse == parse_vtu && !ends_in(file, ".vtu"))
    throw FileError(join(file, ": of unknown format; mesh files end in .msh, .vtk or .vtu"));
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad())
    throw FileError(join(file, ": cannot be read (", std::strerror(errno),
                         "); a path is taken from the folder in which the run was started"));
  return parse(file, bytes, dimension);
}

void write_mesh(const MeshFile& mesh, const std::string& file)
{
  if (!ends_in(file, ".msh") && !ends_in(file, ".vtu"))
    throw FileError(join(file, ": of unknown format; meshes are written as .msh or .vtu"));
  const auto text = ends_in(file, ".msh") ? msh_text(mesh) : vtu_text(mesh);
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw FileError(join(file, ": cannot be written (", std::strerror(errno), ")"));
}

MeshFile read_or_generate(const std::string& text, int dimension)
{
  if (!is_generator_text(text)) return read_mesh(text, dimension);
  auto mesh = generated(text);
  return dimension == 0 ? mesh : lifted(std::move(mesh), dimension);
}

MeshFile interface_of(const MeshFile& mesh, const std::string& group)
{
  auto surface = group.empty() ? mesh : only(mesh, find_group(mesh, group));
  const int dimension = facts(surface.blocks.front().shape).dimension;
  for (const auto& block : surface.blocks)
    if (facts(block.shape).dimension != dimension || dimension == 3) {
      std::string known;
      for (const auto& g : mesh.groups)
        if (g.dimension < 3) known += join(known.empty() ? "" : ", ", '"', g.name, '"');
      const std::string other = facts(block.shape).dimension == dimension ? "" : join(" and ", facts(block.shape).name);
      throw FileError(join("the mesh has elements ", facts(surface.blocks.front().shape).name, other,
                           ", so it is no surface; name the group that is: ", known.empty() ? "it has none" : known));
    }
  const int space = std::max(surface.dimension, dimension + 1);
  surface.groups.clear();
  return lifted(std::move(surface), space);
}

} // namespace mullion::mesh_files
