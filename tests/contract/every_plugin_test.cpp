// Every installed module and driver, in at least one case, gives the same bytes however it is run: inline, in
// processes, with every step done twice, by processes that know nothing but their windows, twice at the same time, and
// from a checkpoint on.
//
// A new plug-in needs a line in `cases`; this test says so.
#include "support/run_case.hpp"

#include <mullion/app/catalogue.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace mullion;

namespace {

/// A short case: 40 steps or so, with result files.
struct PluginCase {
  std::string file; ///< in the source tree
  std::vector<std::string> sets;
};

const std::string piston_steps = "run.end_time=2.4377976008801763e-4"; // 40 steps
const std::string piston = "configs/closed_piston.toml";

/// The piston for 40 steps with a driver and its options.
PluginCase driven(const std::string& scheme, std::vector<std::string> options)
{
  std::vector<std::string> sets = {piston_steps, "output.every=10", "fluid.cells=20", "structure.elements=10",
                                   "driver.scheme=" + scheme};
  for (auto& option : options)
    sets.push_back(option.find('.') < option.find('=') ? option : "driver." + option); // another table's, with its name
  return {piston, sets};
}
/// The last of its 40 steps is a shorter one: 0.38 dt.
PluginCase shortened(PluginCase c)
{
  c.sets.front() = "run.end_time=2.4e-4";
  return c;
}
/// It starts in a mode, so the fluid knows its state half a step before the start, too.
PluginCase in_a_mode(PluginCase c)
{
  for (const char* set : {"fluid.initial=mode", "structure.initial=mode", "fluid.mode_angular_frequency=258.55",
                          "structure.mode_angular_frequency=258.55", "coupling.reference_pressure=1e5"})
    c.sets.emplace_back(set);
  return c;
}

/// The arch that closes a box of gas, for 40 steps: solvers in the plane, meshes that do not match.
PluginCase boxed(const std::string& scheme, std::vector<std::string> options)
{
  std::vector<std::string> sets = {"run.end_time=4.0e-4", "output.every=10", "fluid.mesh=box_arch:10x6,height=0.2",
                                   "structure.mesh=arch:7x1", "driver.scheme=" + scheme};
  for (auto& option : options) sets.push_back(option.find('.') < option.find('=') ? option : "driver." + option);
  return {"configs/paper/closed_box.toml", sets};
}

/// The transfers there and back of `mullion transfer-test`, in 40 steps that differ: two meshes of a twisted wing, or,
/// where a mesh is among the options, others.
PluginCase probed(const std::string& method, std::vector<std::string> options)
{
  std::vector<std::string> sets = {"run.dt=0.025",
                                   "output.every=10",
                                   "transfer.module=" + method,
                                   "fluid.mesh=wing:4x6,triangles,tip=0.5,twist=-4,camber=0.05",
                                   "structure.mesh=wing:3x5,quads,tip=0.5,twist=-4,camber=0.05",
                                   "fluid.function=100*sin(3*x + t); 10*t; 1e4*(1 + 0.2*cos(2*y + 4*t))",
                                   "structure.function=0.01*t; 0; 0.1*y*cos(5*t)"};
  for (auto& option : options) sets.push_back(std::move(option)); // of one key twice the last counts
  return {"configs/transfer_test.toml", sets};
}
/// Between two arcs in the plane.
PluginCase in_the_plane(PluginCase c)
{
  for (const char* set :
       {"fluid.mesh=arc:13", "structure.mesh=arc:9", "fluid.function=100*sin(3*x + t); 1e3*y*t",
        "fluid.expected_motion=0; 0", "structure.expected_traction=0; 0", "structure.function=0.01*t; 0.1*x*cos(5*t)"})
    c.sets.emplace_back(set);
  return c;
}

const std::string gas = "fluid_density=1.3", sound = "sound_speed=328.165"; // what cibc must be told
const std::string block = "tests/verification/solid_under_traction.toml", arch = "configs/arch_modes.toml";
const std::string arch_steps = "run.end_time=4.0e-4"; // 40 steps
const std::vector<PluginCase> cases = {
    {piston, {piston_steps, "output.every=10", "fluid.cells=20"}},
    {piston,
     {piston_steps, "output.every=10", "fluid.cells=20", "fluid.limiter=van_albada", "fluid.substeps=3",
      "structure.integrator=central_difference", "structure.substeps=2", "driver.alpha=0.25", "driver.beta=0.5",
      "driver.profile=linear"}},
    {piston,
     {"run.end_time=2.4e-4", "output.every=15", "fluid.cells=20", "fluid.left_end=open", "fluid.substeps=2",
      "structure.far_end=free", "driver.order=fluid_first", "driver.beta=0.25"}}, // the last step is a shorter one
    driven("css", {"sampling=mean", "load_time=mean", "fluid.substeps=3", "structure.substeps=2"}),
    shortened(driven("css_parallel", {"profile=linear", "sampling=mean", "load_interpolation=constant",
                                      "fluid.substeps=2", "structure.substeps=3"})),
    shortened(driven("gss", {})),
    driven("gss", {"load=recursion", "beta=0.5", "profile=constant", "a0=1.0", "a1=0.0", "structure.substeps=2",
                   "load_interpolation=constant"}),
    shortened(driven("iss", {"fluid.substeps=2"})),
    in_a_mode(driven("iss", {"starts_early=true", "sampling=mean", "w_end=false"})),
    shortened(driven("explicit_lagfree", {"structure.integrator=central_difference"})),
    shortened(driven("cibc", {gas, sound, "kappa=0.3", "fluid.substeps=2", "structure.substeps=2"})),
    driven("cibc", {gas, "reading=printed", "omega=2e-4"}),
    driven("cibc", {gas, sound, "sub_iterations=2", "load_interpolation=constant", "structure.substeps=2"}),
    shortened(driven("cibc", {gas, sound, "half_offset=true", "w_end=false"})),
    in_a_mode(driven("cibc", {gas, "half_offset=true", "starts_early=true", "h=0.001", "reference_velocity=1.0"})),
    shortened(driven("strong", {"sampling=mean", "fluid.substeps=3", "structure.substeps=2"})),
    driven("strong", {"acceleration=aitken", "predictor=quadratic", "profile=constant"}),
    driven("strong", {"acceleration=constant", "relaxation=0.9", "predictor=constant"}),
    shortened(driven("strong", {"acceleration=iqn_mvj"})),
    shortened(driven("strong", {"iteration=parallel", "reuse=2", "max_columns=5"})),
    driven("strong",
           {"iteration=parallel", "acceleration=iqn_mvj", "structure.substeps=2", "load_interpolation=constant"}),
    {"tests/verification/added_mass.toml",
     {"run.end_time=4.0e-3", "output.every=10", "driver.reuse=3", "structure.density=75.0"}}, // without a mesh to move
    {"tests/contract/uncoupled.toml", {}},
    {"configs/sod_tube.toml", {"run.end_time=0.04", "output.every=10", "fluid.mesh=box:40x2,triangles,size=1x0.05"}},
    {"configs/sod_tube.toml",
     {"run.end_time=0.04", "output.every=10", "fluid.mesh=box:40x2,size=1x0.05", "fluid.time_stepping=local",
      "fluid.first_order_iterations=10", "fluid.limiter=none"}},
    boxed("css", {"fluid.substeps=2", "fluid.threads=2"}),
    boxed("css_parallel", {"mesh_motion.module=elastic_mesh", "structure_receives=traction"}),
    boxed("gss", {"structure.substeps=2", "transfer.module=quadrature_projection"}),
    boxed("iss", {"fluid.flux=roe", "fluid.integrator=rk4"}),
    boxed("cibc", {"half_offset=true", "fluid_density=1.3", "omega=7.5e-4", "omega_check=warn",
                   "subtract_gradient=true", "acceleration=difference", "w_end=false"}),
    boxed("cibc", {"fluid_density=1.3", "omega=7.5e-4", "omega_check=warn", "structure_receives=traction"}),
    boxed("strong", {"transfer.offsets=rigid_link"}),
    {"configs/paper/flow_shell.toml",
     {"run.end_time=4.0e-4", "output.every=10", "fluid.mesh=duct_arch:10x8,largest=0.4,growth=1.3",
      "fluid.steady_iterations=20", "fluid.first_order_iterations=10", "structure.mesh=arch:7x1"}},
    {"configs/paper/elastic_piston.toml",
     {"run.end_time=2.0e-5", "run.dt=5e-7", "output.every=10", "fluid.mesh=box:20x8,size=0.25x0.1,origin=-0.25:0",
      "structure.mesh=box:35x7,size=0.5x0.1", "transfer.module=node_projection"}},
    {"configs/paper/superseismic_lite.toml",
     {"run.end_time=2.0e-5", "run.dt=5e-7", "output.every=10", "fluid.mesh=box:32x16,size=0.8x0.4",
      "structure.mesh=box:28x14,size=0.8x0.4,origin=0:-0.4"}},
    {"configs/paper/superseismic.toml",
     {"run.end_time=8.0e-6", "run.dt=2e-7", "output.every=10", "fluid.mesh=box:32x16,size=0.8x0.4",
      "structure.mesh=box:28x14,size=0.8x0.4,origin=0:-0.4"}},
    {"configs/paper/superseismic_sliding.toml",
     {"run.end_time=4.0e-6", "output.every=10", "fluid.mesh=box:32x16,size=0.8x0.4",
      "structure.mesh=box:28x4,size=0.8x0.1,origin=0:-0.1"}},
    probed("common_refinement", {"transfer.motion=adjoint"}),
    probed("common_refinement", {"driver.fluid_exports=traction", "fluid.on=faces", "driver.structure_receives=load",
                                 "transfer.metric=average", "transfer.mass=native"}),
    in_the_plane(probed("common_refinement", {"driver.fluid_exports=load", "fluid.on=load", "driver.recover=true",
                                              "transfer.recovery=lumped"})),
    probed("quadrature_projection", {"driver.fluid_exports=load", "fluid.on=load", "driver.structure_receives=load",
                                     "transfer.adaptive=true", "transfer.tolerance=1e-3"}),
    in_the_plane(probed("quadrature_projection", {"transfer.points=3", "transfer.motion=adjoint"})),
    probed("node_projection", {"driver.motion=displacement"}),
    in_the_plane(probed("nearest_projection", {"driver.fluid_exports=traction", "fluid.on=faces"})),
    probed("nearest_neighbor", {"driver.fluid_exports=load", "fluid.on=load", "driver.structure_receives=load"}),
    {block, {"structure.modes=3"}},
    {block, {"structure.integrator=generalised_alpha", "structure.substeps=2", "structure.rayleigh_mass=10.0"}},
    {block,
     {"structure.integrator=central_difference", "structure.mass=lumped", "structure.substeps=2",
      "driver.structure_receives=load"}},
    {block, {"structure.integrator=static", "structure.mesh=box:10x4,triangles,size=0.3x0.1"}},
    {arch, {arch_steps, "output.every=10", "structure.subtract_steady_load=true"}},
    {arch, {arch_steps, "output.every=10", "structure.initial=mode", "structure.initial_mode=7"}},
    {arch,
     {arch_steps, "output.every=10", "structure.initial=expressions", "structure.initial_amplitude=0.0",
      "structure.prescribed=end", "structure.clamped=start", "structure.prescribed_displacement=0; 1e-4*sin(5e3*t)",
      "structure.edge_load=inner", "structure.edge_traction=0; 1e4*t"}},
};

test::CaseRun to_run(const PluginCase& c, const std::vector<std::string>& flags, const std::string& out)
{
  return {.file = MULLION_SOURCE_DIR "/" + c.file, .sets = c.sets, .flags = flags, .out = out};
}

} // namespace

