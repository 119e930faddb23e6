// Solvers on their own: each module that has a step takes it, nothing goes from one to another. For a flow around a
// rigid body, a steady state, a structure's vibration, before anything is coupled.
#include <mullion/coupling/driver.hpp>

#include <string>
#include <vector>

namespace mullion::uncoupled {

class Uncoupled final : public Driver {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };

  explicit Uncoupled(const Options&) {}

  void define(Wiring& wiring) override
  {
    for (const char* kind : {"fluid", "structure"})
      if (wiring.has(kind)) instances_.push_back(wiring.instance(kind));
    MULLION_REQUIRE(!instances_.empty(), Errc::config,
                    "it runs a fluid or a structure, and the case has neither; add a table with one: module = \"…\"");
  }

  void attach(Coupling& coupling) override
  {
    for (const auto& instance : instances_) solvers_.push_back(coupling.module(instance));
  }

  void start(const TimeStep& initial) override
  {
    for (const auto& solver : solvers_) solver.start(initial);
  }

  void step(const TimeStep& step) override
  {
    for (const auto& solver : solvers_) solver.begin_step(step); // at the same time, where they are in processes
    for (const auto& solver : solvers_) solver.await();
  }

private:
  std::vector<std::string> instances_;
  std::vector<ModuleProxy> solvers_;
};

} // namespace mullion::uncoupled

MULLION_DRIVER(mullion::uncoupled::Uncoupled, "uncoupled", "a fluid or a structure (or both) without any coupling");
