// The roles of a fluid-structure run and the connections that every scheme shares:
//
//   fluid wall traction    -> transfer (fluid side)      transfer.loads  -> traction on the structure's side
//   what the driver sends  -> transfer (structure side)  transfer.motion -> motion on the fluid's side
//   motion on the fluid's side -> mesh motion -> node velocity of the fluid (bound, at both ends of the step)
//   the fluid's node coordinates -> mesh motion, if it looks where the mesh is (bound)
//
// What is left to the scheme: the motion that it sends, on the structure's nodes (theirs, predicted, mixed, iterated),
// and the load that the structure receives. A scheme that corrects on the fluid's side (wire_fsi: corrects_on_fluid)
// also writes the traction that goes into the transfer and the wall velocity that the mesh motion gets.
#pragma once

#include <mullion/coupling/driver.hpp>

#include <string>

namespace mullion {

/// Options that several schemes share. A driver lists those that it has: it joins the one-entry tables below.
struct FsiOptions {
  std::string motion = "velocity";
  std::string profile = "constant";
  std::string sampling = "last";
  std::string load_interpolation = "linear";
  std::string fluid_exports = "traction", structure_receives = "traction";
  bool recover = false;

  static constexpr auto motion_option()
  {
    return std::tuple{parameter("motion", &FsiOptions::motion, "",
                                "what the fluid learns of the structure: its velocity, through a mesh motion module, "
                                "or its displacement, directly",
                                one_of("velocity", "displacement"))};
  }
  static constexpr auto profile_option()
  {
    return std::tuple{parameter("profile", &FsiOptions::profile, "",
                                "wall velocity within a step: constant (the step's value) or linear (from the last "
                                "step's value)",
                                one_of("constant", "linear"))};
  }
  static constexpr auto sampling_option()
  {
    return std::tuple{parameter("sampling", &FsiOptions::sampling, "",
                                "fluid traction that goes across: last (at the step's end) or mean (over the step)",
                                one_of("last", "mean"))};
  }
  static constexpr auto load_interpolation_option()
  {
    return std::tuple{parameter("load_interpolation", &FsiOptions::load_interpolation, "",
                                "load within the structure's substeps: linear from the last step's, or constant",
                                one_of("linear", "constant"))};
  }
  static constexpr auto receives_option()
  {
    return std::tuple{parameter("structure_receives", &FsiOptions::structure_receives, "",
                                "what the structure takes: traction, or load (nodal forces)",
                                one_of("traction", "load"))};
  }
  static constexpr auto exchange_options()
  {
    return std::tuple{
        parameter("fluid_exports", &FsiOptions::fluid_exports, "",
                  "what the fluid's wall offers: traction (one value a face), nodal_traction, or load (nodal forces)",
                  one_of("traction", "nodal_traction", "load")),
        std::get<0>(receives_option()),
        parameter("recover", &FsiOptions::recover, "",
                  "allow a traction that is recovered from the fluid's nodal forces")};
  }
  [[nodiscard]] bool is_profile_linear() const { return profile == "linear"; }
  /// Net lag of the sampling [steps], where the structure takes the value for the step's end.
  [[nodiscard]] double sampling_lag() const { return sampling == "mean" ? 0.5 : 0.0; }
};

/// What a scheme wants of the shared connections beyond the options.
struct FsiWiring {
  bool corrects_on_fluid = false;         ///< stored, not bound: the traction to transfer, the wall velocity
  bool sends_evaluation_velocity = false; ///< the wall velocity that goes with the exported pressure
};

struct FsiNames {
  std::string fluid, structure, mesh_motion, transfer; ///< mesh_motion: "" if there is none
  std::string wall, wet;                               ///< interface windows, instance.window
  std::string motion;                                  ///< "velocity" or "displacement"
  std::string traction;                                ///< the fluid's output that goes across, instance.window.field
  std::string exported;                                ///< its name on the transfer: "traction", …
  std::string load;                                    ///< what the structure receives, instance.window.field
  std::string received;                                ///< its name on the transfer: "traction" or "load"
  FsiWiring wiring;
};

/// A traction where nodal forces are meant is wrong by an area, and nobody would see it in the numbers.
/// @throws Error Errc::config with the reason
inline void require_legal_exchange(const FsiOptions& options)
{
  MULLION_REQUIRE(options.fluid_exports != "load" || options.structure_receives == "load" || options.recover,
                  Errc::config,
                  "fluid_exports = \"load\" with structure_receives = \"traction\": nodal forces are no traction; let "
                  "the structure receive the load, or allow a traction that is recovered from it: recover = true");
}

/// What a user should know when a scheme without iterations diverges: for Wiring::explain_divergence.
/// @param instead  the scheme that iterates
inline std::string added_mass_hint(const std::string& scheme, const std::string& instead)
{
  return scheme +
         " takes each solver once a step: where the fluid's added mass outweighs the structure's it diverges at "
         "any step size; the scheme \"" +
         instead + "\" iterates";
}

/// Declare the shared connections.
inline FsiNames wire_fsi(Wiring& wiring, const FsiOptions& options, FsiWiring extra = {})
{
  const bool is_velocity = options.motion == "velocity";
  FsiNames names{wiring.instance("fluid"),
                 wiring.instance("structure"),
                 is_velocity ? wiring.instance("mesh_motion") : "",
                 wiring.instance("transfer"),
                 wiring.interfaces()[0].fluid,
                 wiring.interfaces()[0].structure,
                 options.motion,
                 wiring.interfaces()[0].fluid + "." + options.fluid_exports +
                     (options.sampling == "mean" ? "_mean" : ""),
                 options.fluid_exports,
                 wiring.interfaces()[0].structure + "." + options.structure_receives,
                 options.structure_receives,
                 extra};
  require_legal_exchange(options);
  const auto moved = names.transfer + ".fluid_side." + options.motion;

  wiring.store(names.transfer + ".structure_side." + options.motion);
  if (extra.corrects_on_fluid) wiring.store(names.transfer + ".fluid_side." + names.exported);
  else wiring.bind(names.transfer + ".fluid_side." + names.exported, names.traction);
  if (!is_velocity) wiring.bind(names.wall + "." + options.motion, moved);
  else if (extra.corrects_on_fluid) wiring.store(names.mesh_motion + ".wall.velocity");
  else wiring.bind(names.mesh_motion + ".wall.velocity", moved);
  if (is_velocity) {
    wiring.bind(names.fluid + ".volume.velocity", names.mesh_motion + ".volume.velocity",
                options.is_profile_linear() ? TimePolicy::linear : TimePolicy::constant);
    wiring.offer(names.mesh_motion + ".volume.coordinates", names.fluid + ".volume.coordinates", TimePolicy::linear);
  }
  if (extra.sends_evaluation_velocity) wiring.store(names.wall + ".evaluation_velocity");
  wiring.store(names.load, options.load_interpolation == "linear" ? TimePolicy::linear : TimePolicy::constant);
  return names;
}

/// The proxies and handles behind wire_fsi.
struct FsiRoles {
  ModuleProxy fluid, structure, mesh_motion;
  Action transfer_loads, transfer_motion;
  ModuleField structure_motion;      ///< the structure's own velocity [m/s] (or displacement [m]) on its wet nodes
  ModuleField load_on_structure;     ///< traction, transferred to the structure's side [Pa]
  ModuleField motion_on_fluid;       ///< motion, transferred to the fluid's side
  ModuleField fluid_traction;        ///< as the fluid exports it [Pa]
  ReceivedField structure_load;      ///< what the structure receives [Pa]
  ReceivedField sent_motion;         ///< what goes into the transfer, on the structure's nodes
  ReceivedField evaluation_velocity; ///< if sends_evaluation_velocity
  ReceivedField wall_velocity, wall_traction; ///< if corrects_on_fluid: to the mesh motion, into the transfer
  FsiWiring wiring;
  bool has_mesh_motion = false;

