// The coupled cases of the plane, from their case files: what Jaiman et al. 2011 claims in sections 5.1, 5.2 and 6.3,
// as exact solutions and measured rates tell it. The bounds come from another implementation of the same problems;
// where a scheme is judged it is judged against another one on the same meshes, as each rate contains the fluid's own
// damping.
#include "io/atomic_file.hpp"
#include "io/hdf5_image.hpp"
#include "run/signal.hpp"
#include "support/history.hpp"
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace mullion;
using namespace mullion::test;

namespace {

using Sets = std::vector<std::string>;

Sets operator+(Sets left, const Sets& right)
{
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// configs/paper/<name>.toml, inline.
void run_paper_case(const RunFolder& folder, const std::string& name, const Sets& sets)
{
  const auto result = folder.run({.file = fmt::format("{}/configs/paper/{}.toml", MULLION_SOURCE_DIR, name),
                                  .sets = sets,
                                  .flags = {"--inline"},
                                  .timeout = std::chrono::minutes(25)});
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
}

struct Rate {
  double sigma = 0.0, frequency = 0.0; ///< [1/s], [Hz]
};

/// Growth of the arch's mode from 4 ms on. @param largest_residual  of the fit; above, the model does not hold
Rate rate_of(const std::string& name, const Sets& sets, int mode = 0, double largest_residual = 0.02)
{
  const RunFolder folder;
  run_paper_case(folder, name, sets);
  const auto history = read_history(folder / "out" / "history.csv");
  const auto& time = history.at("time");
  const auto& q = history.at(fmt::format("structure.volume.modal_coordinate_{}", mode));
  const auto first = static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), 4.0e-3 - 1e-9) - time.begin());
  const std::span times(time.data() + first, time.size() - first), values(q.data() + first, q.size() - first);
  const auto fit = run::growth_rate(times, values, run::dominant_frequency(times, values));
  CHECK(fit.relative_residual < largest_residual);
  return {fit.sigma, fit.frequency};
}

const Sets load = {"driver.structure_receives=load"};
const Sets css = {"driver.scheme=css", "driver.order=fluid_first"};
const Sets css_parallel = {"driver.scheme=css_parallel"};
const Sets gss = {"driver.scheme=gss", "driver.beta=0.5", "driver.profile=constant"};
const Sets iss = {"driver.scheme=iss", "driver.w_end=false"};
/// One-sided gradient, difference of velocities: a recipe whose figures are known, and no good one.
const Sets cibc_recipe = {"driver.scheme=cibc",   "driver.half_offset=true",  "driver.w_end=false",
                          "fluid.gradient=cell",  "driver.fluid_density=1.3", "driver.acceleration=difference",
                          "driver.omega=0.00075", "driver.omega_check=warn"};
/// Irregular triangles, 20 faces on the arch; in steps of 10 us the Courant numbers are 1.85 and 1.64. Triangles
/// without a limiter ran at 2.2 and not at 2.6: the limit for squares, 1.35, is not theirs.
const Sets irregular_box = {"fluid.mesh=box_arch:20x10,delaunay,length=0.34795,thickness=0.006,angle=15,height=0.2,"
                            "growth=1.04,perturb=0.2",
                            "fluid.cfl_max=2.2", "fluid.cfl_warn=2.1"};
const Sets irregular_duct = {"fluid.mesh=duct_arch:20x36,delaunay,length=0.34795,thickness=0.006,angle=15,height=1.25,"
                             "growth=1.06,largest=0.06,left=-2.2,right=2.5,perturb=0.15",
                             "fluid.cfl_max=2.2", "fluid.cfl_warn=2.1"};

/// In vacuo, as Newmark's method runs the arch's 574.261 Hz in steps of 10 and of 50 us.
constexpr double in_vacuo = 574.199, in_vacuo_subcycled = 572.71;

/// What a lag of `lag` seconds adds to the rate: omega tau (2 pi shift), of the frequency that the neutral scheme has
/// on the same mesh.
double lag_law(double frequency, double lag, double without_gas = in_vacuo)
{
  constexpr double two_pi = 2.0 * std::numbers::pi;
  return two_pi * frequency * lag * two_pi * (frequency - without_gas);
}

