// `mullion mesh`: the first part of a run, up to the windows, and then files instead of steps. Modules are inline,
// whatever the case says: they hand out files through a descriptor, and nothing is to be saved from a crash but the
// message, which is the guard's.
#include <mullion/app/meshes.hpp>

#include "io/atomic_file.hpp"
#include "io/mesh_figures.hpp"
#include "io/results_writer.hpp"
#include "run/session.hpp"
#include "run/snapshot.hpp"
#include "run/under_guard.hpp"

#include <mullion/sdk/error.hpp>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <sys/mman.h>
#include <unistd.h>

namespace mullion {
namespace {

namespace fs = std::filesystem;

constexpr const char* summary_file = "meshes.txt";

/// What a module writes to a descriptor when it is asked for `function`; nothing if it has no such function.
std::optional<std::string> text_of(run::Session& session, const std::string& instance, const std::string& function)
{
  const shm::Descriptor file(::memfd_create(function.c_str(), MFD_CLOEXEC));
  MULLION_REQUIRE(file.get() >= 0, Errc::io, "no memory for a file: {}", std::strerror(errno));
  if (!session.ask(instance, function, std::array{static_cast<double>(file.get())})) return std::nullopt;
  const auto length = ::lseek(file.get(), 0, SEEK_END);
  std::string text(static_cast<std::size_t>(length), '\0');
  for (std::size_t done = 0; done < text.size();) {
    const auto n = ::pread(file.get(), text.data() + done, text.size() - done, static_cast<off_t>(done));
    MULLION_REQUIRE(n > 0, Errc::io, "what module '{}' wrote in {} cannot be read: {}", instance, function,
                    std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
  return text;
}

bool has_function(const mullion_module& entries, const char* name)
{
  for (std::uint32_t f = 0; f < entries.n_functions; ++f)
    if (std::strcmp(entries.functions[f].name, name) == 0) return true;
  return false;
}

/// Where the nodes are in the first state: a field `coordinates` says so, else the reference coordinates.
const double* coordinates_of(const io::PaneData& pane)
{
  for (const auto& field : pane.fields)
    if (field.name == "coordinates" && field.location == MULLION_NODE && field.components == pane.dimension)
      return field.f64;
  return pane.reference_coordinates;
}

/// "80 x_min\n160 y_min\n" as "x_min 80, y_min 160".
std::string in_a_row(const std::string& boundaries)
{
  std::istringstream lines(boundaries);
  std::string row;
  for (std::string line; std::getline(lines, line);) {
    const auto space = line.find(' ');
    if (space == std::string::npos) continue;
    row += fmt::format("{}{} {}", row.empty() ? "" : ", ", line.substr(space + 1), line.substr(0, space));
  }
  return row.empty() ? "none has a name" : row;
}

/// The files of modules that hand out their mesh. @return lines for the summary
std::string write_module_files(const Case& c, plugin::Catalogue& catalogue, run::Session& session, const fs::path& out)
{
  std::string lines;
  for (const auto& module : c.modules) {
    const auto& entries = catalogue.open(module.plugin).module();
    if (!has_function(entries, "write_mesh") && !has_function(entries, "list_boundaries")) continue;
    session.attach_alone(module.instance);
    lines += fmt::format("{}, as it was read\n", module.instance);
    if (const auto boundaries = text_of(session, module.instance, "list_boundaries"))
      lines += fmt::format("  boundaries      {}\n", in_a_row(*boundaries));
    if (const auto mesh = text_of(session, module.instance, "write_mesh")) {
      const auto file = out / (module.instance + ".msh");
      io::write_atomically(file, *mesh);
      lines += fmt::format("  with its groups {}\n", file.string());
    }
  }
  return lines;
}

std::string describe_windows(const std::vector<io::WindowData>& windows)
{
  std::string text;
  for (const auto& window : windows)
    for (const auto& pane : window.panes) {
      const auto name = window.panes.size() == 1 ? window.name : fmt::format("{}[{}]", window.name, pane.id);
      text += fmt::format("{}: {}", name, describe(io::figures_of(pane, coordinates_of(pane))));
    }
  return text;
}

/// A folder of a run is not overwritten: its results would be gone for a look at the mesh.
void make_ready(const fs::path& out)
{
  MULLION_REQUIRE(!fs::exists(out / "run.json"), Errc::config,
                  "{} holds the results of a run (run.json); give another folder with --out", out.string());
  io::make_folder(out);
}

} // namespace

MeshOutcome write_meshes(const MeshOptions& options)
{
  auto case_options = options.case_options;
  case_options.all_inline = true;
  const auto read = read_case(options.case_file, case_options);
  MeshOutcome outcome{read.diagnostics, 2, ""};
  if (!read.diagnostics.empty()) return outcome;
  const Case& c = read.value;
  const auto out = options.out.empty() ? fs::path("out") / (c.name + "-mesh") : fs::path(options.out);
  outcome.exit_code = run::under_guard(options.log_level, [&](shm::Control& control, int control_fd) {
    make_ready(out);
    // Never the name of a live run, which the guard would tidy away after.
    const auto name = ("mesh of " + c.name).substr(0, sizeof control.run_name - 1);
    shm::copy_text(control.run_name, sizeof control.run_name, name, "run name");
    process::Supervisor supervisor(control, control_fd);
    plugin::Catalogue catalogue;
    run::Session session(c, catalogue, control, supervisor, {});
    session.define_windows();

    io::ResultsWriter results(out, c.name);
    results.begin(run::snapshot_of(session, shm::Storage::fixed));
    const auto windows = run::snapshot_of(session, shm::Storage::level);
    results.write(0, c.start_time, windows);
    results.finish();
    auto summary = describe_windows(windows);
    summary += write_module_files(c, catalogue, session, out);
    summary += fmt::format("all windows for ParaView: {}\n", (out / "results.xdmf").string());
    io::write_atomically(out / summary_file, summary);
    return 0;
  });
  if (outcome.exit_code == 0) outcome.summary = io::read_text(out / summary_file);
  return outcome;
}

} // namespace mullion
