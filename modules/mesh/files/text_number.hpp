// Numbers as text that reads back to the same bits, whatever the locale: for the writers.
#pragma once

#include <charconv>
#include <string>

namespace mullion::mesh_files {

/// Append the shortest text of this value, and a separator.
template <class T> void append(std::string& text, T value, char separator)
{
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  text.append(digits, end);
  text += separator;
}

} // namespace mullion::mesh_files
