// A driver compiled against another libmullion (its CMakeLists.txt forges the build id): refused, for its C++ types
// may be laid out otherwise.
#include <mullion/coupling/driver.hpp>

namespace mullion::test {

class WrongBuild final : public Driver {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };
  explicit WrongBuild(const Options&) {}
  void define(Wiring&) override {}
  void attach(Coupling&) override {}
  void start(const TimeStep&) override {}
  void step(const TimeStep&) override {}
};

} // namespace mullion::test

MULLION_DRIVER(mullion::test::WrongBuild, "wrong_build", "test driver of another build");
