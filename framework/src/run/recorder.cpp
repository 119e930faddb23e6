#include "run/recorder.hpp"

#include "io/atomic_file.hpp"
#include "log/console.hpp"

#include <mullion/coupling/build_id.hpp>
#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace mullion::run {

namespace {

/// Result files of an earlier run in this folder: they would stand beside the new ones, unindexed and misleading.
void remove_old_results(const std::filesystem::path& out)
{
  namespace fs = std::filesystem;
  std::error_code ignored;
  for (const char* name : {"history.csv", "results.xdmf", "results.h5", "post-mortem.txt"})
    fs::remove(out / name, ignored);
  for (const auto& entry : fs::directory_iterator(out / "results", ignored))
    if (entry.path().extension() == ".h5") fs::remove(entry.path(), ignored);
  io::remove_stale_temporaries(out);
  io::remove_stale_temporaries(out / "results");
}

} // namespace

Recorder::Recorder(const Case& the_case, std::filesystem::path out, shm::Control& control)
    : case_(the_case), out_(std::move(out)), control_(control), begun_(Clock::now())
{
  io::make_folder(out_);
  remove_old_results(out_);
  io::write_atomically(out_ / "case.toml", case_.text);
  record_.name = case_.name;
  auto& attempt = record_.attempts.emplace_back();
  attempt.versions = {{"mullion", MULLION_VERSION}, {"build", MULLION_BUILD_ID}};
  attempt.start = io::utc_now();
  attempt.driver = case_.scheme;
  for (const auto& module : case_.modules)
    attempt.modules.push_back({module.instance, module.kind, module.plugin, module.version, module.is_process});
  const auto record_file = std::filesystem::absolute(out_ / "run.json").string();
  io::write_run_record(record_file, record_);
  shm::copy_text(control_.outcome_file, sizeof control_.outcome_file, record_file, "path of run.json");
}

void Recorder::begin(Session& session)
{
  session_ = &session;
  choose_columns();
  for (const auto& expectation : case_.expectations) {
    const auto found = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const auto& column) { return column.name == expectation.quantity; });
    if (found == columns_.end()) {
      std::string known;
      for (const auto& column : columns_) known += (known.empty() ? "" : ", ") + column.name;
      throw Error(Errc::config, fmt::format("[[expect]] quantity '{}' is no column of history.csv; there are {}",
                                            expectation.quantity, known));
    }
    series_.push_back({expectation.quantity, {}, {}});
    series_columns_.push_back(static_cast<std::size_t>(found - columns_.begin()));
  }
  if (case_.has_history) {
    std::vector<std::string> names;
    for (const auto& column : columns_) names.push_back(column.name);
    history_ = std::make_unique<io::HistoryWriter>(out_ / "history.csv", names);
    record_.attempts.back().files.emplace_back("history.csv");
  }
  if (case_.output_every > 0) {
    results_ = std::make_unique<io::ResultsWriter>(out_, case_.name);
    results_->begin(snapshot());
    for (const char* file : {"results.xdmf", "results.h5", "results/"})
      record_.attempts.back().files.emplace_back(file);
  }
  record({0, case_.start_time, case_.start_time, case_.dt, 0});
  begun_ = Clock::now(); // wall time per step: without the start-up
  output_ns_ = 0;
}

// ---- history -----------------------------------------------------------------------------------------------------