/// A flat wall radiates 13.3 1/s, and so decays the arch within a tenth, 1.4 to 1.9 Hz below its 574.2; a lag of half a
/// step (css) adds damping of some 0.2 1/s to that, as the gas that goes along with the arch is a mass.
void check_open_duct(const Rate& neutral, const Rate& lagging)
{
  for (const auto& rate : {neutral, lagging}) {
    CHECK(rate.sigma > -14.5);
    CHECK(rate.sigma < -11.0);
    CHECK(rate.frequency > 571.8);
    CHECK(rate.frequency < 573.2);
  }
  CHECK(lagging.sigma - neutral.sigma > -0.30);
  CHECK(lagging.sigma - neutral.sigma < -0.08);
}

/// The same in steps of 50 us, with which Newmark's method runs the arch at 572.7 Hz.
void check_open_duct_subcycled(const Rate& rate)
{
  CHECK(rate.sigma > -14.5);
  CHECK(rate.sigma < -11.0);
  CHECK(rate.frequency > 570.2);
  CHECK(rate.frequency < 572.0);
}

const Sets subcycled = {"run.dt=5e-5", "fluid.substeps=5"};

/// A field of the last result file, (components x entities) one after the other.
std::vector<double> last_output(const RunFolder& folder, const std::string& file, const std::string& path)
{
  const auto image = io::read_checked(folder / "out" / "results" / file);
  return io::ImageReader(image, file).f64(path);
}

/// What is left of the interface behind the superseismic shock's foot, in a window of solid cells.
struct Wake {
  double slope;   ///< least squares of u_y over X
  double scatter; ///< standard deviation of the gas's pressure on the wall over its mean; 0: there is no gas
};

/// @param farthest  solid cells behind the foot; the window begins 4 behind it
Wake wake(const RunFolder& folder, const std::string& file, double foot, double farthest = 30.0)
{
  const auto x = last_output(folder, "mesh.h5", "/structure/wet/pane_0/reference_coordinates");
  const auto u = last_output(folder, file, "/structure/wet/pane_0/displacement");
  const double h = 0.8 / static_cast<double>(x.size() / 2 - 1);
  const auto is_inside = [&](double at) { return at >= foot - farthest * h && at <= foot - 4.0 * h; };
  double n = 0, x_sum = 0, y_sum = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); i += 2) {
    if (!is_inside(x[i])) continue;
    n += 1, x_sum += x[i], y_sum += u[i + 1], xx += x[i] * x[i], xy += x[i] * u[i + 1];
  }
  REQUIRE(n >= 20);
  Wake result{(n * xy - x_sum * y_sum) / (n * xx - x_sum * x_sum), 0.0};
  const auto history = read_history(folder / "out" / "history.csv");
  if (!history.contains("fluid.wall.pressure.mean")) return result;
  const auto p = last_output(folder, file, "/fluid/wall/pane_0/pressure");
  double n_faces = 0, sum = 0, squares = 0; // faces are equal and in their order along x
  for (std::size_t f = 0; f < p.size(); ++f) {
    if (!is_inside(0.8 * (static_cast<double>(f) + 0.5) / static_cast<double>(p.size()))) continue;
    n_faces += 1, sum += p[f], squares += p[f] * p[f];
  }
  const double mean = sum / n_faces;
  result.scatter = std::sqrt(std::max(0.0, squares / n_faces - mean * mean)) / mean;
  return result;
}

constexpr double exact_slope = 0.0080259782256; // of the fronts' jumps, loads on the reference surface
constexpr double foot_after_60_us = 0.1 + 8096.1156223 * 6.0e-5;

struct Piston {
  double chi, displacement; ///< rms deviation of the interface's velocity over its mean; mean [m] at 100 us
  double unevenness;        ///< largest rms deviation of the gas' pressure on the wall over its mean, of all times
};

Piston piston(const Sets& sets)
{
  const RunFolder folder;
  run_paper_case(folder, "elastic_piston", sets);
  const auto history = read_history(folder / "out" / "history.csv");
  const auto& time = history.at("time");
  const auto& mean = history.at("structure.wet.velocity_x.mean");
  const auto& deviation = history.at("structure.wet.velocity_x.deviation");
  Piston result{0.0, 0.0, 0.0};
  const auto& pressure = history.at("fluid.wall.pressure.mean");
  const auto& pressure_deviation = history.at("fluid.wall.pressure.deviation");
  double n = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    result.unevenness = std::max(result.unevenness, pressure_deviation[i] / pressure[i]);
    if (time[i] < 2.0e-5 || time[i] > 1.2e-4) continue;
    result.chi += deviation[i] / mean[i];
    n += 1.0;
  }
  result.chi /= n;
  // between the rows around 100 us; the wall moves evenly by then
  const auto after = std::lower_bound(time.begin(), time.end(), 1.0e-4) - time.begin();
  const auto& u = history.at("structure.wet.displacement_x.mean");
  const auto i = static_cast<std::size_t>(after);
  const double s = (1.0e-4 - time[i - 1]) / (time[i] - time[i - 1]);
  result.displacement = (1.0 - s) * u[i - 1] + s * u[i];
  return result;
}

