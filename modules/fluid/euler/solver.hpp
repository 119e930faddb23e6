// The finite-volume solver: amounts of mass, momentum and energy in the cells of a mesh that rests or moves, advanced
// by four stages of Runge-Kutta. Its memory is geometry and scratch; what is to be kept stands with the caller.
//
// Results do not depend on the number of threads: each adds up what enters its own cells, face by face in the order
// of their numbers, and computes the faces between two threads' cells twice.
#pragma once

#include "boundary.hpp"
#include "crew.hpp"
#include "flux.hpp"
#include "geometry.hpp"
#include "mesh.hpp"
#include "reconstruction.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace mullion::euler {

enum class Integrator { jameson, rk4 };
enum class Width { baseline, four, eight, best }; ///< lanes of a vector; what the processor has is the limit

template <int D> struct Scheme {
  Gas gas;
  Flux flux = Flux::hllc;
  int order = 2; ///< in space: 1 or 2
  LimiterOptions<D> limiter;
  Integrator integrator = Integrator::jameson;
  Width width = Width::best; ///< of vectors; no bit depends on it
};

/// What a boundary face delivered in a step, as the Runge-Kutta scheme integrates it; walls only.
template <int D> struct WallIntegral {
  double mean_pressure = 0.0;        ///< [Pa]
  Vec<D> impulse = Vec<D>::Zero();   ///< integral of p N [N s], N out of the gas
  Vec<D> area_time = Vec<D>::Zero(); ///< integral of N [m^2 s]
  double work = 0.0;                 ///< integral of p dV: what the gas lost [J]
  double swept = 0.0;                ///< integral of dV [m^3]
};

/// How a step ended.
template <int D> struct Outcome {
  enum class Kind { fine, cell_shape, courant, no_gas };
  Kind kind = Kind::fine;
  Index cell = -1;      ///< where it failed, of the mesh's own order
  double value = 0.0;   ///< cell_shape: the volume
  Values<D> state{};    ///< no_gas: what was found (rho, u, p)
  double courant = 0.0; ///< the largest Courant number at the begin of the step
  Index courant_cell = -1;
};

/// The cells of one thread, and its scratch.
template <int D> struct SolverPart {
  std::size_t begin = 0, end = 0; ///< cells
  std::vector<Index> halo;        ///< faces that others own, with a neighbour in here
  Index bad_cell = -1;            ///< the first that is no gas or has no volume
  bool bad_shape = false;
  double courant = 0.0;
  Index courant_cell = -1;

  // What leaves each cell, and what its faces sweep: of the cells between the first that is not finished and the last
  // that a face has met. Rings, a power of two long; a cell's place is its number modulo the length.
  std::vector<Values<D>> residuals;
  std::vector<double> swept;

  // Of a block of cells: through the faces that they own, what leaves them, and their volumes at the stage's end where
  // these move.
  std::vector<Values<D>> fluxes, totals;
  std::vector<double> volumes;
};

/// Cells whose faces are computed before the cells are finished.
inline constexpr std::size_t sweep_block = 128;

/// One stage of a step: from which instant its fluxes are, and what follows from them.
struct SolverStage {
  int number = 0;       ///< 0 to 3
  double advance = 0.0; ///< the next stage stands at amounts - advance dt residual; unused in the last
  double weight = 0.0;  ///< of its residual in the step
  double time = 0.0;    ///< of its values, part of dt
  bool sums = false;    ///< several stages have a weight
  bool is_last = false;
  // Its faces' planes: near * sweep up to near_part dt + far * sweep up to far_part dt.
  double near = 1.0, near_part = 1.0, far = 0.0, far_part = 1.0;
};

