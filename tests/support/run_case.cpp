#include "support/run_case.hpp"

#include "process/run_socket.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <unistd.h>

namespace mullion::test {

namespace fs = std::filesystem;

namespace {

constexpr const char* runtime_variable = "MULLION_RUNTIME_DIR";
constexpr const char* memory_folder = "/dev/shm";
constexpr const char* folder_name = "mullion-run-"; // unit tests' scratch folders start with it too

std::set<std::string> shared_memory()
{
  std::set<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(memory_folder, ignored)) {
    const auto name = entry.path().filename().string();
    if (!name.starts_with(folder_name)) names.insert(name); // not the folders of other tests
  }
  return names;
}

/// A file of /proc whose entries end with a zero.
std::vector<std::string> read_list(const fs::path& file)
{
  std::vector<std::string> entries;
  std::istringstream text(read_file(file));
  for (std::string entry; std::getline(text, entry, '\0');) entries.push_back(entry);
  return entries;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The result files of a run with their contents: what must not depend on how and under which name it ran.
std::map<std::string, std::string> result_files(const fs::path& results)
{
  std::map<std::string, std::string> files;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(results, ignored)) {
    const auto name = fs::relative(entry.path(), results).string();
    const bool is_about_the_run =
        name == "case.toml" || name == "run.json" || name == "post-mortem.txt" || name.starts_with("checkpoint-");
    const bool is_unfinished = has(name, ".tmp-"); // the name of a file that is being written; a killed run leaves one
    if (entry.is_regular_file() && !is_about_the_run && !is_unfinished) files[name] = read_file(entry.path());
  }
  return files;
}

/// What the sanitizers must leave to the program under test: it dies of the signal, and the run has to tell.
std::string quiet(const char* variable)
{
  const char* own = std::getenv(variable);
  return std::string(own != nullptr ? own : "") +
         ":handle_segv=0:handle_sigbus=0:handle_abort=0:handle_sigill=0:handle_sigfpe=0:detect_leaks=0";
}

} // namespace

bool RunProcess::is_host() const { return !command.empty() && fs::path(command[0]).filename() == "mullion-host"; }
int RunProcess::module() const { return std::stoi(command.at(4)); }

RunFolder::RunFolder() : shared_memory_before_(shared_memory())
{
  // In memory where there is some: a busy disk holds up the end of a run, and tests look at how long that takes.
  // A short path: that of a socket has 107 characters.
  const auto is_in_memory = ::access(memory_folder, W_OK) == 0 && fs::space(memory_folder).available > 64u << 20;
  std::string pattern = std::string(is_in_memory ? memory_folder : "/tmp") + "/" + folder_name + "XXXXXX";
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder " + pattern);
  path_ = pattern;
}