constexpr double exact_piston = 6.81960493e-4; // m after 100 us: fan and wave meet at p(v) = Z_s v

} // namespace

TEST_CASE("common refinement loads the elastic piston evenly, projections do not")
{
  const auto refined = piston({});
  CHECK(std::abs(refined.displacement / exact_piston - 1.0) < 5e-4);
  CHECK(refined.chi < 1e-10);
  const auto projected = piston({"transfer.module=node_projection"});
  CHECK(projected.chi > 1.5e-2); // 1.7e-2 in another implementation
  CHECK(projected.chi < 1.9e-2);
}

TEST_CASE("in a closed box a lag of the scheme feeds the arch")
{
  const Sets end = {"run.end_time=0.06"};
  const double neutral = rate_of("closed_box", load + iss + end).sigma;

  CHECK(neutral > -0.03); // the fluid's own damping
  CHECK(neutral < 0.005);
  const double lagging = rate_of("closed_box", load + css + end).sigma - neutral;
  CHECK(lagging > 0.035);
  CHECK(lagging < 0.058);
}

TEST_CASE("on irregular triangles, too, a lag feeds the arch by the lag law")
{
  const Sets end = {"run.end_time=0.03"};
  const auto neutral = rate_of("closed_box", load + irregular_box + iss + end);

  CHECK(neutral.sigma > -0.03); // the fluid's own damping
  CHECK(neutral.sigma < 0.005);
  const double lagging = rate_of("closed_box", load + irregular_box + css_parallel + end).sigma - neutral.sigma;
  // The law is of first order in shift over frequency, 5e-4, and in omega tau, 0.05: of second order in both a percent;
  // the frequency in vacuo has as much, its last digit being 0.2 % of the shift.
  CHECK(std::abs(lagging / lag_law(neutral.frequency, 1.5e-5) - 1.0) < 0.05);
}

TEST_CASE("a step in pressure bends the half space behind it by the exact slope")
{
  const RunFolder folder;
  run_paper_case(folder, "superseismic_one_way",
                 {"run.dt=2e-7", "output.every=300", "fluid.mesh=line:80,from=0:0,to=0.8:0",
                  "structure.mesh=box:70x35,size=0.8x0.4,origin=0:-0.4"});

  CHECK(std::abs(wake(folder, "000000300.h5", foot_after_60_us).slope / exact_slope - 1.0) < 2e-3);
}

TEST_CASE("the first load is that on a wall which moves as the solid does at the start")
{
  const RunFolder folder;
  run_paper_case(folder, "superseismic",
                 {"run.end_time=2e-7", "run.dt=2e-7", "fluid.mesh=box:40x20,size=0.8x0.4",
                  "structure.mesh=box:35x17,size=0.8x0.4,origin=0:-0.4"});

  // Behind the foot, at x = 0.1 m, the gas goes along the wall, and so the pressure is the gas's own, wherever the wall
  // moves with its nodes' velocity. Taken to be at rest it would be 47 % higher.
  const auto p = last_output(folder, "000000000.h5", "/fluid/wall/pane_0/pressure");
  REQUIRE(p.size() == 40);
  for (std::size_t f = 0; f < 3; ++f) // 0.02 m a face; the fourth sees a node beyond the foot
    CHECK(p[f] == doctest::Approx(5.5294040012e10).epsilon(1e-6)); // the file's numbers have seven to ten digits
}

