// What a run leaves behind: history.csv, the result files, checkpoints, run.json, case.toml. Reads committed levels
// only.
#pragma once

#include "io/checkpoint_writer.hpp"
#include "io/history_writer.hpp"
#include "io/results_writer.hpp"
#include "io/run_record.hpp"
#include "run/interface_report.hpp"
#include "run/restart.hpp"
#include "run/session.hpp"
#include "run/step_clock.hpp"
#include "run/timings.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace mullion::run {

/// A column of history.csv that the summary looks at again.
struct Series {
  std::string quantity;
  std::vector<double> times, values;
};

class Recorder {
public:
  /// Makes the folder, writes case.toml and run.json ("running"): a new record, or, in a restart, one more attempt.
  /// @param restart  null: a new run
  Recorder(const Case& the_case, std::filesystem::path out, shm::Control& control, const Restart* restart);

  /// The windows exist: history and result files start, with the initial state; in a restart they are cut back to the
  /// checkpoint's step and go on from there.
  /// @param clock  where the run stands, from here on
  void begin(Session& session, const StepClock& clock);
  /// After a commit. With on_divergence = "halve_dt" every step has its row, but result files, checkpoints and, where
  /// not every step has one, rows come at whole steps of the plan.
  void record(const TimeStep& step);

  /// Between two steps: write a checkpoint of the last commit, besides those that the case asks for.
  /// @param done  called when it is on disk, from the writer's thread, or here if it is there already, with the step
  /// and
  ///              "", or with why it was not written
  using CheckpointDone = io::CheckpointWriter::Report;
  void write_checkpoint(CheckpointDone done = {});
  /// The last commit shall be on disk: the run ends before its end. Never throws: a failure is logged.
  void save_last_commit() noexcept;

  /// What happened to a module or the driver in a step, for run.json: "respawn", "swap", "set", …
  void note(std::int64_t step, const std::string& what, const std::string& instance, const std::string& detail);

  /// Close all files, complete run.json. Never throws: a failure is logged.
  void finish(const std::string& outcome, const std::string& error) noexcept;

  [[nodiscard]] const Case& the_case() const { return case_; }
  [[nodiscard]] const std::filesystem::path& out() const { return out_; }
  [[nodiscard]] const io::Attempt& attempt() const { return record_.attempts.back(); }
  [[nodiscard]] const std::vector<Series>& series() const { return series_; }

  /// What the summary says about the interface; nothing without a ledger.
  struct InterfaceSummary {
    double work_structure = 0.0, defect = 0.0, scale = 0.0; ///< [J] so far; scale: largest energy that was at play
    InterfaceMotion motion;
    std::optional<double> lag;              ///< net, of the scheme [s]
    std::optional<double> vacuum_frequency; ///< [Hz]
    std::optional<ManufacturedEnergy> made;
  };
  [[nodiscard]] const std::optional<InterfaceSummary>& interface_summary() const { return interface_summary_; }
  /// While the modules still answer: the interface's part of the summary.
  void summarise_interface();
  /// While the modules still answer: the numbers that [output] functions asks for, for run.json and the summary.
  void ask_functions();

private:
  enum class Statistic { value, mean, largest, deviation };
  struct Column {
    std::string name;
    FieldAddress at;
    int component;
    Statistic statistic;
    Eigen::Index entity = 0; ///< of a value
  };

  void choose_columns();
  void choose_driver_columns();
  void watch_interface(const TimeStep& step);
  void add_sample(const InterfaceSeries::Sample& sample, double work_structure);
  [[nodiscard]] std::string unit_of(const Column& column) const; ///< SI, as in the field's declaration
  [[nodiscard]] double measure(const Column& column) const;
  [[nodiscard]] std::vector<io::WindowData> snapshot(shm::Storage storage) const;
  void write_row(const TimeStep& step);
  [[nodiscard]] bool is_row_due() const;
  [[nodiscard]] bool is_output_due() const;
  void go_on();          ///< in a restart: fill in what the files lack of the checkpoint's step
  void recall_history(); ///< in a restart: what the summary looks at, from the rows that were kept
  void collect_timings();

  const Case& case_;
  std::filesystem::path out_;
  shm::Control& control_;
  const Restart* restart_;
  Session* session_ = nullptr;
  const StepClock* clock_ = nullptr;
  bool has_begun_ = false;
  io::RunRecord record_;
  std::vector<Column> columns_;
  std::vector<double> row_;
  std::vector<Series> series_;
  std::vector<std::size_t> series_columns_;
  InterfaceSeries interface_;
  std::optional<FieldAddress> wet_velocity_, structure_energy_;
  double work_structure_ = 0.0, energy_scale_ = 0.0; ///< [J] so far
  bool has_warned_ = false;
  std::optional<InterfaceSummary> interface_summary_;
  std::unique_ptr<io::HistoryWriter> history_;
  std::unique_ptr<io::ResultsWriter> results_;
  std::map<std::string, std::string> checksums_; ///< of plug-in libraries
  std::int64_t checkpoint_step_ = -1;            ///< of the last one that was handed over
  io::CheckpointWriter checkpoints_;             ///< after what its thread waits for
  Clock::time_point begun_, noted_{};
  std::int64_t output_ns_ = 0; ///< spent in record(), checkpoints aside
  std::int64_t n_checkpoints_ = 0, checkpoint_ns_ = 0;
};

} // namespace mullion::run