void Recorder::choose_columns()
{
  // The interface windows, value by value where there is one entity, mean, largest magnitude and standard deviation
  // where there are many; and every output on a pane (energies, work, …) of any module.
  std::vector<std::string> interface_windows;
  for (const auto& pair : case_.interfaces)
    for (auto path : {pair.fluid, pair.structure}) {
      path[path.find('.')] = '/';
      interface_windows.push_back(path);
    }
  for (std::uint32_t w = 0; w < control_.n_windows; ++w) {
    if (control_.windows[w].owner != shm::Owner::module) continue;
    const std::string name = control_.windows[w].name;
    const bool is_interface =
        std::find(interface_windows.begin(), interface_windows.end(), name) != interface_windows.end();
    const auto fields = session_->windows().view(w).fields();
    for (std::uint32_t f = 0; f < fields.size(); ++f) {
      const auto& field = fields[f];
      if (static_cast<shm::Storage>(field.storage) != shm::Storage::level || field.scalar != MULLION_F64) continue;
      const bool is_pane_output = field.location == MULLION_PANE && field.role == MULLION_OUTPUT;
      if (!is_interface && !is_pane_output) continue;
      auto quantity = name;
      std::replace(quantity.begin(), quantity.end(), '/', '.');
      quantity += fmt::format(".{}", field.name);
      if (session_->windows().view(w).header().n_panes > 1) quantity += fmt::format("[{}]", field.pane);
      for (std::uint32_t c = 0; c < field.components; ++c) {
        const auto column = field.components == 1   ? quantity
                            : field.components <= 3 ? fmt::format("{}_{}", quantity, "xyz"[c])
                                                    : fmt::format("{}_{}", quantity, c);
        if (field.entities == 1) {
          columns_.push_back({column, {w, f}, static_cast<int>(c), Statistic::value});
        } else {
          columns_.push_back({column + ".mean", {w, f}, static_cast<int>(c), Statistic::mean});
          columns_.push_back({column + ".max", {w, f}, static_cast<int>(c), Statistic::largest});
          columns_.push_back({column + ".deviation", {w, f}, static_cast<int>(c), Statistic::deviation});
        }
      }
    }
  }
  choose_driver_columns();
  row_.resize(columns_.size());
  for (const auto& column : columns_) record_.columns.emplace_back(column.name, unit_of(column));
  io::write_run_record(out_ / "run.json", record_); // with units, for who looks while the run goes on, or after a crash
}

std::string Recorder::unit_of(const Column& column) const
{
  const auto& ledger = session_->ledger();
  const bool is_ledger =
      ledger && column.at.window == ledger->state.window && column.at.field == ledger->state.field; // several units
  if (is_ledger) return ledger_columns(*ledger)[static_cast<std::size_t>(column.entity)].unit;
  return session_->windows().view(column.at.window).fields()[column.at.field].unit;
}

void Recorder::choose_driver_columns()
{
  // The ledger, and the numbers that the scheme reports.
  for (const auto& state : session_->wiring().states)
    if (state.is_reported)
      columns_.push_back({"driver." + state.name, session_->find_state(state.name), 0, Statistic::value});
  if (!session_->ledger()) return;
  const auto& ledger = *session_->ledger();
  Eigen::Index entity = 0;
  for (const auto& column : ledger_columns(ledger))
    columns_.push_back({column.name, ledger.state, 0, Statistic::value, entity++});

  const auto& wet = session_->windows().view(ledger.structure.window);
  const auto number = [](int field) { return static_cast<std::uint32_t>(field); };
  if (const int f = wet.find_field(0, "velocity"); f >= 0) wet_velocity_ = {ledger.structure.window, number(f)};
  for (std::uint32_t w = 0; w < control_.n_windows && !structure_energy_; ++w) {
    const auto& record = control_.windows[w];
    if (record.owner != shm::Owner::module || record.module != control_.windows[ledger.structure.window].module)
      continue;
    const auto& view = session_->windows().view(w);
    const int f = view.find_field(0, "energy");
    if (f >= 0 && view.fields()[f].location == MULLION_PANE) structure_energy_ = {w, number(f)};
  }
}

