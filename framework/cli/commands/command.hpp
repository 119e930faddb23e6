// The subcommands of `mullion`: one function each, in a file of its own, composed from the app interface. A
// command prints its result to standard output and returns an outcome; what it can't do it throws, and main.cpp
// makes the message and the exit code.
#pragma once

#include <mullion/app/case_file.hpp>

#include <stdexcept>
#include <string>
#include <vector>

namespace mullion::cli {

/// What stands behind the subcommand's name.
using Arguments = std::vector<std::string>;

/// The outcomes of the design; main.cpp returns them as they are.
enum Outcome : int { success = 0, run_failed = 1, wrong_usage = 2 };

/// The command line is wrong: main.cpp adds where help is found.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

int run_run(const Arguments& arguments);           // run.cpp
int run_check(const Arguments& arguments);         // check.cpp
int run_mesh(const Arguments& arguments);          // mesh.cpp
int run_modules(const Arguments& arguments);       // modules.cpp
int run_study(const Arguments& arguments);         // study.cpp
int run_transfer_test(const Arguments& arguments); // transfer_test.cpp
int run_report(const Arguments& arguments);        // report.cpp
int run_ps(const Arguments& arguments);            // ps.cpp
int run_stop(const Arguments& arguments);          // stop.cpp
int run_inspect(const Arguments& arguments);       // inspect.cpp
int run_set(const Arguments& arguments);           // set.cpp
int run_swap(const Arguments& arguments);          // swap.cpp
int run_checkpoint(const Arguments& arguments);    // checkpoint.cpp

} // namespace mullion::cli
