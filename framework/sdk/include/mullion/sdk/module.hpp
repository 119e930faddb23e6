// What a module is: code that attaches to windows and advances them. All that a module needs in order to go on
// stands in its windows; a member may hold parameters, handles and what attach() can rebuild, never state.
//
// Life of an instance: constructed with its Options; on a fresh start define() makes the windows and writes the
// first state; attach() (on every start, restart, respawn, swap) looks up handles and rebuilds what is derived;
// on a fresh start start() completes the first state from received fields; then step(), again and again, each
// time writing the working level of its own windows only.
#pragma once

#include <mullion/sdk/error.hpp>
#include <mullion/sdk/field.hpp>
#include <mullion/sdk/log.hpp>
#include <mullion/sdk/mesh.hpp>
#include <mullion/sdk/parameters.hpp>
#include <mullion/sdk/window.hpp>

#include <string>
#include <tuple>
#include <vector>

namespace mullion {

class Module {
public:
  virtual ~Module() = default;
  Module() = default;
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  /// Fresh start only: make every declared window, write fixed fields and the first state (all into level 0).
  virtual void define(const TimeStep& initial) = 0;
  /// Every start: look up the handles, rebuild what is derived. May read all windows, writes none.
  virtual void attach() = 0;
  /// Fresh start only, after the driver filled the companions: complete the first state (say, accelerations).
  virtual void start(const TimeStep&) {}
  /// Advance the working level from step.begin to step.end.
  virtual void step(const TimeStep&)
  {
    throw Error(Errc::internal, "this module has no step; call its functions by name");
  }

  void bind_services(const Services& services) { services_ = services; } // for plugin.hpp

protected:
  /// Make a declared window over these panes; its declared fields come by themselves. Only in define.
  void make_window(const std::string& window, const std::vector<Pane>& panes) const
  {
    std::vector<std::vector<mullion_block>> blocks(panes.size());
    std::vector<mullion_pane> raw(panes.size());
    for (std::size_t p = 0; p < panes.size(); ++p) {
      for (const auto& block : panes[p].blocks) {
        const auto type = static_cast<std::uint32_t>(block.type);
        MULLION_REQUIRE(block.connectivity.rows() == nodes_per_element(type), Errc::shape,
                        "window {}: a block of element type {} has {} nodes an element, its type has {}", window, type,
                        block.connectivity.rows(), nodes_per_element(type));
        blocks[p].push_back({type, nodes_per_element(type), block.connectivity.cols(), block.connectivity.data()});
      }
      raw[p] = {panes[p].id,
                panes[p].coordinates.cols(),
                panes[p].n_elements(),
                panes[p].coordinates.data(),
                blocks[p].data(),
                static_cast<std::uint32_t>(blocks[p].size()),
                static_cast<std::uint32_t>(panes[p].coordinates.rows())};
    }
    services_.require(services_.raw()->make_window(services_.context(), window.c_str(), raw.data(),
                                                   static_cast<std::uint32_t>(raw.size())));
  }
  /// A pane of another module, only in define: `kind` as in the case file; window "" is its interface window.
  [[nodiscard]] Pane peer_pane(const std::string& kind, const std::string& window, std::uint32_t pane = 0) const
  {
    mullion_pane raw{};
    services_.require(services_.raw()->peer_pane(services_.context(), kind.c_str(), window.c_str(), pane, &raw));
    return to_pane(raw);
  }
  /// A fixed integer field of another module, only in define.
  [[nodiscard]] Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic> peer_indices(const std::string& kind,
                                                                                  const std::string& window,
                                                                                  const std::string& field,
                                                                                  std::uint32_t pane = 0) const
  {
    mullion_array raw{};
    services_.require(
        services_.raw()->peer_fixed(services_.context(), kind.c_str(), window.c_str(), pane, field.c_str(), &raw));
    MULLION_REQUIRE(raw.scalar == MULLION_I32, Errc::shape, "field {} of the {} holds no integers", field, kind);
    return ConstIndexArray(static_cast<const Index*>(raw.data), raw.components, raw.entities);
  }
  /// A pane of an own window: reference coordinates and elements. Build derived data from this in attach().
  [[nodiscard]] Pane pane(const std::string& window, std::uint32_t pane = 0) const
  {
    mullion_pane raw{};
    services_.require(services_.raw()->pane(services_.context(), window.c_str(), pane, &raw));
    return to_pane(raw);
  }
  /// The handle of an own field.
  [[nodiscard]] Field field(const std::string& window, const std::string& name, std::uint32_t pane = 0) const
  {
    std::uint32_t handle = 0;
    services_.require(services_.raw()->field(services_.context(), window.c_str(), pane, name.c_str(), &handle));
    return {&services_, handle};
  }
  /// The handle of a received field; ask is_connected() where it is optional.
  [[nodiscard]] Input input(const std::string& window, const std::string& name, std::uint32_t pane = 0) const
  {
    std::uint32_t handle = 0;
    services_.require(services_.raw()->input(services_.context(), window.c_str(), pane, name.c_str(), &handle));
    return {&services_, handle};
  }
  [[nodiscard]] Log log() const { return Log(&services_); }

private:
  Services services_{nullptr, nullptr};
};

/// One function that a module offers by name; use action() or query() to make one.
template <class Member> struct Function {
  const char* name;
  Member member;
  const char* writes;
  const char* meaning;
};

/// A function of the step that writes the working level of the window `writes`: void f(const TimeStep&).
template <class Owner>
constexpr auto action(const char* name, void (Owner::*member)(const TimeStep&), const char* writes, const char* meaning)
{
  return Function<void (Owner::*)(const TimeStep&)>{name, member, writes, meaning};
}

/// A function of up to eight numbers that writes nothing: double f(double, …).
template <class Owner, class... Arguments>
constexpr auto query(const char* name, double (Owner::*member)(Arguments...), const char* meaning)
{
  return Function<double (Owner::*)(Arguments...)>{name, member, "", meaning};
}

} // namespace mullion