void Recorder::watch_interface(const TimeStep& step)
{
  if (!session_->ledger() || !wet_velocity_) return;
  const auto ledger = session_->read(session_->ledger()->state, 1);
  const auto velocity = session_->read(*wet_velocity_, 1);
  InterfaceSeries::Sample sample;
  sample.time = step.end;
  for (Eigen::Index c = 0; c < std::min<Eigen::Index>(velocity.rows(), InterfaceSeries::n_velocities); ++c) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < velocity.cols(); ++i) sum += velocity(c, i);
    sample.velocity[c] = sum / static_cast<double>(velocity.cols());
  }
  sample.defect = ledger(0, 2);
  if (structure_energy_) sample.structure_energy = session_->read(*structure_energy_, 1)(0, 0);
  interface_.add(sample);
  work_structure_ = ledger(0, 1);
  energy_scale_ = std::max(energy_scale_, sample.structure_energy + std::abs(work_structure_));

  // Looked at seldom enough to cost nothing: after 2000, 4000, 8000, … steps.
  const bool is_due =
      step.index >= 2000 && step.index % 2000 == 0 && ((step.index / 2000) & (step.index / 2000 - 1)) == 0;
  if (!is_due || has_warned_) return;
  if (const auto made = find_manufactured_energy(interface_)) {
    log::warning(
        "run",
        "step {}: the scheme manufactures energy at the interface: the oscillation at {:.6g} Hz grows at {:.3g} "
        "1/s, and the work defect alone explains {:.3g} 1/s; less lag or a smaller step helps",
        step.index, made->frequency, made->growth, made->explained);
    has_warned_ = true;
  }
}

void Recorder::summarise_interface()
{
  if (session_ == nullptr || !session_->ledger() || !wet_velocity_ || interface_.samples().size() < 2) return;
  InterfaceSummary summary;
  summary.work_structure = work_structure_;
  summary.defect = interface_.samples().back().defect;
  summary.scale = energy_scale_;
  summary.motion = fit_motion(interface_.samples());
  summary.made = find_manufactured_energy(interface_);
  if (const auto lag = session_->wiring().net_lag) summary.lag = *lag * case_.dt;
  const auto structure = case_.interfaces[0].structure;
  summary.vacuum_frequency = session_->ask(structure.substr(0, structure.find('.')), "vacuum_frequency", case_.dt);
  interface_summary_ = summary;
}

double Recorder::measure(const Column& column) const
{
  const auto values = session_->read(column.at, 1);
  if (column.statistic == Statistic::value) return values(column.component, column.entity);
  double sum = 0.0, largest = 0.0; // in the order of the entities: the same bits wherever this runs
  for (Eigen::Index i = 0; i < values.cols(); ++i) {
    sum += values(column.component, i);
    largest = std::max(largest, std::abs(values(column.component, i)));
  }
  if (column.statistic == Statistic::largest) return largest;
  const double n = static_cast<double>(values.cols()), mean = sum / n;
  if (column.statistic == Statistic::mean) return mean;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < values.cols(); ++i) {
    const double difference = values(column.component, i) - mean;
    squares += difference * difference;
  }
  return std::sqrt(squares / n);
}

void Recorder::record(const TimeStep& step)
{
  const bool is_output = results_ != nullptr && step.index % case_.output_every == 0;
  watch_interface(step);
  const bool is_row = history_ != nullptr && step.index % case_.history_every == 0;
  if (!is_row && series_.empty() && !is_output) return;
  const auto begin = Clock::now();
  if (is_row) {
    for (std::size_t c = 0; c < columns_.size(); ++c) row_[c] = measure(columns_[c]);
    history_->row(step.index, step.end, row_);
  }
  for (std::size_t s = 0; s < series_.size(); ++s) {
    series_[s].times.push_back(step.end);
    series_[s].values.push_back(measure(columns_[series_columns_[s]]));
  }
  if (is_output) results_->write(step.index, step.end, snapshot());
  output_ns_ += nanoseconds_since(begin);
}

// ---- result files ------------------------------------------------------------------------------------------------

