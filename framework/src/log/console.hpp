// The one stream that a user reads: log lines on standard error, each with its source's name, and the progress
// line of a terminal, which log lines push down. Safe from any thread.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace mullion::log {

enum class Level { debug, info, warning, error, off };

/// "debug", "info", …; returns false for an unknown name.
bool parse_level(std::string_view name, Level& level);

/// The level of a mullion_log_level number of the C boundary; what is unknown counts as info.
Level level_of(std::uint32_t number);

/// Once, before the first line. `is_terminal`: standard error is one, and may show a progress line.
void initialise(Level level, bool is_terminal);

/// One line of `source` ("fluid", "driver", "run").
void write(Level level, std::string_view source, std::string_view text);

template <class... T> void debug(std::string_view source, fmt::format_string<T...> text, T&&... values)
{
  write(Level::debug, source, fmt::format(text, std::forward<T>(values)...));
}
template <class... T> void info(std::string_view source, fmt::format_string<T...> text, T&&... values)
{
  write(Level::info, source, fmt::format(text, std::forward<T>(values)...));
}
template <class... T> void warning(std::string_view source, fmt::format_string<T...> text, T&&... values)
{
  write(Level::warning, source, fmt::format(text, std::forward<T>(values)...));
}
template <class... T> void error(std::string_view source, fmt::format_string<T...> text, T&&... values)
{
  write(Level::error, source, fmt::format(text, std::forward<T>(values)...));
}

[[nodiscard]] bool is_terminal();

/// Show (or replace) the progress line; "" removes it. Nothing happens where standard error is no terminal.
void show_progress(const std::string& line);

} // namespace mullion::log