  FsiRoles() = default;
  FsiRoles(const Coupling& coupling, const FsiNames& names)
      : fluid(coupling.module(names.fluid)), structure(coupling.module(names.structure)),
        transfer_loads(coupling.action(names.transfer, "loads")),
        transfer_motion(coupling.action(names.transfer, "motion")),
        structure_motion(coupling.field(names.wet + "." + names.motion)),
        load_on_structure(coupling.field(names.transfer + ".structure_side." + names.received)),
        motion_on_fluid(coupling.field(names.transfer + ".fluid_side." + names.motion)),
        fluid_traction(coupling.field(names.traction)), structure_load(coupling.received(names.load)),
        sent_motion(coupling.received(names.transfer + ".structure_side." + names.motion)), wiring(names.wiring),
        has_mesh_motion(!names.mesh_motion.empty())
  {
    if (has_mesh_motion) mesh_motion = coupling.module(names.mesh_motion);
    if (wiring.sends_evaluation_velocity) evaluation_velocity = coupling.received(names.wall + ".evaluation_velocity");
    if (!wiring.corrects_on_fluid) return;
    wall_velocity = coupling.received(names.mesh_motion + ".wall.velocity");
    wall_traction = coupling.received(names.transfer + ".fluid_side." + names.exported);
  }

