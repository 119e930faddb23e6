#include "config/suggestions.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mullion::config {
namespace {

/// Letters to insert, delete, replace or swap with their neighbour: the optimal string alignment distance.
std::size_t edit_distance(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swap) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

} // namespace

std::string nearest_name(std::string_view given, const std::vector<std::string>& known)
{
  std::string nearest;
  std::size_t smallest = 0;
  for (const auto& name : known) {
    const std::size_t distance = edit_distance(given, name);
    if (3 * distance > std::max(given.size(), name.size())) continue; // too far to be meant
    if (nearest.empty() || distance < smallest) {
      nearest = name;
      smallest = distance;
    }
  }
  return nearest;
}

std::string suggestion(std::string_view given, const std::vector<std::string>& known)
{
  if (const auto nearest = nearest_name(given, known); !nearest.empty())
    return fmt::format("; did you mean '{}'?", nearest);
  if (known.empty()) return "";
  constexpr std::size_t most = 12;
  const std::vector<std::string> shown(known.begin(), known.begin() + std::min(most, known.size()));
  return fmt::format("; known are {}{}", fmt::join(shown, ", "), known.size() > most ? ", …" : "");
}

} // namespace mullion::config
