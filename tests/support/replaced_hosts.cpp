#include "support/replaced_hosts.hpp"

#include "support/faulty_piston.hpp"

#include <doctest/doctest.h>

namespace mullion::test {

void replace_each_host(const RunFolder& folder, const std::function<void(pid_t host)>& disturb)
{
  const auto ten_steps_later = [&] { return folder.wait_for_step(piston_name, folder.steps_of(piston_name) + 10); };
  for (int module = 0; module < 4; ++module) {
    CAPTURE(module);
    REQUIRE(ten_steps_later());
    const auto host = find_host(folder, module);
    disturb(host);
    CHECK(wait_until([&] {
      const auto next = find_host(folder, module);
      return next != 0 && next != host;
    }));
  }
  REQUIRE(ten_steps_later());
}

} // namespace mullion::test
