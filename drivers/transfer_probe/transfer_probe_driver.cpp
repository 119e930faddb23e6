// Transfers there and back between a fluid and a structure that do not react to each other: what `mullion
// transfer-test` runs. In each step the structure's motion goes to the fluid and the fluid's load to the structure, so
// that either can compare what arrives with what should.
#include <mullion/coupling/roles.hpp>

namespace mullion::transfer_probe {

class TransferProbe final : public Driver {
public:
  struct Options : FsiOptions {
    static constexpr auto table() { return std::tuple_cat(exchange_options(), motion_option()); }
  };
  explicit TransferProbe(const Options& options) : options_(options) {}

  void define(Wiring& wiring) override
  {
    const auto& pair = wiring.interfaces()[0];
    fluid_name_ = wiring.instance("fluid"), structure_name_ = wiring.instance("structure");
    transfer_name_ = wiring.instance("transfer");
    require_legal_exchange(options_);
    wiring.bind(transfer_name_ + ".structure_side." + options_.motion, pair.structure + "." + options_.motion);
    wiring.bind(pair.fluid + "." + options_.motion, transfer_name_ + ".fluid_side." + options_.motion);
    wiring.bind(transfer_name_ + ".fluid_side." + options_.fluid_exports, pair.fluid + "." + options_.fluid_exports);
    wiring.bind(pair.structure + "." + options_.structure_receives,
                transfer_name_ + ".structure_side." + options_.structure_receives);
  }

  void attach(Coupling& coupling) override
  {
    fluid_ = coupling.module(fluid_name_), structure_ = coupling.module(structure_name_);
    loads_ = coupling.action(transfer_name_, "loads"), motion_ = coupling.action(transfer_name_, "motion");
  }

  void start(const TimeStep& initial) override
  {
    structure_.start(initial);
    motion_(initial);
    fluid_.start(initial);
    loads_(initial);
  }

  void step(const TimeStep& step) override
  {
    structure_.step(step); // its motion
    motion_(step);
    fluid_.step(step); // its load, and how good the motion is that arrived
    loads_(step);
    structure_.step(step); // how good the load is that arrived
  }

private:
  Options options_;
  std::string fluid_name_, structure_name_, transfer_name_;
  ModuleProxy fluid_, structure_;
  Action loads_, motion_;
};

} // namespace mullion::transfer_probe

MULLION_DRIVER(mullion::transfer_probe::TransferProbe, "transfer_probe",
               "transfers there and back between solvers that do not react");
