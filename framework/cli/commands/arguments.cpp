#include "commands/arguments.hpp"

#include <mullion/app/catalogue.hpp>

#include <boost/program_options/parsers.hpp>
#include <boost/program_options/positional_options.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <sstream>

namespace mullion::cli {

namespace po = boost::program_options;

std::optional<po::variables_map> parse_arguments(const CommandLine& command, const Arguments& arguments)
{
  po::options_description visible("options");
  for (const auto& option : command.options.options()) visible.add(option);
  visible.add_options()("help,h", "show this help");
  po::options_description all;
  all.add(visible);
  po::positional_options_description positional;
  if (!command.positional.empty()) {
    using Texts = std::vector<std::string>;
    all.add_options()(command.positional.c_str(), po::value<Texts>());
    positional.add(command.positional.c_str(), command.n_positional);
  }
  try {
    // no guessing: an abbreviation of today is another option's name tomorrow
    const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    po::variables_map values;
    po::store(po::command_line_parser(arguments).options(all).positional(positional).style(style).run(), values);
    po::notify(values);
    if (values.count("help") == 0) return values;
  } catch (const po::unknown_option& error) {
    std::vector<std::string> known;
    for (const auto& option : visible.options()) known.push_back("--" + option->long_name());
    throw UsageError(
        fmt::format("unknown option '{}'{}", error.get_option_name(), did_you_mean(error.get_option_name(), known)));
  } catch (const po::too_many_positional_options_error&) {
    throw UsageError(fmt::format("too many arguments; expected {}", command.usage));
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
  std::ostringstream options;
  options << visible;
  fmt::print("usage: {}\n\n{}\n\n{}", command.usage, command.summary, options.str());
  return std::nullopt;
}

} // namespace mullion::cli