TEST_CASE("every installed module and driver runs in a case of this test")
{
  const test::RunFolder folder;
  std::set<std::string> used;
  for (const auto& c : cases) {
    REQUIRE(folder.run(to_run(c, {"--inline"}, "out")).exit_code == 0);
    const auto attempt = test::read_record(folder / "out").at("attempts").at(0);
    used.insert(attempt.at("driver").get<std::string>());
    for (const auto& module : attempt.at("modules")) used.insert(module.at("module").get<std::string>());
  }

  const auto installed = list_plugins();

  CHECK(installed.size() >= 5);
  for (const auto& plugin : installed) {
    CHECK_MESSAGE(plugin.problem == "", plugin.name);
    CHECK_MESSAGE(used.contains(plugin.name), "no case of tests/contract/every_plugin_test.cpp runs the plug-in ",
                  plugin.name);
  }
}

TEST_CASE("every plug-in gives the same bytes inline, in processes, replayed, amnesiac and twice at the same time")
{
  for (const auto& c : cases) {
    const test::RunFolder folder;
    CAPTURE(&c - cases.data());
    REQUIRE(folder.run(to_run(c, {"--inline"}, "reference")).exit_code == 0);
    CHECK(test::last_step(folder / "reference") == 40);

    const std::vector<std::vector<std::string>> ways = {
        {"--processes"}, {"--inline", "--replay"}, {"--processes", "--replay"}, {"--amnesia", "1"}, {"--amnesia", "7"}};
    for (const auto& flags : ways) {
      CAPTURE(flags[0]);
      CAPTURE(flags.back());
      const auto result = folder.run(to_run(c, flags, "out"));
      CHECK_MESSAGE(result.exit_code == 0, result.err);
      CHECK(test::difference(folder / "out", folder / "reference") == "");
    }

    auto one = to_run(c, {"--processes"}, "one"), other = to_run(c, {"--processes"}, "other");
    one.sets.emplace_back("run.name=one");
    other.sets.emplace_back("run.name=other");
    const auto first = folder.start(one), second = folder.start(other);
    CHECK(first->wait().exit_code == 0);
    CHECK(second->wait().exit_code == 0);
    CHECK(test::difference(folder / "one", folder / "reference") == "");
    CHECK(test::difference(folder / "other", folder / "reference") == "");

    CHECK(folder.is_deserted_within(std::chrono::seconds(1)));
    CHECK(folder.new_shared_memory().empty());
  }
}

