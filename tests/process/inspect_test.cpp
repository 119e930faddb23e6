// Looking into a live run, by the command and through its socket: what is seen is right, and whoever looks cannot
// disturb it, however badly he behaves.
#include "process/run_socket.hpp"
#include "support/faulty_piston.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace mullion;
using namespace std::chrono_literals;
using test::has;

namespace {

using Json = nlohmann::json;

/// 120,000 steps, a row of history for each: at full speed they take half a second inline.
test::CaseRun watched_piston(const std::vector<std::string>& flags = {"--processes"})
{
  return test::piston({"run.end_time=0.7313392802640529", "output.every=20000"}, flags);
}

/// Results of the same without anybody watching, made once.
std::filesystem::path whole()
{
  static const test::RunFolder folder;
  static const bool is_made = [] {
    auto run = watched_piston({"--inline"});
    run.sets.emplace_back("run.name=whole");
    run.out = "whole";
    return folder.run(run).exit_code == 0;
  }();
  REQUIRE(is_made);
  return folder / "whole";
}

Json inspect(const test::RunFolder& folder, const std::vector<std::string>& what)
{
  std::vector<std::string> command{"inspect", test::piston_name};
  command.insert(command.end(), what.begin(), what.end());
  command.emplace_back("--json");
  const auto result = folder.command(command);
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  return Json::parse(result.out);
}

/// The number under a column of history.csv in the row of a step.
std::string history_value(const std::string& history, const std::string& column, long long step)
{
  std::istringstream lines(history);
  std::string line, name, value;
  std::getline(lines, line);
  std::istringstream head(line);
  int index = 0;
  while (std::getline(head, name, ',') && name != column) ++index;
  while (std::getline(lines, line) && std::stoll(line) != step) {
  }
  std::istringstream row(line);
  for (int i = 0; i <= index; ++i) std::getline(row, value, ',');
  return value;
}

/// A client that does what it wants. @return its socket
int connect_to(const test::RunFolder& folder)
{
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const auto path = (folder.runtime() / (std::string(test::piston_name) + ".sock")).string();
  std::strcpy(address.sun_path, path.c_str());
  REQUIRE(::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  return fd;
}

void check_undisturbed(const test::RunFolder& folder, test::Process& run)
{
  run.send(SIGINT);
  const auto result = run.wait();
  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(test::difference_of_part(folder / "out", whole()) == "");
  test::check_nothing_left(folder);
}

} // namespace

TEST_CASE("inspect shows modules, calls and windows of a run at full speed, and the values that its history has")
{
  const test::RunFolder folder;
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    std::filesystem::remove_all(folder / "out");
    const auto run = folder.start(watched_piston({where}));
    REQUIRE(folder.wait_for_step(test::piston_name, 5));

    const auto all = inspect(folder, {});
    const auto wet = inspect(folder, {"structure.wet"});
    const auto volume = inspect(folder, {"fluid/volume", "--values", "1000"});
    const auto received = inspect(folder, {"structure/wet.in.traction"});
    std::vector<Json> displacements;
    for (int i = 0; i < 5; ++i) displacements.push_back(inspect(folder, {"structure.wet.displacement"}));

    CHECK(all.at("name") == "faulty");
    CHECK(all.at("step").get<long long>() >= 5);
    CHECK(all.at("modules").size() == 4);
    CHECK(all.at("modules")[1].at("plugin") == "faulty_structure");
    CHECK((all.at("modules")[1].at("pid") == 0) == (where == std::string("--inline")));
    const auto& calls = all.at("modules")[0].at("calls");
    CHECK(calls[0].at("call") == "step");
    CHECK(calls[0].at("count").get<long long>() >= 5);
    CHECK(calls[0].at("work_s").get<double>() > 0.0);
    CHECK(calls[0].at("work_s") <= calls[0].at("wall_s"));
    CHECK(std::any_of(all.at("windows").begin(), all.at("windows").end(),
                      [](const Json& window) { return window.at("name") == "driver/state"; }));
    CHECK(wet.at("owner") == "structure");
    CHECK(wet.at("fields").size() == 4);
    CHECK(wet.at("nodes") == 1);

    // The statistics are those of the values, all of which were asked for here.
    for (const auto& field : volume.at("fields")) {
      const std::vector<double> values = field.at("values");
      REQUIRE(values.size() == field.at("components").get<std::size_t>() * field.at("entities").get<std::size_t>());
      double sum = 0.0, squares = 0.0;
      for (const double value : values) {
        sum += value;
        squares += value * value;
      }
      const auto [least, largest] = std::minmax_element(values.begin(), values.end());
      CHECK(field.at("min") == *least);
      CHECK(field.at("max") == *largest);
      // The numbers are summed in the same order in both places.
      CHECK(field.at("mean") == sum / static_cast<double>(values.size()));
      CHECK(field.at("norm") == std::sqrt(squares));
    }
    CHECK(received.at("owner") == "driver");
    CHECK(received.at("fields")[0].at("name") == "traction");

    // What was seen in passing is what the whole run has in the row of that step, to the last bit.
    const auto history = test::read_file(whole() / "history.csv");
    for (const auto& seen : displacements) {
      const auto step = seen.at("step").get<long long>();
      CAPTURE(step);
      CHECK(std::stod(history_value(history, "structure.wet.displacement", step)) ==
            seen.at("fields")[0].at("values")[0].get<double>());
    }
    check_undisturbed(folder, *run);
  }
}