RunFolder::~RunFolder()
{
  for (const auto& process : processes()) ::kill(process.pid, SIGKILL);
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

ProcessOptions RunFolder::options(std::chrono::milliseconds timeout) const
{
  return {.environment = {{runtime_variable, runtime().string()},
                          {"MULLION_PLUGIN_PATH", MULLION_TEST_PLUGIN_DIR},
                          {"ASAN_OPTIONS", quiet("ASAN_OPTIONS")},
                          {"TSAN_OPTIONS", quiet("TSAN_OPTIONS")}},
          .folder = path_.string(),
          .timeout = timeout};
}

std::unique_ptr<Process> RunFolder::start(const CaseRun& run) const
{
  std::vector<std::string> command = {MULLION_BUILD_DIR "/bin/mullion", "run", run.file, "--out", run.out};
  for (const auto& set : run.sets) command.insert(command.end(), {"--set", set});
  command.insert(command.end(), run.flags.begin(), run.flags.end());
  return std::make_unique<Process>(command, options(run.timeout));
}

ProcessResult RunFolder::run(const CaseRun& run) const { return start(run)->wait(); }

std::unique_ptr<Process> RunFolder::start_command(const std::vector<std::string>& arguments) const
{
  std::vector<std::string> command = {MULLION_BUILD_DIR "/bin/mullion"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return std::make_unique<Process>(command, options(std::chrono::minutes(4)));
}

ProcessResult RunFolder::command(const std::vector<std::string>& arguments) const
{
  return start_command(arguments)->wait();
}

std::vector<RunProcess> RunFolder::processes() const
{
  const auto mark = std::string(runtime_variable) + "=" + runtime().string();
  std::vector<RunProcess> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/proc", ignored)) {
    const auto name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    RunProcess process;
    process.pid = std::stoi(name);
    if (process.pid == ::getpid()) continue;
    const auto environment = read_list(entry.path() / "environ"); // none once it is a zombie
    if (std::find(environment.begin(), environment.end(), mark) == environment.end()) continue;
    const auto stat = read_file(entry.path() / "stat"); // pid (name) state parent …
    const auto after_name = stat.rfind(')');
    if (after_name == std::string::npos) continue;
    std::istringstream(stat.substr(after_name + 1)) >> process.state >> process.parent;
    if (process.state == 'Z' || process.state == 'X') continue;
    process.command = read_list(entry.path() / "cmdline");
    found.push_back(std::move(process));
  }
  return found;
}

bool RunFolder::is_deserted_within(std::chrono::milliseconds patience) const
{
  return wait_until([&] { return processes().empty(); }, patience);
}

std::vector<std::string> RunFolder::new_shared_memory() const
{
  const auto now = shared_memory();
  std::vector<std::string> added;
  std::set_difference(now.begin(), now.end(), shared_memory_before_.begin(), shared_memory_before_.end(),
                      std::back_inserter(added));
  return added;
}

long long RunFolder::steps_of(const std::string& run_name) const
{
  if (!fs::exists(runtime() / (run_name + ".sock"))) return -1;
  ::setenv(runtime_variable, runtime().c_str(), 1); // where ask_run looks
  try {
    return nlohmann::json::parse(process::ask_run(run_name, "status")).at("step").get<long long>();
  } catch (const std::exception&) { // just gone, or not yet listening
    return -1;
  }
}

bool RunFolder::wait_for_step(const std::string& run_name, long long step) const
{
  return wait_until([&] { return steps_of(run_name) >= step; });
}

bool wait_until(const std::function<bool()>& is_true, std::chrono::milliseconds patience)
{
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;;) {
    if (is_true()) return true;
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::string read_file(const fs::path& file)
{
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf(); // unlike iterators this does not throw when a process whose /proc file it is ends meanwhile
  return text.str();
}

nlohmann::json read_record(const fs::path& results) { return nlohmann::json::parse(read_file(results / "run.json")); }

std::string difference(const fs::path& results, const fs::path& expected)
{
  const auto files = result_files(results), expected_files = result_files(expected);
  if (!expected_files.contains("history.csv")) return "there is no history.csv to compare with";
  for (const auto& [name, contents] : expected_files) {
    const auto found = files.find(name);
    if (found == files.end()) return name + " is missing";
    if (found->second == contents) continue;
    const auto [here, there] =
        std::mismatch(contents.begin(), contents.end(), found->second.begin(), found->second.end());
    return name + " differs at byte " + std::to_string(here - contents.begin());
  }
  for (const auto& file : files)
    if (!expected_files.contains(file.first)) return file.first + " should not be there";
  return "";
}

std::string difference_of_part(const fs::path& part, const fs::path& whole)
{
  const auto files = result_files(part), expected_files = result_files(whole);
  if (!files.contains("history.csv")) return "there is no history.csv";
  for (const auto& [name, contents] : files) {
    if (name == "results.h5" || name == "results.xdmf") continue; // lists of what there is
    const auto found = expected_files.find(name);
    if (found == expected_files.end()) return name + " should not be there";
    const bool is_history = name == "history.csv";
    if (is_history ? !found->second.starts_with(contents) : found->second != contents)
      return name + (is_history ? " is no part of" : " differs from") + " the undisturbed run's";
    if (is_history && !contents.ends_with('\n')) return name + " ends within a line";
  }
  return "";
}

long long last_step(const fs::path& results)
{
  long long last = -1;
  std::istringstream text(read_file(results / "history.csv"));
  std::string line;
  std::getline(text, line); // the header
  while (std::getline(text, line)) last = std::stoll(line);
  return last;
}

} // namespace mullion::test
