// Damaged mesh files: whatever is cut off or changed, the reader gives a sound mesh or says what is wrong; it neither
// crashes nor reads beyond the file (which the sanitizers would see).
#include "files/file_error.hpp"
#include "files/msh.hpp"
#include "files/vtk.hpp"
#include "support/mesh_samples.hpp"

#include <doctest/doctest.h>

#include <random>
#include <string>

using namespace mullion::mesh_files;
using namespace mullion::testing;

namespace {

struct Sample {
  const char* name;
  MeshFile (*parse)(const std::string& file, std::string_view bytes, int dimension);
};

constexpr Sample samples[] = {
    {"cube_msh41_a.msh", parse_msh}, {"cube_msh41_b.msh", parse_msh}, {"cube_msh2_a.msh", parse_msh},
    {"cube_msh2_b.msh", parse_msh},  {"shapes_a.vtk", parse_vtk},     {"shapes_b.vtk", parse_vtk},
    {"shapes_a.vtu", parse_vtu},     {"shapes_b.vtu", parse_vtu},     {"shapes_z.vtu", parse_vtu}};
constexpr int n_damages = 2000;

/// Read it: an error with a text is fine, any other exception ends the test.
bool is_refused(const Sample& sample, const std::string& bytes)
{
  try {
    const auto mesh = sample.parse(sample.name, bytes, 0);
    CHECK(is_sound(mesh));
    return false;
  } catch (const FileError& error) {
    CHECK(std::string(error.what()).find("; ") != std::string::npos); // what is wrong; what would be right
    return true;
  }
}

} // namespace

TEST_CASE("a mesh file that is cut off is an error, or sound where only its end is missing")
{
  std::mt19937 random(7);
  for (const auto& sample : samples) {
    CAPTURE(sample.name);
    const auto whole = mesh_sample(sample.name);
    REQUIRE(!is_refused(sample, whole));
    int n_refused = 0;
    for (int i = 0; i < n_damages; ++i)
      n_refused += is_refused(sample, whole.substr(0, random() % whole.size())) ? 1 : 0;
    CHECK(n_refused > n_damages / 2); // Gmsh's legacy files end in data that are passed over
  }
}

TEST_CASE("a mesh file with changed bytes is an error or a sound mesh")
{
  std::mt19937 random(11);
  for (const auto& sample : samples) {
    CAPTURE(sample.name);
    const auto whole = mesh_sample(sample.name);
    int n_refused = 0;
    for (int i = 0; i < n_damages; ++i) {
      auto bytes = whole;
      for (unsigned k = 0; k <= random() % 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
      n_refused += is_refused(sample, bytes) ? 1 : 0;
    }
    CHECK(n_refused > n_damages / 20);
  }
}
