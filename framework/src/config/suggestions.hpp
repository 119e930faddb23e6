// "Did you mean": the nearest known name to a misspelt one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mullion::config {

/// The known name with the smallest edit distance to `given`, or "" if none is near enough to be meant
/// (more than a third of the letters differ).
std::string nearest_name(std::string_view given, const std::vector<std::string>& known);

/// "; did you mean 'x'?" or, without a near name, "; known are a, b, c" (at most 12 names).
std::string suggestion(std::string_view given, const std::vector<std::string>& known);

} // namespace mullion::config
