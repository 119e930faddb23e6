// Every pair of quantities that a transfer may be asked for.
#include "surface/legality.hpp"

#include <doctest/doctest.h>

#include <array>
#include <string>

using namespace mullion::surface;

namespace {

constexpr Transferred traction{Quantity::traction, Nature::intensive};
constexpr Transferred load{Quantity::load, Nature::extensive};
constexpr Transferred velocity{Quantity::velocity, Nature::intensive};
constexpr Transferred displacement{Quantity::displacement, Nature::intensive};

} // namespace

TEST_CASE("the table of legal transfers")
{
  const std::array<Transferred, 4> all = {traction, load, velocity, displacement};
  //                              traction load  velocity displacement
  const bool with_recovery[4][4] = {
      {true, true, false, false}, {true, true, false, false}, {false, false, true, false}, {false, false, false, true}};
  const bool without[4][4] = {{false, true, false, false},
                              {false, true, false, false},
                              {false, false, true, false},
                              {false, false, false, true}};
  for (std::size_t source = 0; source < 4; ++source)
    for (std::size_t target = 0; target < 4; ++target) {
      CAPTURE(source);
      CAPTURE(target);
      CHECK(complaint_about_transfer(all[source], all[target], true).empty() == with_recovery[source][target]);
      CHECK(complaint_about_transfer(all[source], all[target], false).empty() == without[source][target]);
    }
}

TEST_CASE("a field whose nature contradicts its quantity is refused on either side")
{
  const Transferred wrong{Quantity::traction, Nature::extensive};

  CHECK(complaint_about_transfer(wrong, load, true) == "the source is an extensive traction; a traction is intensive");
  CHECK(complaint_about_transfer(traction, {Quantity::load, Nature::intensive}, true) ==
        "the target is an intensive load; a load is extensive");
}

TEST_CASE("a refusal says what would be possible")
{
  CHECK(complaint_about_transfer(load, traction, false).find("turn recovery on") != std::string::npos);
  CHECK(complaint_about_transfer(velocity, displacement, true).find("same quantity only") != std::string::npos);
}
