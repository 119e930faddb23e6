// What each coupling scheme itself costs per step: the wall time of a run less the time that its modules worked, that
// is the scheme's arithmetic, transfers' calls, companions, commits and, between processes, the calls and the waiting.
// The closed piston, where the modules are small; inline and with each module in a process. Rounds are interleaved;
// medians.
//
//   build-dev/bench/driver_cost [--rounds R] [--steps N]
#include "mullion_run.hpp"

#include <cstring>

namespace {

using mullion::bench::median;
using mullion::bench::mullion_run;

struct Scheme {
  const char* name;
  std::vector<std::string> sets;
};

const std::vector<std::string> cibc = {"driver.fluid_density=1.3", "driver.sound_speed=328.165"};

std::vector<std::string> joined(std::vector<std::string> one, const std::vector<std::string>& other)
{
  one.insert(one.end(), other.begin(), other.end());
  return one;
}

const std::vector<Scheme> schemes = {
    {"css", {"driver.scheme=css"}},
    {"css_parallel", {"driver.scheme=css_parallel"}},
    {"gss", {"driver.scheme=gss"}},
    {"iss", {"driver.scheme=iss"}},
    {"explicit_lagfree", {"driver.scheme=explicit_lagfree", "structure.integrator=central_difference"}},
    {"cibc", joined(cibc, {"driver.scheme=cibc"})},
    {"cibc, half offset", joined(cibc, {"driver.scheme=cibc", "driver.half_offset=true"})},
    {"cibc, 2 sub-iterations", joined(cibc, {"driver.scheme=cibc", "driver.sub_iterations=2"})},
    {"strong, relaxation", {"driver.scheme=strong", "driver.acceleration=constant", "driver.relaxation=1.0"}},
    {"strong, Aitken", {"driver.scheme=strong", "driver.acceleration=aitken"}},
    {"strong, IQN-ILS", {"driver.scheme=strong", "driver.acceleration=iqn_ils"}},
    {"strong, IQN-MVJ", {"driver.scheme=strong", "driver.acceleration=iqn_mvj"}},
    {"strong, IQN-ILS parallel", {"driver.scheme=strong", "driver.iteration=parallel"}},
};

/// Calls of the fluid, and what is left of the wall time, each per step.
struct Cost {
  double calls, own_us, total_us;
};

Cost cost(const Scheme& scheme, bool in_processes, long steps)
{
  std::vector<std::string> sets = {"run.dt=6e-6", fmt::format("run.end_time={}", 6e-6 * static_cast<double>(steps)),
                                   "output.every=0", "output.history=false", "expect=[]"};
  for (const char* module : {"fluid", "structure", "mesh_motion", "transfer"})
    sets.push_back(fmt::format("{}.process={}", module, in_processes));
  const auto attempt = mullion_run(MULLION_SOURCE_DIR "/configs/closed_piston.toml", joined(sets, scheme.sets), "");
  double work = 0.0, calls = 0.0;
  for (const auto& timing : attempt.at("timings")) {
    if (timing.at("who") == "mullion" || timing.at("call") == "attach") continue; // attach belongs to the start-up
    work += timing.at("work_s").get<double>();
    if (timing.at("who") == "fluid" && timing.at("call") == "step") calls = timing.at("count").get<double>();
  }
  const double n = static_cast<double>(steps), wall = attempt.at("wall_s").get<double>();
  return {calls / n, 1e6 * (wall - work) / n, 1e6 * wall / n};
}

} // namespace

int main(int argc, char** argv)
{
  int rounds = 7;
  long steps = 20'000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--steps") == 0) steps = std::atol(argv[i + 1]);
  }
  std::vector<std::vector<double>> own[2], total[2];
  std::vector<double> calls(schemes.size());
  for (int where = 0; where < 2; ++where) own[where].resize(schemes.size()), total[where].resize(schemes.size());
  for (int r = 0; r < rounds; ++r)
    for (std::size_t s = 0; s < schemes.size(); ++s)
      for (int where = 0; where < 2; ++where) {
        const auto found = cost(schemes[s], where == 1, where == 1 ? steps / 10 : steps);
        own[where][s].push_back(found.own_us);
        total[where][s].push_back(found.total_us);
        calls[s] = found.calls;
      }
  fmt::print("{:<26} {:>12} {:>22} {:>28}\n", "", "fluid calls", "inline: own (total)", "processes: own (total)");
  for (std::size_t s = 0; s < schemes.size(); ++s)
    fmt::print("{:<26} {:>12.2f} {:>11.2f} ({:.2f}) us {:>16.2f} ({:.2f}) us\n", schemes[s].name, calls[s],
               median(own[0][s]), median(total[0][s]), median(own[1][s]), median(total[1][s]));
}
