// One way to parse the arguments of a subcommand: no abbreviations, near names for misspelt options, and --help.
#pragma once

#include "commands/command.hpp"

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>

#include <optional>
#include <string>

namespace mullion::cli {

struct CommandLine {
  std::string usage;   ///< "mullion check CASE [options]"
  std::string summary; ///< one sentence
  boost::program_options::options_description options;
  std::string positional; ///< the option that takes what stands without a dash; "": nothing may
  int n_positional = 1;   ///< at most; -1: any number
};

/// The parsed arguments, or nothing if --help was asked for and printed.
/// @throws UsageError unknown option, missing value, too many arguments
std::optional<boost::program_options::variables_map> parse_arguments(const CommandLine& command,
                                                                     const Arguments& arguments);

} // namespace mullion::cli