TEST_SUITE("full")
{
  TEST_CASE("the piston's evenness by transfer, and on an irregular mesh")
  {
    const auto two = piston({"transfer.module=quadrature_projection", "transfer.points=2"});
    const auto four = piston({"transfer.module=quadrature_projection", "transfer.points=4"});
    CHECK(std::abs(two.chi - 6.0e-3) < 0.15 * 6.0e-3); // the figures have one or two digits
    CHECK(std::abs(four.chi - 2.7e-3) < 0.15 * 2.7e-3);
    CHECK(std::abs(two.displacement / exact_piston - 1.0) < 5e-4);
    const auto irregular = piston({"fluid.mesh=box:80x32,delaunay,size=0.25x0.1,origin=-0.25:0,perturb=0.2"});
    CHECK(std::abs(irregular.displacement / exact_piston - 1.0) < 5e-4);
    // The gas starts with a jump at the wall, and on irregular cells its wave leaves unevenly: then the motion is not
    // one-dimensional, whatever the transfer. A solid at rest answers with v = p/Z: what is uneven in v at first is as
    // uneven as p, and later the solid rings with a part of it. That part is not small, as nothing dissipates it.
    CHECK(irregular.chi < irregular.unevenness);
    CHECK(irregular.chi > 0.01 * irregular.unevenness);
    CHECK(irregular.unevenness < 1e-3); // of the gas alone: 20 times below what node projection does
    const auto strain = piston({"structure.plane=strain"});
    CHECK(std::abs(strain.displacement / 6.22609521e-4 - 1.0) < 5e-4); // the other modulus
  }

  TEST_CASE("rates of the arch in the closed box, by scheme")
  {
    const double neutral = rate_of("closed_box", load + iss).sigma;
    const auto lag_of_css = rate_of("closed_box", load + css);
    CHECK(neutral > -0.03);
    CHECK(neutral < 0.005);
    CHECK(lag_of_css.sigma - neutral > 0.035);
    CHECK(lag_of_css.sigma - neutral < 0.058);
    const double parallel = rate_of("closed_box", load + css_parallel).sigma - neutral;
    CHECK(parallel > 0.105);
    CHECK(parallel < 0.17);
    CHECK(std::abs(rate_of("closed_box", load + gss).sigma - neutral) <= 0.005);
    CHECK(std::abs(rate_of("closed_box", load + cibc_recipe).sigma / -0.132 - 1.0) < 0.1);

    CHECK(std::abs((lag_of_css.sigma - neutral) / lag_law(lag_of_css.frequency, 0.5e-5) - 1.0) < 0.05);
    CHECK(std::abs(parallel / lag_law(lag_of_css.frequency, 1.5e-5) - 1.0) < 0.05);
  }

  TEST_CASE("rates of the arch in the closed box on irregular triangles, by scheme")
  {
    const auto neutral = rate_of("closed_box", load + irregular_box + iss);
    CHECK(neutral.sigma > -0.03);
    CHECK(neutral.sigma < 0.005);
    const double shift = neutral.frequency - in_vacuo;
    CHECK(shift > 0.2); // a spring of a size like that of the squares, 0.4 Hz: the wall cells are twice as high here
    CHECK(shift < 0.5);
    const double lagging = rate_of("closed_box", load + irregular_box + css).sigma - neutral.sigma;
    CHECK(std::abs(lagging / lag_law(neutral.frequency, 0.5e-5) - 1.0) < 0.05);
    const double parallel = rate_of("closed_box", load + irregular_box + css_parallel).sigma - neutral.sigma;
    CHECK(std::abs(parallel / lag_law(neutral.frequency, 1.5e-5) - 1.0) < 0.05);
    CHECK(std::abs(rate_of("closed_box", load + irregular_box + gss).sigma - neutral.sigma) <= 0.005);
  }

  TEST_CASE("the open duct takes the arch's energy on irregular triangles, too")
  {
    const auto neutral = rate_of("flow_shell", irregular_duct + iss);
    const auto lagging = rate_of("flow_shell", irregular_duct + css);
    check_open_duct(neutral, lagging);
    check_open_duct_subcycled(rate_of("flow_shell", irregular_duct + css + subcycled));
  }

  TEST_CASE("the arch of half the duct's frequency decays as theory and another program say")
  {
    // The second mode, 115 Hz. A flat wall radiates 1.44 1/s, the other program found 1.6: bounds that both meet, and
    // that neither growth nor G25's rate does.
    const auto rate =
        rate_of("flow_shell",
                css + Sets{"run.end_time=0.06", "fluid.mesh=duct_arch:62x52,length=0.92437,thickness=0.004,angle=12",
                           "structure.mesh=arch:48x1,length=0.92437,thickness=0.004,angle=12"},
                1, 0.05);
    CHECK(rate.sigma > -2.0);
    CHECK(rate.sigma < -1.3);
  }

  TEST_CASE("rates of the arch in the closed box, subcycled")
  {
    const double neutral = rate_of("closed_box", load + iss + subcycled).sigma;
    const double lagging = rate_of("closed_box", load + css + subcycled).sigma - neutral;
    CHECK(lagging > 0.29);
    CHECK(lagging < 0.48);
    CHECK(std::abs(rate_of("closed_box", load + cibc_recipe + subcycled).sigma / -2.197 - 1.0) < 0.1);
  }

  TEST_CASE("rates of the arch in the closed box on irregular triangles, subcycled")
  {
    const auto neutral = rate_of("closed_box", load + irregular_box + iss + subcycled);
    const double lagging = rate_of("closed_box", load + irregular_box + css + subcycled).sigma - neutral.sigma;
    CHECK(std::abs(lagging / lag_law(neutral.frequency, 2.5e-5, in_vacuo_subcycled) - 1.0) < 0.05);
  }

  TEST_CASE("the open duct takes the arch's energy, whatever the scheme")
  {
    const auto neutral = rate_of("flow_shell", iss);
    const auto lagging = rate_of("flow_shell", css);
    check_open_duct(neutral, lagging);
    check_open_duct_subcycled(rate_of("flow_shell", css + subcycled));
  }

  TEST_CASE("the steady flow lifts the rigid arch")
  {
    const RunFolder folder;
    run_paper_case(folder, "flow_shell_steady", {});

    const auto history = read_history(folder / "out" / "history.csv");
    CHECK(history.at("fluid.volume.residual").back() < 4e-4);
    CHECK(std::abs(history.at("fluid.wall.force_y").back() - 210.0) < 5.0); // N/m, another implementation's pressures
  }

  TEST_CASE(
      "the interface behind the superseismic shock with 5 % of the paper's gas: its slope, and how even its load is")
  {
    // Another program has slopes within 2.1e-3 and scatters of the pressure of 4.3e-3 and 1.4e-3 with the projections
    // and below 4e-4 with common refinement. What is left there are the fronts and the shock, which ring on any mesh.
    const auto run = [](const Sets& sets) {
      const RunFolder folder;
      run_paper_case(folder, "superseismic_lite", sets);
      return wake(folder, "000000600.h5", foot_after_60_us);
    };
    const auto refined = run({});
    CHECK(std::abs(refined.slope / exact_slope - 1.0) < 5e-3);
    CHECK(refined.scatter < 4e-4);
    const auto projected = run({"transfer.module=node_projection"});
    CHECK(std::abs(projected.slope / exact_slope - 1.0) < 5e-3);
    CHECK(std::abs(projected.scatter / 4.3e-3 - 1.0) < 0.15); // the figures have two digits, the limiter is another
    const auto points = run({"transfer.module=quadrature_projection", "transfer.points=2"});
    CHECK(std::abs(points.slope / exact_slope - 1.0) < 5e-3);
    CHECK(std::abs(points.scatter / 1.4e-3 - 1.0) < 0.15);
  }

  TEST_CASE("the interface behind the superseismic shock, on triangles")
  {
    const std::string fluid = "fluid.mesh=box:160x80,size=0.8x0.4,delaunay",
                      solid = "structure.mesh=box:140x70,size=0.8x0.4,origin=0:-0.4,delaunay",
                      irregular = ",perturb=0.2";
    const auto run = [](const std::string& name, const Sets& sets, double farthest) {
      const RunFolder folder;
      run_paper_case(folder, name, sets);
      return wake(folder, "000000600.h5", foot_after_60_us, farthest).slope / exact_slope - 1.0;
    };
    CHECK(std::abs(run("superseismic_one_way", {solid}, 30.0)) < 2e-3);
    CHECK(std::abs(run("superseismic_lite", {fluid, solid}, 30.0)) < 5e-3);
    CHECK(std::abs(run("superseismic_lite", {fluid + irregular}, 30.0)) < 5e-3);
    // Behind the fronts irregular cells ring, and nothing damps that: u_y scatters around the exact one by 0.26 of what
    // it grows by over a cell (rms), at any mesh width. A least-squares slope over n cells scatters by sqrt(12)/n^1.5
    // of that: 7e-3 over the 26 of the other bounds, 2.1e-3 over 56.
    CHECK(std::abs(run("superseismic_one_way", {solid + irregular}, 60.0)) < 5e-3);
    CHECK(std::abs(run("superseismic_lite", {fluid + irregular, solid + irregular}, 60.0)) < 5e-3);
  }

  TEST_CASE("the interface behind the superseismic shock with the paper's gas keeps the exact slope near the shock")
  {
    const RunFolder folder;
    run_paper_case(folder, "superseismic", {});

    constexpr double exact =
        0.15711059069; // traction along the deformed normal, per length of the undeformed interface
    // The bound of the case that is stable. With loads straight down it would be 1.8 % steeper, with loads per current
    // length 4.4 % flatter.
    CHECK(std::abs(wake(folder, "000001200.h5", foot_after_60_us).slope / exact - 1.0) < 5e-3);
  }
}
