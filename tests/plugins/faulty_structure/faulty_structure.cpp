#include "faulty_structure.hpp"

#include "faults.hpp"

#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

namespace mullion::test {
namespace {

/// One element, or (fault = huge) so many that `spare.bulk` has 512 GiB.
Pane spare_pane(bool is_huge)
{
  return {0, Coordinates::Zero(1, 1), {{ElementType::point1, Connectivity::Zero(1, is_huge ? 1 << 24 : 1)}}};
}

} // namespace

std::vector<FieldSpec> FaultyStructure::fields()
{
  using enum Location;
  return {
      state("wet", "displacement", node, vector, "m", "u"),
      state("wet", "velocity", node, vector, "m/s", "v"),
      state("wet", "acceleration", node, vector, "m/s^2", "a"),
      output("wet", "work", pane, scalar, "J", "work of the load in this step"),
      fixed("spare", "bulk", element, 4096, "1", "nothing"),
  };
}

std::vector<InputSpec> FaultyStructure::inputs()
{
  return {receive("wet", "traction", Location::node, vector, "Pa", "acts on the mass along +x")};
}

void FaultyStructure::define(const TimeStep&)
{
  make_window("wet", {point_pane(Coordinates::Constant(1, 1, options_.origin))});
  make_window("spare", {spare_pane(options_.fault == "huge")});
  look_up();
  for (const auto& value : {displacement_, velocity_, acceleration_, work_}) value.now().setZero();
  displacement_.now().setConstant(options_.first_displacement);
  if (options_.fault == "stray_write_peer") (void)peer_pane("fluid", ""); // the fluid's wall is mapped from now on
  misbehave("define", 0);
}

void FaultyStructure::attach()
{
  look_up();
  misbehave("attach", 0);
}

void FaultyStructure::look_up()
{
  displacement_ = field("wet", "displacement");
  velocity_ = field("wet", "velocity");
  acceleration_ = field("wet", "acceleration");
  work_ = field("wet", "work");
  traction_ = input("wet", "traction");
}

void FaultyStructure::start(const TimeStep& initial)
{
  const double load = traction_.at(initial.end)(0, 0);
  acceleration_.now()(0, 0) = (load - options_.stiffness * displacement_.now()(0, 0)) / options_.mass;
  work_.now()(0, 0) = 0.0;
  misbehave("start", 0);
}

void FaultyStructure::step(const TimeStep& step)
{
  double& u = displacement_.now()(0, 0);
  double& v = velocity_.now()(0, 0);
  double& a = acceleration_.now()(0, 0);
  const double load = traction_.at(step.end)(0, 0);
  const double u_before = u;
  if (std::exchange(has_derived_, false) && derived_ != displacement_.committed()(0, 0))
    throw Error(Errc::internal, "what its attach derived is of another commit");
  a = (load - options_.damping * v - options_.stiffness * u) / options_.mass;
  v += step.dt * a;
  u += step.dt * v;
  const bool is_left_out = options_.fault == "unwritten" && step.index == options_.at_step;
  if (!is_left_out) work_.now()(0, 0) = load * (u - u_before);
  misbehave("step", step.index);
}

void FaultyStructure::misbehave(const std::string& call, std::int64_t step)
{
  if (call != options_.at || (call == "step" && options_.at_step != 0 && step != options_.at_step)) return;
  const auto& fault = options_.fault;
  if (fault == "none" || fault == "unwritten" || fault == "huge") return; // elsewhere, if at all
  if (fault == "throw") throw std::runtime_error("did not want to go on");
  if (fault == "throw_foreign") return throw_foreign();
  if (fault == "segfault") return segfault();
  if (fault == "abort") std::abort();
  if (fault == "exit") std::exit(3);
  if (fault == "hang") return hang();
  if (fault == "slow") return dawdle(options_.duration);
  if (fault == "derive") {
    has_derived_ = true;
    derived_ = displacement_.committed()(0, 0);
    return dawdle(options_.duration);
  }
  if (fault == "look_back") return (void)displacement_.committed(2);
  if (fault == "print") return print_two_megabytes();
  if (fault == "log") {
    log().info("the first line of step {}\nthe second line of step {}", step, step);
    return log().warning("a warning in step {}", step);
  }
  if (fault == "not_a_number") {
    velocity_.now()(0, 0) = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  if (fault == "garbage_window") {
    std::memset(mapping_of(velocity_.committed(call == "define" ? 0 : 1).data()), 0x5a, 256);
    return;
  }
  if (fault == "stray_write") {
    const_cast<double*>(traction_.newest().data())[0] = 42.0;
    return;
  }
  if (fault == "stray_write_peer") {
    mapping_named("mullion:fluid/wall")[4096] = 42;
    return;
  }
  if (fault == "stray_write_fixed") {
    const_cast<double*>(field("spare", "bulk").values().data())[3] += 1.0;
    return;
  }
  throw Error(Errc::config, fmt::format("there is no fault '{}'", fault));
}

} // namespace mullion::test
