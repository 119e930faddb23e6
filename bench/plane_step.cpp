// What a coupled step costs, module by module, in cases of the plane: the elastic piston, the closed box and the arch
// in a flow, with css, iss and cibc, inline and with each module in a process. A live run is looked at twice, some
// steps after its start and so many steps later: the time that each module worked (arming and checks included), what
// lies between the driver's requests and that (calls, waking, waiting), and what is left of the wall time (the driver's
// arithmetic, companions, the ledger, commits). History and result files are off. Rounds are interleaved; medians of
// times and of the rounds' shares.
//
//   build-dev/bench/plane_step [--rounds R] [--steps N] [--case NAME, say closed_box]
#include "live_run.hpp"

#include <cmath>
#include <cstring>
#include <iterator>

namespace {

using mullion::bench::LiveRun;
using mullion::bench::median;
using Sets = std::vector<std::string>;

struct PlaneCase {
  const char* name;
  const char* file; ///< in configs/paper
  double dt;        ///< [s]
  Sets sets;
  std::string css;  ///< keys of [driver]; iss takes the same
  std::string cibc; ///< what that scheme has to know of the gas
};

const char* const flow_cibc = R"(structure_receives = "load"
half_offset = true
subtract_gradient = true
fluid_density = 1.3
omega = 0.00075
omega_check = "warn"
)";

// The arch starts at rest in a uniform flow: the steady one takes 3000 iterations, and a step costs the same in it.
const std::vector<PlaneCase> cases = {
    {"elastic piston, 2560 cells, 3920 elements",
     "elastic_piston.toml",
     1.56e-7,
     {},
     "fluid_exports = \"nodal_traction\"",
     "fluid_density = 8.75\nsound_speed = 4000.0\nkappa = 0.4"},
    {"closed box, 544 cells, 24 elements", "closed_box.toml", 1e-5, {}, "structure_receives = \"load\"", flow_cibc},
    {"flow-shell, 10 020 cells, 24 elements",
     "flow_shell.toml",
     1e-5,
     {"fluid.steady_iterations=0", "fluid.first_order_iterations=0", "structure.subtract_steady_load=false"},
     "structure_receives = \"load\"",
     flow_cibc}};

const std::vector<const char*> kinds = {"fluid", "structure", "mesh_motion", "transfer"};

/// Microseconds a step.
struct Cost {
  double work[4] = {}, waiting = 0, own = 0, total = 0;
  [[nodiscard]] double outside() const { return (waiting + own) / total; }
};

/// The case with this table [driver] in the place of its own, which is its last.
std::string with_driver(const PlaneCase& c, const std::string& scheme, const std::string& keys)
{
  std::ifstream file(fmt::format("{}/configs/paper/{}", MULLION_SOURCE_DIR, c.file));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto path = std::filesystem::temp_directory_path() / fmt::format("mullion-bench-{}.toml", ::getpid());
  std::ofstream(path) << text.substr(0, text.find("[driver]")) << "[driver]\nscheme = \"" << scheme << "\"\n" << keys;
  return path;
}

/// The run's counters, and when it made the step that they stand at.
struct Look {
  mullion::RunLook run;
  std::int64_t step;
  std::chrono::steady_clock::time_point when;
};

Look look_after(const LiveRun& run, std::int64_t steps)
{
  run.wait_steps(steps);
  const auto when = std::chrono::steady_clock::now();
  const auto step = run.control().step.load();
  return {run.look(), step, when};
}