  /// The first exchange, in the order in which the initial states need one another: the structure's velocity (as its
  /// define left it) on the moving mesh, the fluid's first traction on a wall that moves so, and that traction on the
  /// structure, which may need it for its first acceleration.
  void start(const TimeStep& initial) const
  {
    send_motion(structure_motion.now(), initial);
    if (wiring.corrects_on_fluid) wall_velocity.put(motion_on_fluid.now(), initial.end);
    if (has_mesh_motion) mesh_motion.start(initial);
    fluid.start(initial);
    if (wiring.corrects_on_fluid) wall_traction.put(fluid_traction.now(), initial.end);
    transfer_loads(initial);
    structure_load.put(load_on_structure.now(), initial.end);
    structure.start(initial);
  }

  /// The wall's motion at the end of `step`, given on the structure's nodes, to the fluid's side.
  template <class Values> void send_motion(const Values& motion, const TimeStep& step) const
  {
    sent_motion.put(motion, step.end);
    transfer_motion(step);
  }
  /// The wall velocity that goes with the pressure which the fluid exports at the end of `step`, given on the
  /// structure's nodes. Before send_motion: both go through the same transfer.
  template <class Values> void send_evaluation_velocity(const Values& velocity, const TimeStep& step) const
  {
    send_motion(velocity, step);
    evaluation_velocity.put(motion_on_fluid.now(), step.end);
  }
  /// Mesh and fluid follow the motion that was sent; the fluid's traction reaches the structure's side.
  void advance_fluid(const TimeStep& step) const
  {
    if (has_mesh_motion) mesh_motion.step(step);
    fluid.step(step);
    transfer_loads(step);
  }
  /// The wall moves as given on the structure's nodes, the fluid follows.
  template <class Values> void move_fluid(const Values& motion, const TimeStep& step) const
  {
    send_motion(motion, step);
    advance_fluid(step);
  }
  /// The structure steps under a traction that holds at the end of the step.
  template <class Values> void load_structure(const Values& traction, const TimeStep& step) const
  {
    structure_load.put(traction, step.end);
    structure.step(step);
  }
  /// The structure steps under a traction that is the mean over the step.
  template <class Values> void load_structure_mean(const Values& traction, const TimeStep& step) const
  {
    structure_load.put_mean(traction, 0.5 * (step.begin + step.end));
    structure.step(step);
  }
};

} // namespace mullion
