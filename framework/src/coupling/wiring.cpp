#include <mullion/coupling/wiring.hpp>

#include <mullion/sdk/error.hpp>

#include <algorithm>

namespace mullion {

bool Wiring::has(const std::string& kind) const
{
  return std::any_of(instances_.begin(), instances_.end(),
                     [&](const auto& instance) { return instance.first == kind; });
}

const std::vector<InterfacePair>& Wiring::interfaces() const
{
  MULLION_REQUIRE(!interfaces_.empty(), Errc::config,
                  "it couples windows of two modules, and the case lists none; add [coupling] with interfaces = "
                  "[[\"fluid.wall\", \"structure.wet\"]], or choose a scheme without a pair");
  return interfaces_;
}

std::string Wiring::instance(const std::string& kind) const
{
  const auto found =
      std::find_if(instances_.begin(), instances_.end(), [&](const auto& instance) { return instance.first == kind; });
  if (found != instances_.end()) return found->second;
  std::vector<std::string> kinds;
  for (const auto& [known, name] : instances_) kinds.push_back(known);
  throw Error(Errc::config,
              fmt::format("the scheme needs a module of the kind {}, and the case has none (it has: {}); "
                          "add a table with such a module: module = \"…\"",
                          kind, kinds.empty() ? "no modules" : fmt::format("{}", fmt::join(kinds, ", "))));
}

} // namespace mullion
