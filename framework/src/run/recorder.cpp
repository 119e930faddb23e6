#include "run/recorder.hpp"

#include "io/atomic_file.hpp"
#include "io/checkpoint_files.hpp"
#include "log/console.hpp"
#include "report/csv_table.hpp"
#include "run/checkpoint.hpp"
#include "run/snapshot.hpp"

#include <mullion/coupling/build_id.hpp>
#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <array>
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

Recorder::Recorder(const Case& the_case, std::filesystem::path out, shm::Control& control, const Restart* restart)
    : case_(the_case), out_(std::move(out)), control_(control), restart_(restart),
      checkpoints_(out_, case_.keep_checkpoints,
                   [](std::int64_t step, const std::string& problem) {
                     if (problem.empty()) log::debug("run", "checkpoint of step {} is on disk", step);
                     else
                       log::warning("run", "no checkpoint of step {}: {}; the run goes on, older checkpoints are whole",
                                    step, problem);
                   }),
      begun_(Clock::now())
{
  io::make_folder(out_);
  const auto record_path = out_ / "run.json";
  if (restart_ == nullptr) {
    remove_old_results(out_);
  } else {
    io::remove_stale_temporaries(out_);
    if (auto before = io::read_run_record(record_path)) record_ = std::move(*before);
    for (auto& attempt : record_.attempts)
      if (attempt.outcome == "running") attempt.outcome = "died"; // and its guard with it
  }
  io::write_atomically(out_ / "case.toml", case_.text);
  record_.name = case_.name;
  record_.outcome = "running";
  record_.columns.clear();
  auto& attempt = record_.attempts.emplace_back();
  attempt.versions = {{"mullion", MULLION_VERSION}, {"build", MULLION_BUILD_ID}};
  attempt.start = io::utc_now();
  attempt.driver = case_.scheme;
  for (const auto& module : case_.modules)
    attempt.modules.push_back({module.instance, module.kind, module.plugin, module.version, module.is_process});
  if (restart_ != nullptr) {
    attempt.restarted_from = restart_->file.string();
    attempt.first_step = restart_->checkpoint.clock.step;
  }
  const auto record_file = std::filesystem::absolute(record_path).string();
  io::write_run_record(record_file, record_);
  shm::copy_text(control_.outcome_file, sizeof control_.outcome_file, record_file, "path of run.json");
}

void Recorder::begin(Session& session, const StepClock& clock)
{
  session_ = &session;
  clock_ = &clock;
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
  // The checkpoints of another future, or of another run, would be taken for this one's.
  io::remove_checkpoints_after(out_, restart_ != nullptr ? clock.step() : -1);
  if (case_.has_history) {
    std::vector<std::string> names;
    for (const auto& column : columns_) names.push_back(column.name);
    const auto kept = restart_ != nullptr ? std::optional(clock.step()) : std::nullopt;
    history_ = std::make_unique<io::HistoryWriter>(out_ / "history.csv", names, kept);
    record_.attempts.back().files.emplace_back("history.csv");
  }
  if (case_.output_every > 0) {
    results_ = std::make_unique<io::ResultsWriter>(out_, case_.name);
    if (restart_ != nullptr) results_->go_on_from(restart_->checkpoint.outputs);
    results_->begin(snapshot(shm::Storage::fixed));
    for (const char* file : {"results.xdmf", "results.h5", "results/"})
      record_.attempts.back().files.emplace_back(file);
  }
  if (restart_ == nullptr) record({0, case_.start_time, case_.start_time, case_.dt, 0});
  else go_on();
  has_begun_ = true;
  begun_ = Clock::now(); // wall time per step: without the start-up
  output_ns_ = 0;
}

void Recorder::go_on()
{
  checkpoint_step_ = clock_->step(); // it is there
  const TimeStep now{clock_->step(), clock_->time(), clock_->time(), case_.dt, 0};
  const auto kept = history_ != nullptr ? history_->last_kept() : -1;
  recall_history();
  if (history_ != nullptr && is_row_due() && kept < now.index) {
    if (0 <= kept && kept + case_.history_every < now.index)
      log::warning("run", "history.csv has no rows between step {} and step {}", kept, now.index);
    write_row(now);
  }
  if (results_ != nullptr && is_output_due() && !results_->has_output(now.index))
    results_->write(now.index, now.end, snapshot(shm::Storage::level));
}