TEST_CASE("every plug-in goes on from a checkpoint of any step to the same bytes, under another placement too")
{
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937 random(seed);
  for (const auto& c : cases) {
    CAPTURE(&c - cases.data());
    const test::RunFolder folder;
    auto whole = to_run(c, {"--inline"}, "reference");
    for (const char* set : {"output.checkpoint_every=1", "output.keep_checkpoints=0"}) whole.sets.emplace_back(set);
    REQUIRE(folder.run(whole).exit_code == 0);

    for (const char* placement : {"--inline", "--processes"}) {
      const int step = std::uniform_int_distribution(1, 39)(random);
      CAPTURE(step);
      CAPTURE(placement);
      std::filesystem::remove_all(folder / "out");
      std::filesystem::copy(folder / "reference", folder / "out", std::filesystem::copy_options::recursive);
      const auto file = fmt::format("out/checkpoint-{:09}.h5", step);
      auto rest = whole;
      rest.out = "out";
      rest.flags = {placement, "--restart", file};
      const auto result = folder.run(rest);

      CHECK_MESSAGE(result.exit_code == 0, result.err);
      CHECK(test::difference(folder / "out", folder / "reference") == "");
      const auto attempts = test::read_record(folder / "out").at("attempts");
      REQUIRE(attempts.size() == 2);
      CHECK(attempts[1].at("restarted_from") == file);
      CHECK(attempts[1].at("first_step") == step);
    }
  }
}
