// What a run leaves behind: history.csv, the result files, run.json, case.toml. Reads committed levels only.
#pragma once

#include "io/history_writer.hpp"
#include "io/results_writer.hpp"
#include "io/run_record.hpp"
#include "run/interface_report.hpp"
#include "run/session.hpp"
#include "run/timings.hpp"

#include <filesystem>
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
  /// Makes the folder, writes case.toml and run.json ("running").
  Recorder(const Case& the_case, std::filesystem::path out, shm::Control& control);

  /// The windows exist: history and result files start, with the initial state.
  void begin(Session& session);
  /// After a commit.
  void record(const TimeStep& step);
  /// What happened to a module or the driver on the way, for run.json: "swap", "set", …
  void note(const std::string& what, const std::string& instance, const std::string& detail);
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
  [[nodiscard]] std::string unit_of(const Column& column) const; ///< SI, as in the field's declaration
  [[nodiscard]] double measure(const Column& column) const;
  [[nodiscard]] std::vector<io::WindowData> snapshot() const;
  void collect_timings();

  const Case& case_;
  std::filesystem::path out_;
  shm::Control& control_;
  Session* session_ = nullptr;
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
  Clock::time_point begun_, noted_{};
  std::int64_t output_ns_ = 0; ///< spent in record()
};

} // namespace mullion::run