void Recorder::recall_history()
{
  if (history_ == nullptr || history_->last_kept() < 0 || case_.history_every != 1) return;
  const auto table = report::read_csv(out_ / "history.csv", report::LastLine::whole);
  std::vector<const std::vector<double>*> values; // of the columns
  for (const auto& column : columns_) {
    const auto* found = table.find(column.name);
    MULLION_REQUIRE(found != nullptr && !found->is_text(), Errc::io, "{}: its column {} is gone or holds texts",
                    (out_ / "history.csv").string(), column.name);
    values.push_back(&found->numbers);
  }
  const auto& times = table.find("time")->numbers;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!clock_->is_whole(times[i])) continue;
    for (std::size_t s = 0; s < series_.size(); ++s) {
      series_[s].times.push_back(times[i]);
      series_[s].values.push_back((*values[series_columns_[s]])[i]);
    }
  }
  if (!session_->ledger() || !wet_velocity_) return;
  const auto column_of = [&](FieldAddress at, int component, Eigen::Index entity) -> const std::vector<double>* {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (columns_[c].at.window == at.window && columns_[c].at.field == at.field &&
          columns_[c].component == component && columns_[c].entity == entity &&
          columns_[c].statistic != Statistic::largest)
        return values[c];
    return nullptr;
  };
  const std::vector<double>* velocity[InterfaceSeries::n_velocities];
  for (int c = 0; c < InterfaceSeries::n_velocities; ++c) velocity[c] = column_of(*wet_velocity_, c, 0);
  const auto* work = column_of(session_->ledger()->state, 0, 1);
  const auto* defect = column_of(session_->ledger()->state, 0, 2);
  const auto* energy = structure_energy_ ? column_of(*structure_energy_, 0, 0) : nullptr;
  if (work == nullptr || defect == nullptr) return;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!clock_->is_whole(times[i])) continue;
    InterfaceSeries::Sample sample;
    sample.time = times[i];
    for (int c = 0; c < InterfaceSeries::n_velocities; ++c)
      if (velocity[c] != nullptr) sample.velocity[c] = (*velocity[c])[i];
    sample.defect = (*defect)[i];
    if (energy != nullptr) sample.structure_energy = (*energy)[i];
    add_sample(sample, (*work)[i]);
  }
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
  add_sample(sample, ledger(0, 1));

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

void Recorder::add_sample(const InterfaceSeries::Sample& sample, double work_structure)
{
  interface_.add(sample);
  work_structure_ = work_structure;
  energy_scale_ = std::max(energy_scale_, sample.structure_energy + std::abs(work_structure_));
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
  summary.vacuum_frequency =
      session_->ask(structure.substr(0, structure.find('.')), "vacuum_frequency", std::array{case_.dt});
  interface_summary_ = summary;
}

