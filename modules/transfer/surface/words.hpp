// Numbers and places in messages: kernels have no formatting library, and messages that name a place want one.
#pragma once

#include <sstream>
#include <string>

namespace mullion::surface {

/// All arguments written one after the other, numbers with six digits.
template <typename... Parts> std::string words(const Parts&... parts)
{
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

} // namespace mullion::surface
