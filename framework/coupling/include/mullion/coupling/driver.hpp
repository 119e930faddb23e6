// What a driver is: the coupling scheme, a short algorithm over typed module proxies. It keeps all that it needs
// in order to go on in the window `driver/state`; its members hold options and handles.
//
// Life: constructed with its Options; define() on every start declares the connections and the state fields (it
// sees declarations, no sizes); attach() looks up handles; start() on a fresh start makes the first exchange;
// then step(), once a coupling step. Mullion commits after step() returned; a step may be run again (--replay,
// --amnesia, recovery) from the last commit, and must then give the same bits.
#pragma once

#include <mullion/coupling/driver_plugin.hpp>
#include <mullion/coupling/module_proxy.hpp>
#include <mullion/coupling/wiring.hpp>
#include <mullion/sdk/parameters.hpp>

#include <memory>

namespace mullion {

class Driver {
public:
  virtual ~Driver() = default;
  Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  /// Declare which received fields are bound or stored, and the fields of driver/state.
  virtual void define(Wiring& wiring) = 0;
  /// Look up proxies and field handles.
  virtual void attach(Coupling& coupling) = 0;
  /// Fresh start only: the first exchange, at the initial time.
  virtual void start(const TimeStep& initial) = 0;
  /// One coupling step.
  virtual void step(const TimeStep& step) = 0;
};

namespace detail {
template <class T> struct DriverPluginOf {
  static Driver* create(const mullion_value* values) { return new T(read_options<typename T::Options>(values)); }
  static const void* entry()
  {
    const auto& parameters = parameter_specs<typename T::Options>();
    static const DriverPlugin plugin{parameters.data(), static_cast<std::uint32_t>(parameters.size()), &create};
    return &plugin;
  }
};
} // namespace detail
} // namespace mullion

#ifndef MULLION_BUILD_ID
#include <mullion/coupling/build_id.hpp>
#endif
#ifndef MULLION_PLUGIN_VERSION
#define MULLION_PLUGIN_VERSION "0.1.0"
#endif

/// Export a Driver class as a plug-in.
#define MULLION_DRIVER(Class, name, summary)                                                                           \
  extern "C" __attribute__((visibility("default"))) const mullion_header mullion_plugin;                               \
  extern "C" constexpr mullion_header mullion_plugin = {MULLION_MAGIC,                                                 \
                                                        MULLION_ABI,                                                   \
                                                        sizeof(mullion_header),                                        \
                                                        "driver",                                                      \
                                                        name,                                                          \
                                                        MULLION_PLUGIN_VERSION,                                        \
                                                        summary,                                                       \
                                                        MULLION_BUILD_ID,                                              \
                                                        &::mullion::detail::DriverPluginOf<Class>::entry}
