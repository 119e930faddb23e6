// What a transfer keeps and what it does not: force, moment and work of both sides, and words for a user, with places,
// when the two surfaces do not fit each other or something gets lost between them.
#pragma once

#include "operators.hpp"
#include "subelement.hpp"
#include "surface_mesh.hpp"

#include <string>
#include <vector>

namespace mullion::surface {

/// Resultant of what acts on one side. In 2D per unit depth, and the moment is that about the third axis.
struct Resultant {
  Point force = Point::Zero();  ///< [N]
  Point moment = Point::Zero(); ///< about the origin [N m]
  double force_scale = 0.0;     ///< sum of the magnitudes: what a defect is measured by [N]
  double moment_scale = 0.0;    ///< sum of distance from the mean node * magnitude [N m]
};

/// @param loads  (dimension x nodes) [N]
[[nodiscard]] Resultant resultant_of_loads(const SurfaceMesh& mesh, const FieldView& loads);

/// Integrals of t and x x t over the surface itself.
///
/// @param traction  (dimension x nodes or faces) [Pa]
[[nodiscard]] Resultant resultant_of_traction(const SurfaceMesh& mesh, const FieldView& traction, Location location);

/// sum_j R_j . v_j: power of loads on velocities [W], or their work on displacements [J].
[[nodiscard]] double work_of(const FieldView& loads, const FieldView& motion);

/// sum_j |R_j| |v_j|: what a defect of work_of() is measured by [W or J]; the work itself may cancel.
[[nodiscard]] double work_scale_of(const FieldView& loads, const FieldView& motion);

/// Both sides of one transfer.
struct Balance {
  Resultant source, target;
  double source_work = 0.0, target_work = 0.0;       ///< [W] or [J]
  double work_scale = 0.0;                           ///< of the target [W] or [J]
  double source_measure = 0.0, target_measure = 0.0; ///< length [m] or area [m^2]
};

/// Relative defects of a balance, target against source.
struct Defects {
  double force = 0.0;   ///< |difference| / sum of the source's magnitudes
  double moment = 0.0;  ///< |difference| / the source's moment scale
  double work = 0.0;    ///< |difference| / the work scale
  double measure = 0.0; ///< |difference| / the source's
};

/// A defect whose scale is zero is zero if the two agree, else infinite.
[[nodiscard]] Defects defects_of(const Balance& balance);

/// What is put up with. Gaps and overhangs are in units of the larger of the two meshes' mean face sizes.
struct Tolerances {
  double gap_warning = 0.5, gap_error = 2.0;
  double overhang_error = 0.5;  ///< a source that reaches further beyond the target; less is a warning
  double least_covered = 0.5;   ///< fraction of the source's measure that has a counterpart; less is an error
  double coverage_slack = 0.1;  ///< of a source face, either way: a warning
  double measure_warning = 0.1; ///< relative difference of the two lengths or areas
  double force_error = 1e-10;   ///< relative; for loads on the source's metric
  double work_error = 1e-10;    ///< relative; for motion that is adjoint to the loads
};

struct Verdict {
  std::vector<std::string> warnings, errors;
};

/// What a user must know about two surfaces that were overlaid, place by place.
[[nodiscard]] Verdict judge(const SurfaceMesh& source, const SurfaceMesh& target, const OverlayReport& report,
                            const Tolerances& tolerances);

/// What a transfer keeps to round-off.
struct Promises {
  bool force = true; ///< loads on the source's metric
  bool work = false; ///< the motion is transferred by the operator that is adjoint to the loads'
};

/// What is promised and not kept, with both numbers; empty if all is well.
[[nodiscard]] std::vector<std::string> complaints_about(const Balance& balance, const Promises& promises,
                                                        const Tolerances& tolerances);

/// Where force gets lost or made: nodes or faces of the source of which a unit traction does not arrive whole, the
/// column of B against the integral of the source's own shape function. "" if there are none.
[[nodiscard]] std::string places_of_lost_force(const SurfaceMesh& source, const Operator& load, Location location,
                                               const Tolerances& tolerances);

} // namespace mullion::surface
