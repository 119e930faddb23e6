// HDF5 files in memory: the same bytes each time, every double back as it was, errors instead of printed stacks.
#include "io/hdf5_image.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <random>

using namespace mullion;
using namespace mullion::io;

namespace {

Bytes build(std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::vector<double> values(1000);
  for (auto& v : values) v = static_cast<double>(random());
  const std::vector<std::int32_t> numbers{3, -1, std::numeric_limits<std::int32_t>::min()};
  ImageBuilder image;
  image.attribute("/", "step", std::int64_t{12});
  image.attribute("/", "time", 0.1);
  for (int g = 0; g < 20; ++g) {
    const auto group = "/a/b_" + std::to_string(g);
    image.dataset(group + "/values", values.data(), {500, 2});
    image.attribute(group + "/values", "unit", "kg/m\u00b3");
    image.dataset(group + "/numbers", numbers.data(), {3});
    image.external_link(group + "/link", "other.h5", "/x");
  }
  return image.finish();
}

} // namespace

TEST_CASE("the bytes of an image depend on its content only")
{
  CHECK(build(1) == build(1));
  CHECK(build(1) != build(2));
}

TEST_CASE("two images can be built and read at the same time")
{
  const double one = 1.0, two = 2.0;
  ImageBuilder first, second;
  first.dataset("/x", &one, {1});
  second.dataset("/x", &two, {1});
  const auto first_bytes = first.finish(), second_bytes = second.finish();
  const ImageReader first_reader(first_bytes, "first"), second_reader(second_bytes, "second");

  CHECK(first_reader.f64("/x") == std::vector<double>{1.0});
  CHECK(second_reader.f64("/x") == std::vector<double>{2.0});
}

TEST_CASE("every double comes back bit by bit")
{
  std::vector<double> values{0.0,
                             -0.0,
                             1e308,
                             -1e-308,
                             std::numeric_limits<double>::denorm_min(),
                             -std::numeric_limits<double>::denorm_min(),
                             std::numeric_limits<double>::max(),
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
  std::mt19937_64 random(3);
  for (int i = 0; i < 10000; ++i) values.push_back(std::bit_cast<double>(random()));
  ImageBuilder image;
  image.dataset("/values", values.data(), {static_cast<std::int64_t>(values.size())});
  image.attribute("/", "smallest", std::numeric_limits<double>::denorm_min());
  const auto bytes = image.finish();

  const ImageReader reader(bytes, "test");
  const auto found = reader.f64("/values");

  REQUIRE(found.size() == values.size());
  CHECK(std::memcmp(found.data(), values.data(), values.size() * sizeof(double)) == 0);
  CHECK(reader.f64_attribute("/", "smallest") == std::numeric_limits<double>::denorm_min());
}

TEST_CASE("groups, extents, integers, raw bytes and texts come back")
{
  const std::vector<double> values{1, 2, 3, 4, 5, 6};
  const std::vector<std::int64_t> large{std::int64_t{1} << 62, -5};
  const std::vector<std::byte> raw{std::byte{0}, std::byte{255}};
  ImageBuilder image;
  image.dataset("/a/b/values", values.data(), {3, 2});
  image.attribute("/a/b/values", "unit", "N/m\u00b2");
  image.attribute("/a", "empty", "");
  image.dataset("/large", large.data(), {2});
  image.dataset("/raw", raw);
  image.dataset("/none", static_cast<const double*>(nullptr), {0, 3});
  image.group("/a/c");
  const auto bytes = image.finish();
  const ImageReader reader(bytes, "test");

  CHECK(reader.names("/") == std::vector<std::string>{"a", "large", "none", "raw"});
  CHECK(reader.names("/a") == std::vector<std::string>{"b", "c"});
  CHECK(reader.extents("/a/b/values") == Extents{3, 2});
  CHECK(reader.f64("/a/b/values") == values);
  CHECK(reader.text_attribute("/a/b/values", "unit") == "N/m\u00b2");
  CHECK(reader.text_attribute("/a", "empty") == "");
  CHECK(reader.i64("/large") == large);
  CHECK(reader.bytes("/raw") == raw);
  CHECK(reader.extents("/none") == Extents{0, 3});
  CHECK(reader.f64("/none").empty());
  CHECK(reader.has("/a/b/values"));
  CHECK_FALSE(reader.has("/a/x/values"));
}

TEST_CASE("a list of texts comes back, empty ones and an empty list too")
{
  const std::vector<std::string> texts{"", "scheme A", "kg/m\u00b3"};
  ImageBuilder image;
  image.dataset("/texts", texts);
  image.dataset("/empty", std::vector<std::string>{"", ""});
  image.dataset("/none", std::vector<std::string>{});
  const double number = 1.0;
  image.dataset("/number", &number, {1});
  const auto bytes = image.finish();
  const ImageReader reader(bytes, "image");

  CHECK(reader.texts("/texts") == texts);
  CHECK(reader.texts("/empty") == std::vector<std::string>{"", ""});
  CHECK(reader.texts("/none").empty());
  CHECK_THROWS_WITH_AS((void)reader.texts("/number"), "image:/number does not hold a list of texts", Error);
}

TEST_CASE("what is not there, of another type or no HDF5 file is an error that names it")
{
  const double one = 1.0;
  ImageBuilder image;
  image.dataset("/x", &one, {1});
  CHECK_THROWS_WITH_AS(image.dataset("/x", &one, {1}), doctest::Contains("/x"), Error);
  const auto bytes = image.finish();
  const ImageReader reader(bytes, "file.h5");

  CHECK_THROWS_WITH_AS((void)reader.f64("/y"), doctest::Contains("file.h5:/y"), Error);
  CHECK_THROWS_WITH_AS((void)reader.i32("/x"), doctest::Contains("file.h5:/x"), Error);
  CHECK_THROWS_WITH_AS((void)reader.text_attribute("/x", "unit"), doctest::Contains("file.h5:/x@unit"), Error);
  const Bytes nonsense(1000, std::byte{17});
  CHECK_THROWS_WITH_AS(ImageReader(nonsense, "nonsense"), doctest::Contains("nonsense"), Error);
}
