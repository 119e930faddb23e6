#include "numbers.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace mullion::mesh_files {
namespace {

template <class T> T load(const char* bytes, bool is_swapped)
{
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (is_swapped) std::reverse(copy, copy + sizeof(T));
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return value;
}

template <class Result> Result number_at(const char* bytes, Number type, bool is_swapped)
{
  switch (type) {
  case Number::i8: return static_cast<Result>(load<std::int8_t>(bytes, is_swapped));
  case Number::u8: return static_cast<Result>(load<std::uint8_t>(bytes, is_swapped));
  case Number::i16: return static_cast<Result>(load<std::int16_t>(bytes, is_swapped));
  case Number::u16: return static_cast<Result>(load<std::uint16_t>(bytes, is_swapped));
  case Number::i32: return static_cast<Result>(load<std::int32_t>(bytes, is_swapped));
  case Number::u32: return static_cast<Result>(load<std::uint32_t>(bytes, is_swapped));
  case Number::i64: return static_cast<Result>(load<std::int64_t>(bytes, is_swapped));
  case Number::u64: return static_cast<Result>(load<std::uint64_t>(bytes, is_swapped));
  case Number::f32:
  case Number::f64: break;
  }
  return Result{};
}

} // namespace

std::size_t size_of(Number type)
{
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

double real_at(const char* bytes, Number type, bool is_swapped)
{
  if (type == Number::f32) return static_cast<double>(load<float>(bytes, is_swapped));
  if (type == Number::f64) return load<double>(bytes, is_swapped);
  return number_at<double>(bytes, type, is_swapped);
}

std::int64_t integer_at(const char* bytes, Number type, bool is_swapped)
{
  return number_at<std::int64_t>(bytes, type, is_swapped);
}

bool is_little_endian() { return std::endian::native == std::endian::little; }

} // namespace mullion::mesh_files
