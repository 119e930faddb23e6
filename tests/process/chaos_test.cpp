// A run whose hosts are killed, stopped past their deadline, swapped, set and looked at, at random moments and at the
// same time, writes the bytes of an undisturbed one. The seed is printed; MULLION_CHAOS_EVENTS and MULLION_CHAOS_SEED
// overrule number and seed (scripts/chaos.sh).
#include "process/ask.hpp"
#include "support/faulty_piston.hpp"

#include <mullion/app/inspect.hpp>
#include <mullion/app/live_runs.hpp>

#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <future>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

using namespace mullion;
using namespace std::chrono_literals;

namespace {

/// More steps than an event takes: some tens of milliseconds, and five processes need 30 us for a step at least.
constexpr long long steps_an_event = 1000;
constexpr double dt = 6.094494002200441e-6;
constexpr const char* plugins[] = {"euler_1d", "faulty_structure", "stretch_1d", "point_transfer"};

long number_from(const char* variable, long otherwise)
{
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atol(text);
}

class Chaos {
public:
  Chaos(const test::RunFolder& folder, unsigned seed) : folder_(folder), random_(seed) {}

  void disturb()
  {
    rest(4'000);
    const auto choice = draw(100);
    if (choice < 35) kill_one();
    else if (choice < 40) stop_one();
    else if (choice < 60) swap_one(false);
    else if (choice < 80) swap_one(true);
    else if (choice < 85) set_one();
    else look();
    // Two deaths in one and the same step end a run, rightly: let some steps pass.
    const auto steps = folder_.steps_of(test::piston_name);
    REQUIRE_MESSAGE(folder_.wait_for_step(test::piston_name, steps + 3), last_);
  }
  [[nodiscard]] const std::map<std::string, int>& counts() const { return counts_; }

private:
  int draw(int n) { return std::uniform_int_distribution(0, n - 1)(random_); }
  void rest(int most_us) { std::this_thread::sleep_for(std::chrono::microseconds(draw(most_us))); }
  void count(const std::string& what) { ++counts_[last_ = what]; }

  [[nodiscard]] pid_t host(int module)
  {
    try {
      return static_cast<pid_t>(look_at_run(test::piston_name).modules.at(static_cast<std::size_t>(module)).pid);
    } catch (const std::exception&) {
      return 0; // looked at too soon; 0 is nobody
    }
  }
  void send(pid_t pid, int signal) const
  {
    if (pid > 1) ::kill(pid, signal);
  }

  void kill_one()
  {
    const auto module = draw(4);
    count("kill");
    send(host(module), SIGKILL);
  }
  void stop_one()
  {
    const auto pid = host(draw(4));
    const bool is_past_deadline = draw(2) == 0;
    count(is_past_deadline ? "stop past the deadline" : "stop and continue");
    send(pid, SIGSTOP);
    std::this_thread::sleep_for(is_past_deadline ? 700ms : 50ms);
    send(pid, SIGCONT);
  }
  void swap_one(bool with_a_kill)
  {
    const auto module = draw(4);
    auto swap = std::async(std::launch::async, [module] {
      try {
        (void)swap_module(test::piston_name, test::instances[module], plugins[module], {});
        return std::string("swap");
      } catch (const Error& error) { // its host was killed before or in its first step
        return std::string(test::has(error.what(), "taken back") ? "swap taken back" : "swap refused");
      }
    });
    if (with_a_kill) {
      rest(6'000);
      const auto victim = draw(2) == 0 ? module : draw(4);
      send(host(victim), SIGKILL);
      ++counts_["kill at the time of a swap"];
    }
    count(swap.get());
  }
  void set_one()
  {
    count("set");
    try {
      (void)set_parameters(test::piston_name, {draw(2) == 0 ? "driver.alpha=0" : "structure.mass=520"});
    } catch (const Error&) { // a host died at that moment
    }
  }
  void look()
  {
    count("look");
    try {
      (void)look_at_window(test::piston_name, "fluid.volume", 3);
    } catch (const Error&) {
    }
  }

  const test::RunFolder& folder_;
  std::mt19937 random_;
  std::map<std::string, int> counts_;
  std::string last_;
};

void run_chaos(long n_events)
{
  n_events = number_from("MULLION_CHAOS_EVENTS", n_events);
  const auto seed = static_cast<unsigned>(
      number_from("MULLION_CHAOS_SEED", static_cast<long>(std::random_device{}() % 1'000'000'000)));
  MESSAGE("MULLION_CHAOS_SEED=", seed, ", events: ", n_events);
  const auto n_steps = std::max(20'000LL, steps_an_event * n_events);
  const std::vector<std::string> sets{"run.end_time=" + std::to_string(static_cast<double>(n_steps) * dt),
                                      "output.every=" + std::to_string(n_steps / 20), "output.history_every=10"};
  const test::RunFolder folder;
  auto whole = test::piston(sets, {"--inline"});
  whole.out = "whole";
  whole.sets.emplace_back("run.name=whole");
  whole.timeout = std::chrono::hours(1);
  REQUIRE(folder.run(whole).exit_code == 0);

  auto disturbed = test::piston(sets, {"--processes"});
  disturbed.sets.insert(disturbed.sets.end(), {"run.on_failure=respawn", "run.call_deadline=0.5"});
  disturbed.timeout = std::chrono::hours(1);
  const auto run = folder.start(disturbed);
  REQUIRE(folder.wait_for_step(test::piston_name, 5));
  Chaos chaos(folder, seed);
  for (long i = 0; i < n_events; ++i) chaos.disturb();
  CHECK(folder.wait_for_step(test::piston_name, 2000));
  CHECK(folder.processes().size() == 6);
  stop_run(test::piston_name);
  const auto result = run->wait();

  for (const auto& [what, count] : chaos.counts()) MESSAGE(count, " x ", what);
  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(test::last_step(folder / "out") >= 2000);
  CHECK(test::difference_of_part(folder / "out", folder / "whole") == "");
  test::check_nothing_left(folder);
}

} // namespace

TEST_CASE("30 kills, stops, swaps and looks at random moments change no byte") { run_chaos(30); }

TEST_SUITE("full")
{
  TEST_CASE("250 kills, stops, swaps and looks at random moments change no byte") { run_chaos(250); }
}
