#include "balance.hpp"

#include "quadrature_rules.hpp"
#include "shape_functions.hpp"
#include "words.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mullion::surface {

namespace {

Point in_space(const FieldView& field, Eigen::Index entity)
{
  Point p = Point::Zero();
  for (Eigen::Index c = 0; c < std::min<Eigen::Index>(field.rows(), 3); ++c) p[c] = field(c, entity);
  return p;
}

Point mean_node(const SurfaceMesh& mesh)
{
  Point sum = Point::Zero();
  for (std::int64_t i = 0; i < mesh.n_nodes(); ++i) sum += node_position(mesh, i);
  return mesh.n_nodes() == 0 ? sum : Point(sum / static_cast<double>(mesh.n_nodes()));
}

void add(Resultant& sum, const Point& x, const Point& centre, const Point& force)
{
  sum.force += force;
  sum.moment += x.cross(force);
  sum.force_scale += force.norm();
  sum.moment_scale += (x - centre).norm() * force.norm();
}

double relative(double difference, double scale)
{
  if (difference == 0.0) return 0.0;
  return scale > 0.0 ? difference / scale : std::numeric_limits<double>::infinity();
}

/// "4 source faces (face 7 at (0.1, 0.2) m; …)"; the first three are named.
template <typename Place> std::string named(const FaceList& list, const char* one, const char* several, Place place)
{
  std::string text = words(list.count, " ", list.count == 1 ? one : several, " (");
  const std::size_t n_named = std::min<std::size_t>(list.first.size(), 3);
  for (std::size_t i = 0; i < n_named; ++i) text += (i == 0 ? "" : "; ") + place(list.first[i]);
  return text + (list.count > static_cast<std::int64_t>(n_named) ? "; …)" : ")");
}

/// "; 4 source faces (face 7 at (0.1, 0.2) m: 0.3 m; …)": those for which `excess` is positive, the largest first, with
/// what `value` says of each; "" if there are none, as where the report holds no faces.
template <typename Excess, typename Value>
std::string worst_faces(const SurfaceMesh& source, const OverlayReport& report, Excess excess, Value value)
{
  FaceList worst;
  std::vector<std::int32_t> found;
  for (std::size_t f = 0; f < report.fit.size(); ++f)
    if (excess(report.fit[f]) > 0.0) found.push_back(static_cast<std::int32_t>(f));
  const auto excess_of = [&](std::int32_t f) { return excess(report.fit[static_cast<std::size_t>(f)]); };
  std::stable_sort(found.begin(), found.end(),
                   [&](std::int32_t a, std::int32_t b) { return excess_of(a) > excess_of(b); });
  for (const auto f : found) worst.add(f);
  if (worst.count == 0) return "";
  return "; " + named(worst, "source face", "source faces", [&](std::int32_t f) {
           return place_of_face(source, f) + ": " + value(report.fit[static_cast<std::size_t>(f)]);
         });
}

} // namespace

Resultant resultant_of_loads(const SurfaceMesh& mesh, const FieldView& loads)
{
  Resultant sum;
  const Point centre = mean_node(mesh);
  for (Eigen::Index j = 0; j < loads.cols(); ++j) add(sum, node_position(mesh, j), centre, in_space(loads, j));
  return sum;
}

Resultant resultant_of_traction(const SurfaceMesh& mesh, const FieldView& traction, Location location)
{
  Resultant sum;
  const Point centre = mean_node(mesh);
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f) {
    const auto nodes = mesh.face(f);
    for (const auto& p : mass_rule(nodes.size())) {
      Point t = Point::Zero();
      if (location == Location::faces) t = in_space(traction, f);
      else {
        const auto n = shape_values(nodes.size(), p.xi);
        for (std::size_t k = 0; k < nodes.size(); ++k) t += n[k] * in_space(traction, nodes[k]);
      }
      add(sum, map_to_space(mesh, f, p.xi), centre, p.weight * measure_density(mesh, f, p.xi) * t);
    }
  }
  return sum;
}

double work_of(const FieldView& loads, const FieldView& motion)
{
  double sum = 0.0;
  for (Eigen::Index j = 0; j < loads.cols(); ++j)
    for (Eigen::Index c = 0; c < loads.rows(); ++c) sum += loads(c, j) * motion(c, j);
  return sum;
}

