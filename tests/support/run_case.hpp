// Run cases as a user would, each test in a temporary folder of its own (results and runtime folder: tests can run at
// the same time), and look at what a run leaves behind: files, processes, shared memory.
#pragma once

#include "support/run_process.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace mullion::test {

/// One `mullion run`.
struct CaseRun {
  std::string file;                                            ///< the case
  std::vector<std::string> sets{};                             ///< "fluid.cells=20"
  std::vector<std::string> flags{};                            ///< "--inline"
  std::string out = "out";                                     ///< results folder, within the test's folder
  std::chrono::milliseconds timeout = std::chrono::minutes(4); ///< against hanging; sanitizers are slow
};

/// A process of a run, found by the runtime folder in its environment: whoever started it, whoever its parent is now.
struct RunProcess {
  pid_t pid = 0, parent = 0;
  char state = '?'; ///< as in ps: R, S, T, …
  std::vector<std::string> command;

  [[nodiscard]] bool is_host() const;
  /// Of a host: the number of its module (0 fluid, 1 structure, 2 mesh_motion, 3 transfer).
  [[nodiscard]] int module() const;
};

class RunFolder {
public:
  RunFolder();
  ~RunFolder(); ///< kills what is left, removes the folder
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] std::filesystem::path runtime() const { return path_ / "rt"; }

  /// `mullion run`, to its end or under way.
  [[nodiscard]] ProcessResult run(const CaseRun& run) const;
  [[nodiscard]] std::unique_ptr<Process> start(const CaseRun& run) const;
  /// Another command: {"stop", "closed-piston"}.
  [[nodiscard]] ProcessResult command(const std::vector<std::string>& arguments) const;
  [[nodiscard]] std::unique_ptr<Process> start_command(const std::vector<std::string>& arguments) const;

  /// The live processes of all runs of this folder; what is dead and not yet reaped does not count.
  [[nodiscard]] std::vector<RunProcess> processes() const;
  /// Wait until that list is empty. @return is it?
  [[nodiscard]] bool is_deserted_within(std::chrono::milliseconds patience) const;
  /// Files that appeared in /dev/shm since this folder was made.
  [[nodiscard]] std::vector<std::string> new_shared_memory() const;

  /// Steps that a live run has done, by its own answer; -1: it is not there (yet, or any more).
  [[nodiscard]] long long steps_of(const std::string& run_name) const;
  /// Wait until the live run has done this step. @return has it?
  [[nodiscard]] bool wait_for_step(const std::string& run_name, long long step) const;

private:
  [[nodiscard]] ProcessOptions options(std::chrono::milliseconds timeout) const;
  std::filesystem::path path_;
  std::set<std::string> shared_memory_before_;
};

/// Ask every millisecond, until it is true or the patience is at its end. @return is it true?
bool wait_until(const std::function<bool()>& is_true, std::chrono::milliseconds patience = std::chrono::seconds(20));

/// The whole file; "" if there is none.
std::string read_file(const std::filesystem::path& file);
/// run.json of a results folder.
nlohmann::json read_record(const std::filesystem::path& results);

/// What differs, byte for byte, between two results folders: history.csv and all result files. "": nothing.
std::string difference(const std::filesystem::path& results, const std::filesystem::path& expected);
/// The same for a run that ended early: its history.csv must be the first lines of the whole run's, each of its
/// result files one of the whole run's.
std::string difference_of_part(const std::filesystem::path& part, const std::filesystem::path& whole);
/// The last step in a history.csv; -1: there is none.
long long last_step(const std::filesystem::path& results);

} // namespace mullion::test