void Recorder::ask_functions()
{
  auto& answers = record_.attempts.back().functions;
  answers.clear(); // a module may have died under the first question
  for (const auto& call : case_.functions)
    answers.emplace_back(call.text, session_->ask(call.instance, call.function, call.arguments).value());
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

bool Recorder::is_row_due() const
{
  return case_.history_every == 1 || (clock_->is_on_grid() && clock_->grid() % case_.history_every == 0);
}

bool Recorder::is_output_due() const
{
  return case_.output_every > 0 && clock_->is_on_grid() && clock_->grid() % case_.output_every == 0;
}

void Recorder::write_row(const TimeStep& step)
{
  for (std::size_t c = 0; c < columns_.size(); ++c) row_[c] = measure(columns_[c]);
  history_->row(step.index, step.end, row_);
}

void Recorder::record(const TimeStep& step)
{
  const bool is_output = is_output_due();
  const bool is_whole = clock_->is_on_grid(); // what the summary looks at has equal steps
  if (is_whole) watch_interface(step);
  const bool is_row = history_ != nullptr && is_row_due();
  if (is_row || !series_.empty() || is_output) {
    const auto begin = Clock::now();
    if (is_row) write_row(step);
    for (std::size_t s = 0; s < series_.size() && is_whole; ++s) {
      series_[s].times.push_back(step.end);
      series_[s].values.push_back(measure(columns_[series_columns_[s]]));
    }
    if (is_output) results_->write(step.index, step.end, snapshot(shm::Storage::level));
    output_ns_ += nanoseconds_since(begin);
  }
  const bool is_due = case_.checkpoint_every > 0 && step.index > 0 && clock_->is_on_grid() &&
                      clock_->grid() % case_.checkpoint_every == 0;
  if (is_due) write_checkpoint();
}

// ---- checkpoints -------------------------------------------------------------------------------------------------

void Recorder::write_checkpoint(CheckpointDone done)
{
  const auto step = clock_->step();
  if (checkpoint_step_ == step) { // by the case's own wish, or the run went on from it
    if (!done) return;
    checkpoints_.wait();
    const bool is_there = checkpoints_.last_step() == step || (restart_ != nullptr && n_checkpoints_ == 0);
    return done(step, is_there ? "" : "it could not be written; the log says why");
  }
  const auto begin = Clock::now();
  auto checkpoint = checkpoint_of(*session_, *clock_);
  checkpoint.plugins = plugins_of(case_, checksums_);
  if (results_ != nullptr) checkpoint.outputs = results_->outputs();
  if (history_ != nullptr) history_->flush();
  const auto wait_for_files = [history = history_.get(), results = results_.get()] {
    if (history != nullptr) history->sync();
    MULLION_REQUIRE(results == nullptr || results->wait_for_outputs(), Errc::io,
                    "a result file before it could not be written");
  };
  checkpoints_.submit(step, io::to_image(checkpoint), wait_for_files, std::move(done));
  checkpoint_step_ = step;
  ++n_checkpoints_;
  checkpoint_ns_ += nanoseconds_since(begin);
}

void Recorder::save_last_commit() noexcept
{
  if (session_ == nullptr || !has_begun_) return; // the start-up never ended
  try {
    if (results_ != nullptr) results_->flush(); // what cannot be written leaves the list of outputs
  } catch (const std::exception& problem) {
    log::error("run", "results: {}", problem.what());
  }
  try {
    write_checkpoint();
    checkpoints_.wait();
    if (const auto step = clock_->step(); checkpoints_.last_step() == step)
      log::info("run", "the state after step {} is in {}; go on with --restart", step,
                (out_ / io::checkpoint_name(step)).string());
  } catch (const std::exception& problem) {
    log::error("run", "no checkpoint of step {}: {}", clock_->step(), problem.what());
  }
}

void Recorder::note(std::int64_t step, const std::string& what, const std::string& instance, const std::string& detail)
{
  record_.attempts.back().events.push_back({step, what, instance, detail});
  // On disk at once, in case the run is killed; but a run that is steered all the time does not write all the time.
  if (Clock::now() - noted_ < std::chrono::seconds(1)) return;
  io::write_run_record(out_ / "run.json", record_);
  noted_ = Clock::now();
}

// ---- result files ------------------------------------------------------------------------------------------------

std::vector<io::WindowData> Recorder::snapshot(shm::Storage storage) const { return snapshot_of(*session_, storage); }

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
  const auto n_steps = control_.step - attempt.first_step;
  const auto add = [&](const char* call, std::int64_t count, double seconds) {
    attempt.timings.push_back({"mullion", call, count, seconds, seconds, 0.0});
  };
  add("output", n_steps + 1, static_cast<double>(output_ns_) * ns);
  if (n_checkpoints_ > 0) add("checkpoint", n_checkpoints_, static_cast<double>(checkpoint_ns_) * ns);
  double calls = 0.0;
  for (const auto& timing : attempt.timings)
    if (timing.call != attach_call) calls += timing.wall_s;
  // What is left: the driver's own arithmetic, commits, audits. (In a run of very few steps the calls of the start-up,
  // which are counted too, may be longer than all steps.)
  add("driver and commit", n_steps, std::max(0.0, attempt.wall_s - calls));
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
  checkpoints_.wait(); // its thread may wait for the two below
  attempt_to("checkpoints", [&] {
    for (const auto& file : io::list_checkpoints(out_)) attempt.files.push_back(file.path.filename().string());
  });
  if (history_ != nullptr) attempt_to("history.csv", [&] { history_->close(); });
  if (results_ != nullptr) attempt_to("results", [&] { results_->finish(); });
  attempt_to("run.json", [&] { io::write_run_record(out_ / "run.json", record_); });
  session_ = nullptr;
}

} // namespace mullion::run