double work_scale_of(const FieldView& loads, const FieldView& motion)
{
  double sum = 0.0;
  for (Eigen::Index j = 0; j < loads.cols(); ++j) sum += in_space(loads, j).norm() * in_space(motion, j).norm();
  return sum;
}

Defects defects_of(const Balance& b)
{
  return {relative((b.target.force - b.source.force).norm(), b.source.force_scale),
          relative((b.target.moment - b.source.moment).norm(), b.source.moment_scale),
          relative(std::abs(b.target_work - b.source_work), b.work_scale),
          relative(std::abs(b.target_measure - b.source_measure), b.source_measure)};
}

Verdict judge(const SurfaceMesh& source, const SurfaceMesh& target, const OverlayReport& report,
              const Tolerances& tolerances)
{
  Verdict verdict;
  const auto warn = [&](const auto&... parts) { verdict.warnings.push_back(words(parts...)); };
  const auto fail = [&](const auto&... parts) { verdict.errors.push_back(words(parts...)); };
  const auto source_face = [&](std::int32_t f) { return place_of_face(source, f); };
  const auto target_face = [&](std::int32_t f) { return place_of_face(target, f); };
  const auto source_node = [&](std::int32_t i) { return place_of_node(source, i); };
  const auto target_node = [&](std::int32_t i) { return place_of_node(target, i); };
  const double h = std::max(mean_face_size(source), mean_face_size(target));

  const auto gaps_above = [&](double limit) {
    return worst_faces(
        source, report, [&](const FaceFit& fit) { return fit.gap - limit; },
        [](const FaceFit& fit) { return words(fit.gap, " m"); });
  };
  const auto overhangs_above = [&](double limit) {
    return worst_faces(
        source, report, [&](const FaceFit& fit) { return fit.overhang - limit; },
        [](const FaceFit& fit) { return words(fit.overhang, " m"); });
  };
  const auto times = [](const FaceFit& fit) { return words(fit.coverage, " times"); };

  const double gap = relative(report.largest_gap, h), overhang = relative(report.largest_overhang, h);
  if (gap > tolerances.gap_error)
    fail("the surfaces are up to ", report.largest_gap, " m apart, ", gap, " faces; at most ", tolerances.gap_error,
         " faces are sensible", gaps_above(tolerances.gap_error * h), ". Are both in the same coordinates?");
  else if (gap > tolerances.gap_warning)
    warn("the surfaces are up to ", report.largest_gap, " m apart, ", gap, " faces; above ", tolerances.gap_warning,
         " faces the transfer loses accuracy", gaps_above(tolerances.gap_warning * h));
  if (overhang > tolerances.overhang_error)
    fail("the source reaches ", report.largest_overhang, " m beyond the target's end, ", overhang, " faces; at most ",
         tolerances.overhang_error, " of a face is sensible", overhangs_above(tolerances.overhang_error * h));
  else if (overhang > 0.0)
    warn("the source reaches ", report.largest_overhang, " m beyond the target's end; the force there goes to the end",
         " node, whose traction is wrong", overhangs_above(0.0));
  if (report.covered_fraction < tolerances.least_covered)
    fail("only ", 100.0 * report.covered_fraction, " % of the source has a counterpart, less than ",
         100.0 * tolerances.least_covered, " %",
         report.uncovered_faces.count > 0
             ? "; without one: " + named(report.uncovered_faces, "source face", "source faces", source_face)
             : worst_faces(
                   source, report, [](const FaceFit& fit) { return 1.0 - fit.coverage; }, times),
         ". Are both in the same unit, and do they face each other?");
  if (report.uncovered_faces.count > 0)
    warn(named(report.uncovered_faces, "source face", "source faces", source_face), " without a counterpart; ",
         100.0 * (1.0 - report.covered_fraction), " % of the source is not covered, and its force goes to the closest",
         " points");
  if (report.min_coverage < 1.0 - tolerances.coverage_slack || report.max_coverage > 1.0 + tolerances.coverage_slack)
    warn(
        "source faces are covered between ", report.min_coverage, " and ", report.max_coverage, " times",
        worst_faces(
            source, report,
            [&](const FaceFit& fit) {
              const bool is_partly = fit.coverage > 0.0 && fit.coverage < 1.0 - tolerances.coverage_slack;
              return is_partly ? 1.0 - fit.coverage : 0.0;
            },
            times),
        worst_faces(
            source, report, [&](const FaceFit& fit) { return fit.coverage - 1.0 - tolerances.coverage_slack; }, times));
  if (report.unmatched_target_nodes.count > 0)
    warn(named(report.unmatched_target_nodes, "target node", "target nodes", target_node), " without a counterpart",
         report.target_covered_fraction < 1.0
             ? words("; ", 100.0 * (1.0 - report.target_covered_fraction), " % of the target receives nothing")
             : std::string());
  if (report.unmatched_source_nodes.count > 0)
    warn(named(report.unmatched_source_nodes, "source node", "source nodes", source_node),
         " not facing the target; places on it are interpolated");
  if (report.unmatched_source_features.count > 0)
    warn(named(report.unmatched_source_features, "corner or end of the source", "corners and ends of the source",
               source_node),
         " without a partner on the target");
  if (report.unmatched_target_features.count > 0)
    warn(named(report.unmatched_target_features, "corner or end of the target", "corners and ends of the target",
               target_node),
         " without a partner on the source");
  if (report.skipped_source_faces.count > 0)
    warn(named(report.skipped_source_faces, "source face", "source faces", source_face), " without extent, skipped");
  if (report.skipped_target_faces.count > 0)
    warn(named(report.skipped_target_faces, "target face", "target faces", target_face), " without extent, skipped");
  const double a = total_measure(source), b = total_measure(target);
  if (relative(std::abs(a - b), a) > tolerances.measure_warning)
    warn("the source measures ", a, source.dimension == 2 ? " m" : " m^2", ", the target ", b,
         "; are they the same interface?");
  return verdict;
}

