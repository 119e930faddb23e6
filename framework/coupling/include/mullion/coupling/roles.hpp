// The four roles of a fluid-structure run and the connections that every scheme shares:
//
//   fluid wall traction -> transfer (fluid side)          transfer.loads  -> transfer (structure side) traction
//   structure velocity  -> transfer (structure side)      transfer.motion -> transfer (fluid side) velocity
//   mesh motion's node velocity -> fluid (bound, at both ends of the step)
//
// What is left to the scheme: the load that the structure receives and the wall velocity that the mesh motion
// receives. Both are stored: the scheme combines them and says for which time they hold.
#pragma once

#include <mullion/coupling/driver.hpp>

#include <string>

namespace mullion {

struct FsiNames {
  std::string fluid, structure, mesh_motion, transfer;
  std::string wall, wet; ///< interface windows, instance.window
};

/// Declare the shared connections. @param profile how the fluid sees the node velocity within a step
inline FsiNames wire_fsi(Wiring& wiring, TimePolicy profile, TimePolicy load_policy = TimePolicy::linear)
{
  FsiNames names{wiring.instance("fluid"),    wiring.instance("structure"), wiring.instance("mesh_motion"),
                 wiring.instance("transfer"), wiring.interfaces()[0].fluid, wiring.interfaces()[0].structure};
  wiring.bind(names.transfer + ".fluid_side.traction", names.wall + ".traction");
  wiring.bind(names.transfer + ".structure_side.velocity", names.wet + ".velocity");
  wiring.bind(names.fluid + ".volume.velocity", names.mesh_motion + ".volume.velocity", profile);
  wiring.store(names.mesh_motion + ".wall.velocity");
  wiring.store(names.wet + ".traction", load_policy);
  return names;
}

/// The proxies and handles behind wire_fsi.
struct FsiRoles {
  ModuleProxy fluid, structure, mesh_motion;
  Action transfer_loads, transfer_motion;
  ModuleField load_on_structure; ///< traction, transferred to the structure's side [Pa]
  ModuleField motion_on_fluid;   ///< velocity, transferred to the fluid's side [m/s]
  ReceivedField structure_load;  ///< what the structure receives [Pa]
  ReceivedField wall_velocity;   ///< what the mesh motion receives [m/s]

  FsiRoles() = default;
  FsiRoles(const Coupling& coupling, const FsiNames& names)
      : fluid(coupling.module(names.fluid)), structure(coupling.module(names.structure)),
        mesh_motion(coupling.module(names.mesh_motion)), transfer_loads(coupling.action(names.transfer, "loads")),
        transfer_motion(coupling.action(names.transfer, "motion")),
        load_on_structure(coupling.field(names.transfer + ".structure_side.traction")),
        motion_on_fluid(coupling.field(names.transfer + ".fluid_side.velocity")),
        structure_load(coupling.received(names.wet + ".traction")),
        wall_velocity(coupling.received(names.mesh_motion + ".wall.velocity"))
  {
  }

  /// The first exchange, in the order in which the initial states need one another: the fluid's first traction on
  /// the structure (which may need it for its first acceleration), the structure's velocity on the moving mesh.
  void start(const TimeStep& initial) const
  {
    fluid.start(initial);
    transfer_loads(initial);
    structure_load.put(load_on_structure.now(), initial.end);
    structure.start(initial);
    transfer_motion(initial);
    wall_velocity.put(motion_on_fluid.now(), initial.end);
    mesh_motion.start(initial);
  }
};

} // namespace mullion
