#include "report/gnuplot.hpp"

#include "io/atomic_file.hpp"

#include <mullion/sdk/error.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace mullion::report {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
public:
  TemporaryFolder()
  {
    std::string pattern = (fs::temp_directory_path() / "mullion-report-XXXXXX").string();
    MULLION_REQUIRE(::mkdtemp(pattern.data()) != nullptr, Errc::io, "cannot make a temporary folder {}: {}", pattern,
                    std::generic_category().message(errno));
    path_ = pattern;
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] fs::path operator/(const std::string& name) const { return path_ / name; }

private:
  fs::path path_;
};

/// Without sync: nobody needs the file after this process.
void write(const fs::path& path, const std::string& text)
{
  std::ofstream file(path, std::ios::binary);
  file << text << std::flush;
  MULLION_REQUIRE(file.good(), Errc::io, "cannot write {}: is that disk full?", path.string());
}

/// gnuplot's SVG without hairs of the background between the polygons: each of their edges is smoothed by itself.
std::string with_crisp_polygons(std::string svg)
{
  const auto at = svg.find("<defs>");
  return at == std::string::npos ? svg : svg.insert(at, "<style>polygon { shape-rendering: crispEdges; }</style>\n");
}

/// Run gnuplot in the folder; what it says goes to a file there.
void run_gnuplot(const TemporaryFolder& folder)
{
  const auto log = (folder / "log.txt").string(), script = (folder / "plots.gp").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, (folder / "").c_str());
  // -d: without the user's own settings, so that a report looks the same everywhere
  std::string program = "gnuplot", defaults = "-d", file = script;
  char* const arguments[] = {program.data(), defaults.data(), file.data(), nullptr};
  pid_t pid = 0;
  const int code = ::posix_spawnp(&pid, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  MULLION_REQUIRE(code != ENOENT, Errc::process,
                  "a report is drawn by gnuplot, which is not on the PATH; install the package gnuplot-nox");
  MULLION_REQUIRE(code == 0, Errc::process, "cannot start gnuplot: {}", std::generic_category().message(code));
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0)
    MULLION_REQUIRE(errno == EINTR, Errc::process, "cannot wait for gnuplot: {}",
                    std::generic_category().message(errno));
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const auto how = WIFSIGNALED(status) ? fmt::format("was killed by signal {}", WTERMSIG(status))
                                       : fmt::format("failed with exit code {}", WEXITSTATUS(status));
  auto said = io::read_text(log);
  said.erase(0, said.find_first_not_of(" \n"));
  said.erase(said.find_last_not_of(" \n") + 1);
  throw Error(Errc::process, fmt::format("gnuplot {}: {}", how, said));
}

} // namespace

std::vector<Drawing> draw(const std::vector<Figure>& figures)
{
  if (figures.empty()) return {};
  const TemporaryFolder folder;
  std::string script;
  std::vector<std::string> names;
  for (const auto& figure : figures)
    std::visit(
        [&](const auto& f) {
          write(folder / (f.name + ".dat"), plot_data(f));
          script += plot_script(f);
          names.push_back(f.name);
        },
        figure);
  write(folder / "plots.gp", script);
  run_gnuplot(folder);
  std::vector<Drawing> drawings;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const auto file = folder / (names[i] + ".svg");
    auto svg = fs::exists(file) ? io::read_text(file) : std::string();
    if (std::holds_alternative<Picture>(figures[i])) svg = with_crisp_polygons(std::move(svg));
    drawings.push_back({std::move(svg), io::read_text(folder / (names[i] + ".png"))});
  }
  return drawings;
}

} // namespace mullion::report