TEST_CASE("inspect without --json is for people, and --follow goes on until the run ends")
{
  const test::RunFolder folder;
  const auto run = folder.start(watched_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 5));

  const auto all = folder.command({"inspect", test::piston_name});
  const auto wet = folder.command({"inspect", test::piston_name, "structure.wet"});
  const auto one = folder.command({"inspect", test::piston_name, "fluid.volume.density", "--values", "2"});
  const auto following = folder.start_command({"inspect", test::piston_name, "structure.wet", "--follow", "0.02"});
  std::this_thread::sleep_for(200ms);
  run->send(SIGINT);
  REQUIRE(run->wait().exit_code == 0);
  const auto followed = following->wait();

  CHECK(has(all.out, "run faulty: step "));
  CHECK(has(all.out, "structure      structure      faulty_structure"));
  CHECK(has(all.out, "structure/wet.in "));
  CHECK(has(wet.out, "structure/wet: step "));
  CHECK(has(wet.out, "displacement "));
  CHECK(!has(wet.out, "  [0] "));
  CHECK(has(one.out, "  [1] "));
  CHECK(!has(one.out, "  [2] "));
  CHECK(has(one.out, "  … 20 values in all; --values N shows more\n"));
  CHECK_MESSAGE(followed.exit_code == 0, followed.err);
  CHECK(followed.err == "");
  const auto first = followed.out.find("structure/wet: step "),
             second = followed.out.find("structure/wet: ", first + 1);
  CHECK(second != std::string::npos); // more than one look
}

TEST_CASE("inspect of a run, window or field that is not there names the nearest")
{
  const test::RunFolder folder;
  const auto run = folder.start(watched_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 5));
  for (const auto& [words, error] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"faultz"}, "no run named 'faultz' is alive; did you mean 'faulty'?"},
           {{"faulty", "structure.wett"}, "run 'faulty' has no window 'structure/wett'; did you mean 'structure/wet'?"},
           {{"faulty", "structure/wet.velocty"},
            "window structure/wet of run 'faulty' has no field 'velocty'; did you mean 'velocity'?"},
           {{"faulty", "weather"}, "run 'faulty' has no window 'weather'; known are "}}) {
    std::vector<std::string> command{"inspect"};
    command.insert(command.end(), words.begin(), words.end());
    const auto result = folder.command(command);
    CHECK(result.exit_code == 2);
    CHECK_MESSAGE(has(result.err, "mullion: error: " + error), result.err);
  }
  CHECK(folder.command({"inspect", "faulty", "structure.wet", "--values", "-1"}).exit_code == 2);
  CHECK(folder.command({"inspect", "faulty", "structure.wet", "--follow", "0"}).exit_code == 2);
}

