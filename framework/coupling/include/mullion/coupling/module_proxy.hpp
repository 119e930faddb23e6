// What a driver works with: proxies of modules and handles of fields. Whether a module runs inline or in a process
// of its own does not show here; bulk data never travel, they lie in the windows.
#pragma once

#include <mullion/sdk/error.hpp>
#include <mullion/sdk/mesh.hpp>
#include <mullion/sdk/window.hpp>

#include <cstdint>
#include <string>

namespace mullion {

namespace run {
class Session; // the running case, inside libmullion
}

/// A call that was started and not yet awaited. Await every one; the session awaits what a driver forgot.
class ModuleProxy {
public:
  ModuleProxy() = default;
  ModuleProxy(run::Session* session, std::uint32_t module) : session_(session), module_(module) {}

  /// The module's own first exchange, after the companions it reads were filled; its initial state is then on all
  /// levels. Only in Driver::start.
  void start(const TimeStep& initial) const;
  /// Advance the module over the step; its working level is stamped with `stamp` [s], by default the step's end.
  /// @throws Error what the module threw, its death or its deadline, with the module's name
  void step(const TimeStep& step) const;
  void step(const TimeStep& step, double stamp) const;
  /// The same apart: several modules at the same time, each in a process of its own.
  void begin_step(const TimeStep& step) const;
  void await() const;

private:
  run::Session* session_ = nullptr;
  std::uint32_t module_ = 0;
};

/// A function of a module that writes one of its windows (transfer.loads).
class Action {
public:
  Action() = default;
  Action(run::Session* session, std::uint32_t module, std::uint32_t function)
      : session_(session), module_(module), function_(function)
  {
  }
  void operator()(const TimeStep& step) const { (*this)(step, step.end); }
  void operator()(const TimeStep& step, double stamp) const;

private:
  run::Session* session_ = nullptr;
  std::uint32_t module_ = 0, function_ = 0;
};

/// A function of a module that answers a number (fluid.energy, structure.max_dt).
class Query {
public:
  Query() = default;
  Query(run::Session* session, std::uint32_t module, std::uint32_t function, std::uint32_t n_arguments)
      : session_(session), module_(module), function_(function), n_arguments_(n_arguments)
  {
  }
  template <class... Arguments> double operator()(const TimeStep& step, Arguments... arguments) const
  {
    const double values[] = {static_cast<double>(arguments)..., 0.0};
    return ask(step, values, sizeof...(arguments));
  }

private:
  double ask(const TimeStep& step, const double* values, std::uint32_t n) const;
  run::Session* session_ = nullptr;
  std::uint32_t module_ = 0, function_ = 0, n_arguments_ = 0;
};

/// A field of a module's window, as a driver sees it: read-only.
class ModuleField {
public:
  ModuleField() = default;
  ModuleField(run::Session* session, std::uint32_t window, std::uint32_t field)
      : session_(session), window_(window), field_(field)
  {
  }
  /// The working level: what the module's last call in this step wrote.
  [[nodiscard]] ConstArray now() const;
  /// What was committed `back` steps ago (1: at the step's begin).
  [[nodiscard]] ConstArray committed(int back = 1) const;

private:
  run::Session* session_ = nullptr;
  std::uint32_t window_ = 0, field_ = 0;
};

/// A stored received field, which the driver writes.
class ReceivedField {
public:
  ReceivedField() = default;
  ReceivedField(run::Session* session, std::uint32_t window, std::uint32_t field)
      : session_(session), window_(window), field_(field)
  {
  }
  /// Write the values that the receiver shall take for `time` [s] (which need not be when they were computed).
  template <class Values> void put(const Eigen::MatrixBase<Values>& values, double time) const
  {
    auto to = writable();
    MULLION_REQUIRE(values.rows() == to.rows() && values.cols() == to.cols(), Errc::shape,
                    "a driver wrote a received field of {} x {} values with {} x {}", to.rows(), to.cols(),
                    values.rows(), values.cols());
    to = values;
    stamp(time, MULLION_INSTANT);
  }
  /// The same for a value that stands for the mean over the step whose middle is `time`.
  template <class Values> void put_mean(const Eigen::MatrixBase<Values>& values, double time) const
  {
    put(values, time);
    stamp(time, MULLION_MEAN);
  }
  [[nodiscard]] ConstArray committed(int back = 1) const;

private:
  [[nodiscard]] Array writable() const;
  void stamp(double time, std::uint32_t kind) const;
  run::Session* session_ = nullptr;
  std::uint32_t window_ = 0, field_ = 0;
};

/// A field of driver/state. At the start of a step its working level is a copy of the committed one.
class DriverField {
public:
  DriverField() = default;
  DriverField(run::Session* session, std::uint32_t window, std::uint32_t field)
      : session_(session), window_(window), field_(field)
  {
  }
  [[nodiscard]] Array now() const;
  [[nodiscard]] ConstArray committed(int back = 1) const;

private:
  run::Session* session_ = nullptr;
  std::uint32_t window_ = 0, field_ = 0;
};

/// Where a driver finds its proxies and handles, in attach.
class Coupling {
public:
  Coupling() = default;
  explicit Coupling(run::Session* session) : session_(session) {}

  [[nodiscard]] ModuleProxy module(const std::string& instance) const;
  /// @throws Error Errc::config if the module offers no such function, or one of another signature
  [[nodiscard]] Action action(const std::string& instance, const std::string& function) const;
  [[nodiscard]] Query query(const std::string& instance, const std::string& function, std::uint32_t n_arguments) const;
  /// @param port instance.window.field
  [[nodiscard]] ModuleField field(const std::string& port, std::uint32_t pane = 0) const;
  [[nodiscard]] ReceivedField received(const std::string& port, std::uint32_t pane = 0) const;
  [[nodiscard]] DriverField state(const std::string& name) const;
  /// The reference mesh of a module's window, say an interface. @param window instance.window
  [[nodiscard]] Pane pane(const std::string& window, std::uint32_t pane = 0) const;
  /// Tell the user, with the driver's name, without ending the run.
  void warn(const std::string& text) const;

private:
  run::Session* session_ = nullptr;
};

} // namespace mullion
