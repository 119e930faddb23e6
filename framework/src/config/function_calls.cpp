#include "config/function_calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace mullion::config {
namespace {

std::string_view trimmed(std::string_view text)
{
  constexpr std::string_view blanks = " \t\r\n";
  const auto begin = text.find_first_not_of(blanks);
  return begin == std::string_view::npos ? std::string_view()
                                         : text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

std::vector<std::string_view> parts_of(std::string_view text, char separator)
{
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = std::min(text.find(separator), text.size());
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

bool read_number(std::string_view text, double& number)
{
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(number);
}

/// @returns is it one? `call` is made
bool read_call(std::string_view text, FunctionCall& call)
{
  const auto open = text.find('('), dot = text.rfind('.', open);
  if (open == std::string_view::npos || dot == std::string_view::npos || !text.ends_with(')')) return false;
  call = {std::string(trimmed(text.substr(0, dot))),
          std::string(trimmed(text.substr(dot + 1, open - dot - 1))),
          {},
          std::string(text)};
  const auto inside = trimmed(text.substr(open + 1, text.size() - open - 2));
  if (inside.empty()) return true;
  for (const auto& part : parts_of(inside, ',')) {
    double number = 0.0;
    if (!read_number(part, number)) return false;
    call.arguments.push_back(number);
  }
  return true;
}

} // namespace

FunctionCalls parse_function_calls(const std::string& text)
{
  FunctionCalls out;
  if (trimmed(text).empty()) return out;
  for (const auto& part : parts_of(text, ';')) {
    FunctionCall call;
    if (!read_call(part, call))
      return {{},
              fmt::format("\"{}\" is no call; expected module.function(number, …), with ';' between several", part)};
    out.calls.push_back(std::move(call));
  }
  return out;
}

} // namespace mullion::config
