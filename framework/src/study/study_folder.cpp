#include "study/study_folder.hpp"

#include "io/atomic_file.hpp"
#include "process/run_socket.hpp"

#include <mullion/sdk/error.hpp>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <thread>
#include <unistd.h>

namespace mullion::study {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto patience_with_remains = std::chrono::seconds(10); ///< of a study that was killed: they die at once

} // namespace

shm::Descriptor lock_folder(const fs::path& folder)
{
  const auto path = folder / "study.lock";
  shm::Descriptor lock(::open(path.c_str(), O_RDWR | O_CREAT, 0666)); // not close-on-exec
  MULLION_REQUIRE(lock.is_open(), Errc::io, "cannot open {}: {}", path.string(), std::strerror(errno));
  const auto give_up = Clock::now() + patience_with_remains;
  while (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    const auto owner = io::read_text(path);
    const pid_t pid = static_cast<pid_t>(std::strtol(owner.c_str(), nullptr, 10));
    const bool is_alive = pid > 0 && (::kill(pid, 0) == 0 || errno != ESRCH);
    MULLION_REQUIRE(!is_alive && Clock::now() < give_up, Errc::config,
                    "a study is at work in {} (process {}); wait for it, or choose another folder with --out",
                    folder.string(), pid);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const auto own = fmt::format("{}\n", ::getpid());
  (void)!::ftruncate(lock.get(), 0);
  (void)!::pwrite(lock.get(), own.data(), own.size(), 0);
  return lock;
}

void check_folder(const fs::path& folder, const StudyFile& study)
{
  std::error_code none;
  const auto file = folder / "study.toml";
  MULLION_REQUIRE(!fs::exists(folder / "run.json", none), Errc::config,
                  "{} is the folder of a run; choose another one for the study with --out", folder.string());
  if (!fs::exists(file, none)) return;
  const auto there = parse_study(io::read_text(file), study.file); // its paths count from there
  const auto unreadable = there.diagnostics.sorted(file.string());
  MULLION_REQUIRE(unreadable.empty(), Errc::config, "{} is no study that can be gone on with: {}: {}", folder.string(),
                  unreadable.front().place, unreadable.front().message);
  const auto differences = difference(there.value, study);
  MULLION_REQUIRE(differences.empty(), Errc::config,
                  "{} has the runs of another study; choose another folder with --out, or remove that one. They "
                  "differ in{}",
                  folder.string(), differences);
}

void check_names(const StudyFile& study)
{
  for (const auto& name : process::live_runs()) {
    const auto begin = study.name + ".";
    if (!name.starts_with(begin) || name.find_first_not_of("0123456789", begin.size()) != std::string::npos) continue;
    throw Error(Errc::config, fmt::format("the run '{}' is alive, of another study of this name; wait for it, end it "
                                          "with 'mullion stop {}', or give this study another name",
                                          name, name));
  }
}

} // namespace mullion::study