TEST_CASE("clients that stop, die or never read do not hold up a run, nor other clients")
{
  const test::RunFolder folder;
  const auto run = folder.start(watched_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 5));

  std::vector<int> sockets;
  for (int i = 0; i < 40; ++i) { // of the 64 that a run listens to at a time
    sockets.push_back(connect_to(folder));
    const std::string half = i % 3 == 0 ? "sta" : i % 3 == 1 ? "status\n" : "";
    REQUIRE(::send(sockets.back(), half.data(), half.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(half.size()));
    if (i % 4 == 3) { // gone, at once
      ::close(sockets.back());
      sockets.pop_back();
    }
  }
  const auto before = folder.steps_of(test::piston_name); // is answered beside them
  CHECK(before >= 5);
  CHECK(folder.wait_for_step(test::piston_name, before + 10));

  const std::string endless(100'000, 'x'); // a line without an end: dropped after 64 KiB
  const int talker = connect_to(folder);
  for (int i = 0; i < 100; ++i) (void)!::send(talker, endless.data(), endless.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  CHECK(folder.wait_for_step(test::piston_name, folder.steps_of(test::piston_name) + 10));

  for (int i = 0; i < 10; ++i) { // inspectors that are killed and stopped at any moment
    const auto inspector = folder.start_command({"inspect", test::piston_name, "--follow", "0.001"});
    std::this_thread::sleep_for(std::chrono::milliseconds(7 * i));
    inspector->send(i % 2 == 0 ? SIGKILL : SIGSTOP);
    CHECK(folder.wait_for_step(test::piston_name, folder.steps_of(test::piston_name) + 10));
    inspector->send(SIGKILL);
    (void)inspector->wait();
  }
  for (const int socket : sockets) ::close(socket);
  ::close(talker);
  check_undisturbed(folder, *run);
}

TEST_CASE("another user gets no answer but that")
{
  if (::getuid() != 0) return; // only root can become somebody else
  const test::RunFolder folder;
  const auto run = folder.start(watched_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 5));
  namespace fs = std::filesystem;
  // As badly protected as it gets: anybody may come up to the socket.
  fs::permissions(folder.path(), fs::perms::all);
  fs::permissions(folder.runtime(), fs::perms::all);
  fs::permissions(folder.runtime() / "faulty.sock", fs::perms::all);

  int answer[2];
  REQUIRE(::pipe(answer) == 0);
  const pid_t other = ::fork();
  if (other == 0) {
    if (::setgid(65534) != 0 || ::setuid(65534) != 0) ::_exit(1);
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, (folder.runtime() / "faulty.sock").c_str());
    if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) ::_exit(2);
    (void)!::send(fd, "stop\n", 5, MSG_NOSIGNAL);
    char buffer[256];
    const auto n = ::read(fd, buffer, sizeof buffer);
    (void)!::write(answer[1], buffer, n > 0 ? static_cast<std::size_t>(n) : 0);
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(other, &status, 0);
  char buffer[256] = {};
  ::close(answer[1]);
  (void)!::read(answer[0], buffer, sizeof buffer - 1);
  ::close(answer[0]);

  CHECK(status == 0);
  CHECK(has(buffer, "this run belongs to another user"));
  fs::permissions(folder.runtime(), fs::perms::owner_all);
  CHECK(folder.wait_for_step(test::piston_name, folder.steps_of(test::piston_name) + 10)); // it was not stopped
  check_undisturbed(folder, *run);
}