template <int D> class Solver {
public:
  /// @throws MeshError if the boundary has a patch without a condition
  Solver(Mesh<D> mesh, std::vector<Condition<D>> conditions, const Scheme<D>& scheme, int n_threads = 1);

  [[nodiscard]] const Mesh<D>& mesh() const { return mesh_; }
  [[nodiscard]] const Geometry<D>& geometry() const { return geometry_; }
  [[nodiscard]] const Scheme<D>& scheme() const { return scheme_; }
  [[nodiscard]] const std::vector<Condition<D>>& conditions() const { return conditions_; }
  void set_order(int order) { scheme_.order = order; }

  /// Geometry of the mesh with its nodes here, at rest. Needed before the first step on a resting mesh.
  [[nodiscard]] Outcome<D> place(const Nodes<D>& x);

  /// One step on the mesh where place() put it.
  /// @param courant_limit  the step is not made where the Courant number is larger
  [[nodiscard]] Outcome<D> advance(std::span<Values<D>> amounts, double t, double dt, const Nodes<D>& x,
                                   double courant_limit);
  /// One step while the nodes go from x to x + v dt. Places the mesh first.
  [[nodiscard]] Outcome<D> advance_moving(std::span<Values<D>> amounts, double t, double dt, const Nodes<D>& x,
                                          const Nodes<D>& v, double courant_limit);
  /// One step towards a steady state: each cell with its own time step, at one Courant number.
  /// @return  outcome; residual() is that of this step's begin
  [[nodiscard]] Outcome<D> iterate(std::span<Values<D>> amounts, double t, double courant, const Nodes<D>& x);

  /// L2 norm over the volume of d rho / dt [kg/(m^3 s)] at the begin of the last iterate().
  [[nodiscard]] double residual() const { return residual_; }

  /// Largest stable step per Courant number: 1 / max(lambda_i / V_i) [s], the mesh at rest where place() put it.
  [[nodiscard]] double unit_step(std::span<const Values<D>> amounts);

  /// By boundary face; of the last step.
  [[nodiscard]] const std::vector<WallIntegral<D>>& wall_integrals() const { return wall_; }

  /// Bytes of all that is held.
  [[nodiscard]] std::size_t memory() const;

private:
  using Part = SolverPart<D>;
  using Stage = SolverStage;
  struct Step {
    std::span<Values<D>> amounts;
    double t, dt;
    const Nodes<D>* x;
    const Nodes<D>* v; ///< null: at rest
    double courant;    ///< local steps of this Courant number; 0: dt for all
    double courant_limit;
  };

  /// As place(), without the planes of the faces.
  Outcome<D> place_cells(const Nodes<D>& x);
  Outcome<D> run(const Step& step);
  void find_values(Part& part, std::span<const Values<D>> amounts);
  void find_planes(const Part& part, const Step& step, const Stage& stage);
  void find_gradients(const Part& part);
  void find_courant(Part& part, const Step& step);
  void sweep(Part& part, const Step& step, const Stage& stage);
  template <int N, bool is_second, Flux flux> void sweep_loop(Part& part, const Step& step, const Stage& stage);
  /// What enters a part's cells through faces that others own.
  template <int N, bool is_second, Flux flux> void sweep_halo(Part& part) const;
  /// Fluxes through the faces [begin, end) that a block of cells owns.
  /// @param b  the first boundary face that is not below `begin`; then the first not below `end`
  template <int N, bool is_second, Flux flux>
  void find_fluxes(Part& part, std::size_t begin, std::size_t end, std::size_t& b);
  /// Totals of the cells [begin, end), a block, which own the fluxes.
  void add_up(Part& part, std::size_t begin, std::size_t end) const;
  /// Makes changes of the totals, and volumes, where cells have their own steps, volumes move, or stages are added up.
  void weigh(Part& part, const Step& step, const Stage& stage, std::size_t begin, std::size_t end);
  /// Next values of the block of cells from `begin` on, from amounts - dt totals. After the last stage these are the
  /// amounts.
  /// @param amounts, volumes  of the block
  template <int N>
  void finish(Part& part, std::span<Values<D>> amounts, bool is_last, double dt, const double* volumes,
              std::size_t begin);
  /// Puts the state that a boundary sets beside the gas at its face b, lane i.
  template <std::size_t N> void set_beside(std::size_t b, std::size_t i, FaceStates<D, Lanes<N>>& states) const;
  /// Puts the flux that a boundary imposes at its face b, lane i of the states; notes the pressure on walls.
  template <std::size_t N>
  void set_flux(std::size_t b, std::size_t i, const FaceStates<D, Lanes<N>>& states, Values<D>& flux);
  void find_prescribed(const Step& step, double time_of_stage);
  void size_rings(Part& part) const;
  void add_wall(const Step& step, double weight);

  Mesh<D> mesh_;
  std::vector<Condition<D>> conditions_;
  Scheme<D> scheme_;
  Crew crew_;
  std::vector<std::unique_ptr<Part>> parts_; // each in memory of its own

  Geometry<D> geometry_;
  std::vector<Values<D>> values_, next_values_; ///< (rho, u, p) of the stage and the next
  std::vector<Gradient<D>> gradients_;          ///< limited
  std::vector<Values<D>> sums_;                 ///< of what left each cell over the stages; rk4 only
  std::vector<double> swept_sums_;              ///< of what its faces swept; rk4 only
  std::vector<double> local_dt_;                ///< local steps only
  std::vector<double> rates_;                   ///< d rho / dt; local steps only
  std::vector<Values<D>> prescribed_;           ///< by boundary face; where there are any
  std::vector<double> stage_pressure_;          ///< by boundary face
  std::vector<WallIntegral<D>> wall_;
  double residual_ = 0.0;
  bool has_prescribed_ = false;
};

} // namespace mullion::euler
