#include "run/under_guard.hpp"

#include "log/console.hpp"

#include <mullion/sdk/error.hpp>

#include <cstdio>
#include <unistd.h>

namespace mullion::run {
namespace {

void print_error(const std::string& text)
{
  log::show_progress("");
  std::fprintf(stderr, "mullion: error: %s\n", text.c_str());
}

/// 2 where the command or the case is wrong, 1 where the run failed.
int exit_code_of(Errc code) { return code == Errc::config || code == Errc::plugin ? 2 : 1; }

} // namespace

int under_guard(const std::string& log_level, const process::Orchestrator& body)
{
  log::Level level{};
  MULLION_REQUIRE(log::parse_level(log_level, level), Errc::config,
                  "--log-level '{}': expected debug, info, warning, error or off", log_level);
  return process::run_guarded([&](shm::Control& control, int control_fd) {
    try {
      log::initialise(level, ::isatty(STDERR_FILENO) != 0);
      return body(control, control_fd);
    } catch (const Error& error) {
      print_error(error.what());
      return exit_code_of(error.code());
    } catch (const std::exception& error) {
      print_error(error.what());
      return 1;
    }
  });
}

} // namespace mullion::run
