// The solid as a module in runs: static, free and forced solutions with known answers, energy, and what it says about
// bad input.
#include "files/read.hpp"
#include "io/run_record.hpp"
#include "support/history.hpp"
#include "support/run_case.hpp"
#include "support/solid_meshes.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

using namespace mullion;
using namespace mullion::test;
using mullion::testing::worst;

namespace {

/// A case of a solid alone.
std::string alone(double end, double dt, const std::string& structure)
{
  return fmt::format("[run]\nname = \"solid\"\nend_time = {}\ndt = {}\n[structure]\nmodule = \"elastic_solid\"\n{}\n"
                     "[driver]\nscheme = \"uncoupled\"\n[output]\nevery = 1000000\n",
                     end, dt, structure);
}

ProcessResult run(const RunFolder& folder, const std::string& text, const std::vector<std::string>& sets = {})
{
  std::ofstream(folder / "case.toml") << text;
  return folder.run({.file = (folder / "case.toml").string(), .sets = sets, .flags = {"--inline"}});
}

History history_of(const RunFolder& folder, const std::string& text, const std::vector<std::string>& sets = {})
{
  const auto result = run(folder, text, sets);
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  return read_history(folder / "out" / "history.csv");
}

/// What a run that must not work says.
std::string complaint(const std::string& structure, const std::vector<std::string>& sets = {})
{
  const RunFolder folder;
  const auto result = run(folder, alone(1e-3, 1e-3, structure), sets);
  CHECK(result.exit_code != 0);
  return result.err;
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string block = "mesh = \"box:4x2,quads,size=2x1\"\nwet = \"y_max\"\nclamped = \"x_min\"";

} // namespace

TEST_CASE("Cook's membrane, read from a file and loaded on its edge, bends as in the table")
{
  const RunFolder folder;
  auto mesh = mesh_files::read_or_generate("box:8x8,quads");
  mesh.nodes = testing::cook_membrane(8).nodes;
  mesh_files::write_mesh(mesh, (folder / "cook.msh").string());

  const auto history = history_of(
      folder, alone(1.0, 1.0,
                    fmt::format("mesh = \"{}\"\nwet = \"y_max\"\nclamped = \"x_min\"\nedge_load = \"x_max\"\n"
                                "edge_traction = \"0; 1/16\"\nintegrator = \"static\"\nyoungs_modulus = 1.0\n"
                                "poisson_ratio = 0.3333333333333333\nmonitor = \"48, 52\"",
                                (folder / "cook.msh").string())));

  // 23.689 from another program, see the kernel's test; coordinates go through the file with all digits.
  CHECK(history.at("structure.volume.monitor_displacement_y").back() == doctest::Approx(23.689).epsilon(3e-5));
}

TEST_CASE("an arch let go from the shape of a pressure swings with its lowest mode and keeps its energy")
{
  const RunFolder folder;
  const auto result = folder.run({.file = MULLION_SOURCE_DIR "/configs/arch_modes.toml", .flags = {"--inline"}});
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  // Another program, 24 x 1 elements: 574.261 Hz.
  CHECK(says(result.err + result.out, "lowest frequencies without a load: 574.261, "));

  const auto history = read_history(folder / "out" / "history.csv");
  CHECK(history.at("structure.volume.monitor_displacement_y").front() == doctest::Approx(-0.2e-3).epsilon(1e-12));
  const auto& energy = history.at("structure.volume.energy");
  double drift = 0.0;
  for (const double e : energy) drift = worst(drift, std::abs(e / energy.front() - 1.0));
  CHECK(drift < 1e-9); // round-off of M against K: the fastest mode is 1e4 times as fast as the lowest

  // q_1 = q_1(0) cos(omega' t) exactly, with Newmark's omega'.
  const auto& q = history.at("structure.volume.modal_coordinate_0");
  const double omega = 2.0 * std::numbers::pi * 574.261, dt = 1e-5;
  const double numerical = 2.0 / dt * std::atan(0.5 * omega * dt);
  double error = 0.0;
  for (std::size_t n = 0; n < q.size(); ++n)
    error = worst(error, std::abs(q[n] / q[0] - std::cos(numerical * dt * static_cast<double>(n))));
  CHECK(error < 5e-4 / 574.261 * numerical * 0.02 * 1.2); // the frequency's printed digits, over the run
}

TEST_CASE("every integrator runs a standing wave between a wall and a moved end as the exact solution says")
{
  // u = A sin(k x) cos(k c t) in a strip with rollers at its sides: plane stress with the modulus E/(1 - nu^2).
  const double c = std::sqrt(2.0 / 0.91), k = 2.0;
  const auto text = [&](int n) {
    return alone(2.0, 0.4 / n,
                 fmt::format("mesh = \"box:{}x1,quads,size=1x0.05\"\nwet = \"y_max\"\nclamped = \"x_min\"\n"
                             "roller_y = \"y_min, y_max\"\nprescribed = \"x_max\"\n"
                             "prescribed_displacement = \"1e-3*sin({}*x)*cos({:.17g}*t); 0\"\n"
                             "initial = \"expressions\"\ninitial_displacement = \"1e-3*sin({}*x); 0\"\n"
                             "initial_velocity = \"0; 0\"\nmonitor = \"0.5, 0\"\nyoungs_modulus = 2.0\n"
                             "poisson_ratio = 0.3\ndensity = 1.0",
                             n, k, k * c, k));
  };
  for (const std::string sets : {"newmark", "generalised_alpha", "central_difference"}) {
    CAPTURE(sets);
    double before = 0.0;
    for (const int n : {10, 20, 40}) {
      const RunFolder folder;
      const auto history =
          history_of(folder, text(n),
                     {"structure.integrator=" + sets, "structure.substeps=2",
                      std::string("structure.mass=") + (sets == "central_difference" ? "lumped" : "consistent")});
      double error = 0.0;
      for (std::size_t i = 0; i < history.at("time").size(); ++i)
        error = worst(error, std::abs(history.at("structure.volume.monitor_displacement_x")[i] / 1e-3 -
                                      std::sin(0.5 * k) * std::cos(k * c * history.at("time")[i])));
      if (before > 0.0) CHECK(std::log2(before / error) > 1.8); // second order; reflections do not let it be smooth
      before = error;
    }
    CHECK(before < 2e-3);
  }
}

TEST_CASE("the work of the load that came across the interface is the change of the solid's energy")
{
  for (const std::string receives : {"traction", "load"})
    for (const std::string substeps : {"1", "3"}) {
      const RunFolder folder;
      const auto result =
          folder.run({.file = MULLION_SOURCE_DIR "/tests/verification/solid_under_traction.toml",
                      .sets = {"driver.structure_receives=" + receives, "structure.substeps=" + substeps},
                      .flags = {"--inline"}});
      REQUIRE_MESSAGE(result.exit_code == 0, result.err);
      const auto history = read_history(folder / "out" / "history.csv");
      const auto &energy = history.at("structure.volume.energy"), &work = history.at("structure.wet.work");
      double defect = 0.0;
      for (std::size_t n = 1; n < energy.size(); ++n)
        defect = worst(defect, std::abs(energy[n] - energy[n - 1] - work[n]));
      CHECK(energy.back() > 0.1);
      CHECK(defect < 1e-12 * energy.back() * 10.0); // round-off of stiff elements' energies
      // One substep with F^n at its begin; the probe's load is held by later ones: (F^n + (2 eta - 1) F^{n+1})/(2 eta).
      const double force_before = history.at("transfer.structure_side.force_y").end()[-2],
                   force = history.at("transfer.structure_side.force_y").back(), eta = std::stod(substeps);
      CHECK(history.at("structure.wet.impulse_y").back() ==
            doctest::Approx(1e-6 * (force_before + (2.0 * eta - 1.0) * force) / (2.0 * eta)).epsilon(1e-12));
    }
}

TEST_CASE("a group that the mesh does not have is named with those that it has")
{
  const auto text = complaint("mesh = \"box:4x2,quads\"\nwet = \"y_max\"\nclamped = \"left\"");
  CHECK(says(text, "mesh = \"box:4x2,quads\": clamped: the mesh has no group \"left\"; it has \"volume\", \"x_min\""));
}

TEST_CASE("without a wet surface there is nothing to couple")
{
  CHECK(says(complaint("mesh = \"box:4x2,quads\"\nwet = \"\""), "wet: it names no face"));
  CHECK(says(complaint("mesh = \"box:4x2,quads\"\nwet = \"top\""), "wet: the mesh has no group \"top\""));
}

TEST_CASE("an inverted element is named with its place")
{
  const RunFolder folder;
  auto mesh = mesh_files::read_or_generate("box:2x2,quads,size=2x2");
  for (auto& block : mesh.blocks)
    if (block.shape == mesh_files::Shape::quadrilateral4) block.connectivity.col(3).reverseInPlace();
  mesh_files::write_mesh(mesh, (folder / "bad.msh").string());

  const auto text = complaint(fmt::format("mesh = \"{}\"\nwet = \"y_max\"", (folder / "bad.msh").string()));

  CHECK(says(text, "element 3, a quadrilateral4 at (1.5, 1.5) m: the smallest Jacobian is -0.25 m^2; it must be"));
}

TEST_CASE("a step beyond the limit of central differences is refused with the limit")
{
  const auto text = complaint(block, {"structure.integrator=central_difference"});
  CHECK(says(text, "a structural step of 0.001 s is beyond the stability limit "));
  CHECK(says(text, "use more substeps, larger elements or integrator = \"newmark\""));
}

TEST_CASE("a static solution of a body that nothing holds is refused, and so are keys that need each other")
{
  const std::string loose = "mesh = \"box:4x2,quads\"\nwet = \"y_max\"\nroller_y = \"y_min\"";
  CHECK(says(complaint(loose, {"structure.integrator=static"}),
             "integrator = \"static\": nothing holds the part of the body around (0.5, 0.5) m (15 nodes): 1 of its 3"));
  CHECK(says(complaint(loose, {"structure.initial=static_pressure", "structure.initial_amplitude=1e-3"}),
             "initial = \"static_pressure\": nothing holds"));
  CHECK(says(complaint(block, {"structure.prescribed=x_max"}), "need each other"));
  CHECK(says(complaint(block, {"structure.edge_load=x_max"}), "need each other"));
  CHECK(says(complaint(block, {"structure.initial_amplitude=1e-3"}), "initial_amplitude belongs to"));
  CHECK(says(complaint(block + "\nmonitor = \"1\""), "monitor = \"1\": it is a point of 2 numbers"));
  CHECK(says(complaint(block, {"structure.modes=1000"}), "1000 modes of 24 free degrees of freedom"));
  CHECK(says(complaint(block + "\ninitial = \"static_pressure\"\ninitial_amplitude = 1e-3\nmonitor = \"0, 0\""),
             "does not move the node at (0, 0) m"));
}

TEST_CASE("a run asks the solid what its modes radiate into a duct, and the record has the answers")
{
  // G25 of Jaiman et al. 2011, section 6.3, at Mach 0.18: another program says -13.4 1/s and -1.9 Hz for the converged
  // arch; its figures' digits and this mesh, 0.4 % too stiff, leave 1.5 % and 0.08 Hz.
  const RunFolder folder;
  const std::string duct = ", 1.25, 102.975, 1.3, 572.081)";
  const auto result = folder.run({.file = MULLION_SOURCE_DIR "/configs/arch_modes.toml",
                                  .sets = {"run.end_time=1e-4", "output.functions=structure.frequency(1); "
                                                                "structure.radiation_rate(1" +
                                                                    duct + "; structure.radiation_shift(1" + duct},
                                  .flags = {"--inline"}});
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);

