#include "config/toml_reader.hpp"
#include "config/toml_writer.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

using namespace mullion::config;

namespace {

double read_back(double value)
{
  const auto document = parse_toml("x = " + write_real(value) + "\n");
  REQUIRE(std::holds_alternative<Node>(document));
  const auto* number = std::get_if<double>(&std::get<Node>(document).table()->find("x")->value.value);
  REQUIRE(number != nullptr); // a real stays a real: 1.0 must not come back as the integer 1
  return *number;
}

bool is_same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

std::string rewritten(const std::string& text) { return write_toml(std::get<Node>(parse_toml(text))); }

} // namespace

TEST_CASE("real numbers are written shortest")
{
  CHECK(write_real(0.05) == "0.05");
  CHECK(write_real(1e-5) == "1e-05");
  CHECK(write_real(1.0) == "1.0");
  CHECK(write_real(-0.0) == "-0.0");
  CHECK(write_real(0.1 + 0.2) == "0.30000000000000004");
}

TEST_CASE("written numbers read back to the same bits")
{
  using Limits = std::numeric_limits<double>;
  for (const double value : {0.0,
                             -0.0,
                             1.0,
                             -1.0,
                             0.1,
                             1.0 / 3.0,
                             0.05,
                             1e-5,
                             1e15,
                             1e16,
                             1e17,
                             1e22,
                             1e23,
                             1e300,
                             123456789.012345678,
                             Limits::min(),
                             Limits::denorm_min(),
                             Limits::max(),
                             Limits::lowest(),
                             Limits::epsilon(),
                             std::nextafter(1.0, 2.0),
                             std::nextafter(1.0, 0.0)})
    CHECK_MESSAGE(is_same(read_back(value), value), write_real(value));

  std::mt19937_64 random(20240101); // any fixed seed: bit patterns over all magnitudes
  for (int i = 0; i < 20000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    if (!is_same(read_back(value), value)) FAIL(write_real(value));
  }
}

TEST_CASE("a document is written in its order, lists of tables included")
{
  const std::string text = "[zebra]\nb = 1\na = \"x\"\n\n[[expect]]\nq = 1.5\n\n[[expect]]\nq = true\n\n[ape]\n"
                           "pairs = [[\"fluid.wall\", \"structure.wet\"], []]\n";

  CHECK(rewritten(text) == text);
}

TEST_CASE("texts are escaped such that they read back")
{
  const std::string text = "x = \"quote \\\" backslash \\\\ newline \\n tab \\t bell \\u0007 zero \\u0000 é\"\n";

  CHECK(rewritten(text) == text);
}

TEST_CASE("keys that need quotes get them, nested tables are written inline")
{
  CHECK(rewritten("[\"a b\"]\nc.d = 1\n[\"a b\".e]\n") == "[\"a b\"]\nc = { d = 1 }\ne = {}\n");
}

TEST_CASE("what stands in front of the first table stays there")
{
  CHECK(rewritten("x = 1\n[a]\ny = 2\n") == "x = 1\n\n[a]\ny = 2\n");
}