Cost cost(const PlaneCase& c, const std::string& scheme, bool in_processes, long steps)
{
  constexpr long first_steps = 10; // what is computed once and kept belongs to them
  const auto file = with_driver(c, scheme, scheme == "cibc" ? c.cibc : c.css);
  std::vector<std::string> words = {file};
  Sets sets = {fmt::format("run.end_time={}", 2.0 * c.dt * static_cast<double>(steps + 100)), "output.every=0",
               "output.history=false"};
  sets.insert(sets.end(), c.sets.begin(), c.sets.end());
  for (const char* kind : kinds) sets.push_back(fmt::format("{}.process={}", kind, in_processes));
  for (const auto& set : sets) words.insert(words.end(), {"--set", set});
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("mullion-bench-{}", ::getpid());
  const LiveRun run("bench-plane-step", words, "", folder);
  std::filesystem::remove(file);
  const auto from = look_after(run, first_steps), to = look_after(run, steps);

  const auto n_steps = static_cast<double>(to.step - from.step);
  Cost cost;
  cost.total = cost.own = 1e6 * std::chrono::duration<double>(to.when - from.when).count() / n_steps;
  for (std::size_t m = 0; m < to.run.modules.size(); ++m)
    for (const auto& call : to.run.modules[m].calls) {
      mullion::CallLook before;
      for (const auto& other : from.run.modules[m].calls)
        if (other.call == call.call) before = other;
      const auto count = static_cast<double>(call.count - before.count);
      if (count < 0.5 * n_steps) continue; // nothing of each step
      // The looks are taken in the middle of a step: the mean call, as often as it is made in a step.
      const double a_step = 1e6 / count * std::round(count / n_steps);
      const double wall = a_step * (call.wall_s - before.wall_s), work = a_step * (call.work_s - before.work_s);
      for (std::size_t k = 0; k < kinds.size(); ++k)
        if (to.run.modules[m].kind == kinds[k]) cost.work[k] += work;
      cost.waiting += wall - work;
      cost.own -= wall;
    }
  return cost;
}

double median_of(const std::vector<Cost>& costs, const std::function<double(const Cost&)>& part)
{
  std::vector<double> values;
  for (const auto& cost : costs) values.push_back(part(cost));
  return median(values);
}

void row(const std::string& scheme, const char* where, const std::vector<Cost>& costs,
         const std::vector<Cost>& inline_costs)
{
  std::vector<double> ratios;
  for (std::size_t r = 0; r < costs.size(); ++r) ratios.push_back(costs[r].total / inline_costs[r].total);
  fmt::print("| {} | {} |", scheme, where);
  for (std::size_t k = 0; k < kinds.size(); ++k)
    fmt::print(" {:.1f} |", median_of(costs, [k](const Cost& c) { return c.work[k]; }));
  fmt::print(" {:.1f} | {:.1f} | {:.1f} | {:.1f} % | {:.2f} |\n", median_of(costs, [](const Cost& c) { return c.own; }),
             median_of(costs, [](const Cost& c) { return c.waiting; }),
             median_of(costs, [](const Cost& c) { return c.total; }),
             median_of(costs, [](const Cost& c) { return 100.0 * c.outside(); }), median(ratios));
}

} // namespace

int main(int argc, char** argv)
try {
  int rounds = 7;
  long steps = 300;
  std::string only;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--steps") == 0) steps = std::atol(argv[i + 1]);
    if (std::strcmp(argv[i], "--case") == 0) only = argv[i + 1];
  }
  for (const auto& c : cases) {
    if (!only.empty() && only + ".toml" != c.file) continue;
    const std::vector<std::string> schemes = {"css", "iss", "cibc"};
    std::vector<std::vector<Cost>> inline_runs(schemes.size()), process_runs(schemes.size());
    for (int r = 0; r < rounds; ++r)
      for (std::size_t s = 0; s < schemes.size(); ++s) {
        inline_runs[s].push_back(cost(c, schemes[s], false, steps));
        process_runs[s].push_back(cost(c, schemes[s], true, steps));
      }
    fmt::print("{}: us a step\n\n| scheme | modules | fluid | structure | mesh motion | transfer | driver and commit | "
               "calls and waiting | total | outside the modules | / inline |\n"
               "|---|---|---|---|---|---|---|---|---|---|---|\n",
               c.name);
    for (std::size_t s = 0; s < schemes.size(); ++s) {
      row(schemes[s], "inline", inline_runs[s], inline_runs[s]);
      row(schemes[s], "a process each", process_runs[s], inline_runs[s]);
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
} catch (const std::exception& error) {
  fmt::print(stderr, "plane_step: {}\n", error.what());
  return 1;
}