std::vector<io::WindowData> Recorder::snapshot() const
{
  std::vector<io::WindowData> out;
  for (std::uint32_t w = 0; w < control_.n_windows; ++w) {
    if (control_.windows[w].owner != shm::Owner::module) continue;
    const auto& view = session_->windows().view(w);
    auto& window = out.emplace_back();
    window.name = control_.windows[w].name;
    for (std::uint32_t p = 0; p < view.header().n_panes; ++p) {
      auto& pane = window.panes.emplace_back();
      const auto raw = view.pane(p, pane.blocks);
      pane.id = raw.id;
      pane.dimension = raw.dimension;
      pane.n_nodes = raw.n_nodes;
      pane.n_elements = raw.n_elements;
      pane.reference_coordinates = raw.coordinates;
      const auto fields = view.fields();
      for (std::uint32_t f = 0; f < fields.size(); ++f) {
        if (fields[f].pane != p) continue;
        const auto* data = session_->windows().locate(w, f, 1, control_.epoch.load()).data;
        io::FieldData field;
        field.name = fields[f].name;
        field.unit = fields[f].unit;
        field.location = fields[f].location;
        field.components = fields[f].components;
        field.entities = fields[f].entities;
        if (fields[f].scalar == MULLION_I32) field.i32 = reinterpret_cast<const std::int32_t*>(data);
        else field.f64 = reinterpret_cast<const double*>(data);
        pane.fields.push_back(std::move(field));
      }
    }
  }
  return out;
}

// ---- the end -----------------------------------------------------------------------------------------------------

void Recorder::collect_timings()
{
  constexpr double ns = 1e-9;
  auto& attempt = record_.attempts.back();
  for (std::uint32_t m = 0; m < case_.modules.size(); ++m)
    for (const auto& timing : session_->timings(m)) {
      if (timing.count == 0) continue;
      attempt.timings.push_back({case_.modules[m].instance, timing.call, timing.count,
                                 static_cast<double>(timing.wall_ns) * ns, static_cast<double>(timing.work_ns) * ns,
                                 static_cast<double>(timing.wall_ns - timing.work_ns) * ns});
    }
  attempt.timings.push_back({"mullion", "output", control_.step + 1, static_cast<double>(output_ns_) * ns,
                             static_cast<double>(output_ns_) * ns, 0.0});
  double calls = 0.0;
  for (const auto& timing : attempt.timings)
    if (timing.call != attach_call) calls += timing.wall_s;
  // What is left: the driver's own arithmetic, commits, audits. (In a run of very few steps the calls of the start-up,
  // which are counted too, may be longer than all steps.)
  const double rest = std::max(0.0, attempt.wall_s - calls);
  attempt.timings.push_back({"mullion", "driver and commit", control_.step, rest, rest, 0.0});
}

void Recorder::note(const std::string& what, const std::string& instance, const std::string& detail)
{
  record_.attempts.back().events.push_back({control_.step, what, instance, detail});
  // On disk at once, in case the run is killed; but a run that is steered all the time does not write all the time.
  if (Clock::now() - noted_ < std::chrono::seconds(1)) return;
  io::write_run_record(out_ / "run.json", record_);
  noted_ = Clock::now();
}

void Recorder::finish(const std::string& outcome, const std::string& error) noexcept
{
  auto& attempt = record_.attempts.back();
  attempt.outcome = record_.outcome = outcome;
  attempt.error = error;
  attempt.steps = control_.step;
  attempt.simulated_time = control_.step == 0 ? case_.start_time : control_.time.load();
  attempt.wall_s = static_cast<double>(nanoseconds_since(begun_)) * 1e-9;
  const auto attempt_to = [&](const char* what, auto&& action) {
    try {
      action();
    } catch (const std::exception& problem) {
      log::error("run", "{}: {}", what, problem.what());
    }
  };
  if (session_ != nullptr) collect_timings();
  if (history_ != nullptr) attempt_to("history.csv", [&] { history_->close(); });
  if (results_ != nullptr) attempt_to("results", [&] { results_->finish(); });
  attempt_to("run.json", [&] { io::write_run_record(out_ / "run.json", record_); });
  session_ = nullptr;
}

} // namespace mullion::run
