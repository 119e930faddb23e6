// run.json: what a run was and how it went, one entry per attempt (a restart in the same folder appends one). Written
// at the start with outcome "running" and replaced at the end; if the process died in between, the guard closes the
// record. Replaced atomically, so a reader sees a whole record at any time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace mullion::io {

/// Where one module of the run lived.
struct PlacedModule {
  std::string instance, kind, module, version;
  bool is_process = false;
};

/// All calls of one kind to one instance. Seconds of wall time; work is the module's own, wait the caller's.
struct Timing {
  std::string who, call;
  std::int64_t count = 0;
  double wall_s = 0.0, work_s = 0.0, wait_s = 0.0;
};

/// What happened to a module on the way: "swap", "respawn".
struct Event {
  std::int64_t step = 0;
  std::string what, instance, detail;
};

struct Attempt {
  std::vector<std::pair<std::string, std::string>> versions; ///< component and version, in the order of writing
  std::string start;                                         ///< UTC, "2024-05-01T12:00:00Z"
  std::vector<PlacedModule> modules;
  std::string driver;
  std::string restarted_from; ///< the checkpoint's file; empty: from the initial state
  std::int64_t first_step = 0, steps = 0;
  double simulated_time = 0.0; ///< [s] at the end
  double wall_s = 0.0;
  std::vector<std::pair<std::string, double>> functions; ///< what modules were asked for at the end, and the answers
  std::vector<Timing> timings;
  std::vector<Event> events;
  std::vector<std::string> files; ///< relative to the run's folder
  std::string outcome = "running";
  std::string error;
};

struct RunRecord {
  std::string name;
  std::string outcome = "running"; ///< "running", "completed", "stopped", "failed", ...: the last attempt's
  std::vector<std::pair<std::string, std::string>> columns; ///< of history.csv: name and SI unit, in their order
  std::vector<Attempt> attempts;
};

/// The record in the file, or none if there is no such file.
/// @throws Error Errc::io: unreadable, or not a record
[[nodiscard]] std::optional<RunRecord> read_run_record(const std::filesystem::path& path);

/// Numbers that JSON has no text for (NaN, infinities) become null, texts that are not UTF-8 are mended.
/// @throws Error Errc::io
void write_run_record(const std::filesystem::path& path, const RunRecord& record);

/// For the guard, after the orchestrator died: a record that still says "running" gets this outcome and message,
/// in its last attempt too. A finished record stays as it is; a missing one is made, as far as is known.
/// @throws Error Errc::io: the file is not a record, or cannot be replaced
void complete_after_crash(const std::string& path, const std::string& outcome, const std::string& message);

/// Now, as Attempt::start wants it.
[[nodiscard]] std::string utc_now();

} // namespace mullion::io
