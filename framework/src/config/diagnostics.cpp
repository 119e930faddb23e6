#include "config/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace mullion::config {

std::vector<Diagnostic> Diagnostics::sorted(const std::string& file) const
{
  auto found = found_;
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    const auto rank = [](const Place& p) { return std::tuple(p.flag.empty() ? 0 : 1, p.line, p.column); };
    return rank(a.first) < rank(b.first);
  });
  std::vector<Diagnostic> out;
  for (const auto& [place, message] : found)
    out.push_back({place.flag.empty() ? fmt::format("{}:{}:{}", file, place.line, place.column) : place.flag, message});
  return out;
}

} // namespace mullion::config
