// A driver that tries every kind of call: both solvers at the same time over stored fields, once a step or in
// iterations, and each misuse that the framework must refuse with a clear message.
#include <mullion/coupling/driver.hpp>

namespace mullion::test {

class CallsDriver final : public Driver {
public:
  struct Options {
    std::string what = "parallel";
    int iterations = 1;
    static constexpr auto table()
    {
      return std::tuple{parameter("what", &Options::what, "", "what to try",
                                  one_of("parallel", "parallel_in_place", "twice", "unknown_function",
                                         "wrong_signature", "no_put", "not_finite", "query")),
                        parameter("iterations", &Options::iterations, "1", "how often each step is done", at_least(1))};
    }
  };
  explicit CallsDriver(const Options& options) : what_(options.what), iterations_(options.iterations) {}

  void define(Wiring& wiring) override
  {
    const auto& [wall, wet] = wiring.interfaces()[0];
    wall_ = wall;
    wet_ = wet;
    fluid_name_ = wiring.instance("fluid");
    structure_name_ = wiring.instance("structure");
    if (what_ == "parallel_in_place") {
      wiring.bind(wall + ".velocity", wet + ".velocity");
      wiring.bind(wet + ".traction", wall + ".traction");
    } else {
      wiring.store(wall + ".velocity");
      wiring.store(wet + ".traction");
    }
    wiring.state_numbers("answer", 1);
  }

  void attach(Coupling& coupling) override
  {
    fluid_ = coupling.module(fluid_name_);
    structure_ = coupling.module(structure_name_);
    answer_ = coupling.state("answer");
    if (what_ == "unknown_function") (void)coupling.query(structure_name_, "energie", 0);
    if (what_ == "wrong_signature") (void)coupling.query(structure_name_, "scaled", 3);
    scaled_ = coupling.query(structure_name_, "scaled", 1);
    if (what_ == "parallel_in_place") return;
    velocity_ = coupling.field(wet_ + ".velocity");
    traction_ = coupling.field(wall_ + ".traction");
    received_velocity_ = coupling.received(wall_ + ".velocity");
    received_traction_ = coupling.received(wet_ + ".traction");
  }

  void start(const TimeStep& initial) override
  {
    if (what_ == "parallel_in_place") return;
    received_velocity_.put(velocity_.now(), initial.end);
    received_traction_.put(traction_.now(), initial.end);
  }

  void step(const TimeStep& step) override
  {
    for (TimeStep k = step; k.iteration < iterations_; ++k.iteration) iterate(k);
  }

private:
  void iterate(const TimeStep& step)
  {
    if (what_ == "not_finite") received_velocity_.put(std::nan("") * velocity_.committed(), step.end);
    if (what_ == "query") {
      const double answer = scaled_(step, 21.0);
      MULLION_REQUIRE(answer == 42.0, Errc::internal, "scaled(21) answered {}", answer);
      answer_.now()(0, 0) = answer;
    }
    if (what_ != "parallel_in_place" && what_ != "no_put") {
      received_velocity_.put(velocity_.committed(), step.end);
      received_traction_.put(traction_.committed(), step.end);
    }
    fluid_.begin_step(step);
    if (what_ == "twice") fluid_.begin_step(step);
    structure_.begin_step(step);
    fluid_.await();
    structure_.await();
  }

  std::string what_, wall_, wet_, fluid_name_, structure_name_;
  int iterations_;
  ModuleProxy fluid_, structure_;
  Query scaled_;
  ModuleField velocity_, traction_;
  ReceivedField received_velocity_, received_traction_;
  DriverField answer_;
};

} // namespace mullion::test

MULLION_DRIVER(mullion::test::CallsDriver, "calls_driver", "test driver: calls at the same time, and misuse");