std::vector<std::string> complaints_about(const Balance& balance, const Promises& promises,
                                          const Tolerances& tolerances)
{
  std::vector<std::string> complaints;
  const auto defects = defects_of(balance);
  const auto vector = [](const Point& p) { return words("(", p.x(), ", ", p.y(), ", ", p.z(), ")"); };
  if (promises.force && !(defects.force <= tolerances.force_error)) // nor if it is NaN
    complaints.push_back(words("the target receives the force ", vector(balance.target.force), " N, the source gives ",
                               vector(balance.source.force), " N: relative defect ", defects.force, ", at most ",
                               tolerances.force_error, " is round-off"));
  if (promises.work && !(defects.work <= tolerances.work_error))
    complaints.push_back(words("the loads do the work ", balance.target_work, " on the target and ",
                               balance.source_work, " on the source: relative defect ", defects.work, ", at most ",
                               tolerances.work_error, " is round-off"));
  return complaints;
}

std::string places_of_lost_force(const SurfaceMesh& source, const Operator& load, Location location,
                                 const Tolerances& tolerances)
{
  const Operator own = location == Location::nodes ? native_mass(source) : face_split(source);
  Eigen::VectorXd given = Eigen::VectorXd::Zero(load.cols()), arrived = given;
  for (Eigen::Index row = 0; row < own.rows(); ++row)
    for (Operator::InnerIterator it(own, row); it; ++it) given[it.col()] += it.value();
  for (Eigen::Index row = 0; row < load.rows(); ++row)
    for (Operator::InnerIterator it(load, row); it; ++it) arrived[it.col()] += it.value();
  const double largest = given.size() == 0 ? 0.0 : given.maxCoeff();
  FaceList places;
  for (Eigen::Index i = 0; i < given.size(); ++i)
    if (!(std::abs(arrived[i] - given[i]) <= tolerances.force_error * largest))
      places.add(static_cast<std::int32_t>(i));
  if (places.count == 0) return "";
  if (location == Location::nodes)
    return named(places, "source node", "source nodes", [&](std::int32_t i) { return place_of_node(source, i); });
  return named(places, "source face", "source faces", [&](std::int32_t f) { return place_of_face(source, f); });
}

} // namespace mullion::surface