  const auto record = io::read_run_record(folder / "out" / "run.json");

  REQUIRE(record->attempts.back().functions.size() == 3);
  const auto& answers = record->attempts.back().functions;
  CHECK(answers[0].first == "structure.frequency(1)");
  CHECK(std::abs(answers[0].second - 574.261) < 6e-4); // its last digit
  CHECK(std::abs(answers[1].second / -13.4 - 1.0) < 0.015);
  CHECK(std::abs(answers[2].second + 1.9) < 0.08);
  CHECK(result.out.find("structure.frequency(1) = 574.261\n") != std::string::npos); // the summary
}

TEST_CASE("a duct that is none is refused with what is right")
{
  const auto said = [](const std::string& call) {
    const RunFolder folder;
    return folder
        .run({.file = MULLION_SOURCE_DIR "/configs/arch_modes.toml",
              .sets = {"run.end_time=1e-4", "output.functions=structure." + call},
              .flags = {"--inline"}})
        .err;
  };
  CHECK(said("radiation_rate(1, 1.25, 600, 1.3, 572)").find("the flow is slower than sound") != std::string::npos);
  CHECK(said("radiation_rate(0, 1.25, 100, 1.3, 572)").find("modes are numbered from 1 to") != std::string::npos);
  CHECK(said("radiation_rate(1, 1.25)").find("radiation_rate takes 5 numbers, not 2") != std::string::npos);
  CHECK(said("radiation_rat(1)").find("did you mean 'radiation_rate'?") != std::string::npos);
}
