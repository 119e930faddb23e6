#include "vtu_arrays.hpp"

#include "base64.hpp"
#include "file_error.hpp"
#include "scanner.hpp"

#include <pugixml.hpp>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <functional>

namespace mullion::mesh_files {
namespace {

/// zlib makes at most this much of a byte; a header that announces more is damaged.
constexpr std::size_t largest_ratio = 1100;

Number type_of(const VtuFile& file, const pugi::xml_node& array)
{
  static constexpr std::pair<const char*, Number> types[] = {
      {"Int8", Number::i8},     {"UInt8", Number::u8},   {"Int16", Number::i16}, {"UInt16", Number::u16},
      {"Int32", Number::i32},   {"UInt32", Number::u32}, {"Int64", Number::i64}, {"UInt64", Number::u64},
      {"Float32", Number::f32}, {"Float64", Number::f64}};
  const char* name = array.attribute("type").value();
  for (const auto& [known, type] : types)
    if (std::strcmp(name, known) == 0) return type;
  file.fail(array, join("a DataArray of type \"", shown(name), '"'), "Int8 to UInt64, Float32 or Float64");
}

/// Text without blanks: base64 may be broken into lines.
std::string without_blanks(std::string_view text)
{
  std::string out(text);
  std::erase_if(out, [](char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; });
  return out;
}

std::string need(const VtuFile& file, const pugi::xml_node& array, std::string_view bytes, std::size_t begin,
                 std::size_t n)
{
  if (begin > bytes.size() || n > bytes.size() - begin)
    file.fail(array, join("binary data that end after ", bytes.size(), " bytes"),
              join("at least ", n, " from byte ", begin, " on: the file is cut off or damaged"));
  return std::string(bytes.substr(begin, n));
}

/// n bytes from base64 text, from its begin on: no more of it is decoded than that.
std::string decoded(const VtuFile& file, const pugi::xml_node& array, std::string_view text, std::size_t n)
{
  const auto characters = n / 3 * 4 + (n % 3 == 0 ? 0 : 4);
  const auto bytes = from_base64(text.substr(0, std::min(characters, text.size())));
  if (!bytes) file.fail(array, "text that is no base64", "letters, digits, + and /, in groups of four");
  return need(file, array, *bytes, 0, n);
}

std::size_t header_number(const VtuFile& file, const std::string& header, std::size_t k)
{
  return static_cast<std::size_t>(integer_at(header.data() + k * size_of(file.header), file.header, file.is_swapped));
}

std::string inflated(const VtuFile& file, const pugi::xml_node& array, const std::string& block, std::size_t size)
{
  std::string out(size, '\0');
  auto n = static_cast<uLongf>(size);
  const int status = uncompress(reinterpret_cast<Bytef*>(out.data()), &n, reinterpret_cast<const Bytef*>(block.data()),
                                static_cast<uLong>(block.size()));
  if (status != Z_OK || n != size)
    file.fail(array, "compressed data that zlib does not take", join("a block of ", size, " bytes"));
  return out;
}

/// The bytes of the numbers. Binary data begin with a header of sizes: of the data, or, where they are compressed, the
/// number of blocks, the size of each before compression, that of the last if it is smaller (or 0), and the compressed
/// size of each.
/// @param at  n bytes of the header, or (from 1 on) of the data behind a header of so many bytes
std::string read_bytes(const VtuFile& file, const pugi::xml_node& array,
                       const std::function<std::string(std::size_t header, std::size_t n)>& at)
{
  const auto word = size_of(file.header);
  if (!file.is_compressed) {
    const auto size = header_number(file, at(0, word), 0);
    if (size > file.bytes.size())
      file.fail(array, join("binary data of ", size, " bytes"), "no more than the file has: it is damaged");
    return at(word, size);
  }
  const auto n_blocks = header_number(file, at(0, word), 0);
  if (n_blocks > file.bytes.size() / word)
    file.fail(array, join(n_blocks, " compressed blocks"), "no more than the file can hold: it is damaged");
  const auto header_size = (n_blocks + (n_blocks == 0 ? 1 : 3)) * word;
  const auto header = at(0, header_size);
  if (n_blocks == 0) return "";
  const auto block_size = header_number(file, header, 1), last = header_number(file, header, 2);
  std::size_t total = 0;
  for (std::size_t b = 0; b < n_blocks; ++b) {
    const auto size = header_number(file, header, 3 + b);
    if (size > file.bytes.size() - std::min(total, file.bytes.size()))
      file.fail(array, join("a compressed block of ", size, " bytes"), "no more than the file has: it is damaged");
    total += size;
  }
  const auto compressed = at(header_size, total);
  std::string out;
  std::size_t begin = 0;
  for (std::size_t b = 0; b < n_blocks; ++b) {
    const auto size = header_number(file, header, 3 + b);
    const auto full = b + 1 == n_blocks && last != 0 ? last : block_size;
    if (full > largest_ratio * (size + 1))
      file.fail(array, join("a block of ", size, " bytes that should hold ", full), "less: the file is damaged");
    out += inflated(file, array, compressed.substr(begin, size), full);
    begin += size;
  }
  return out;
}

std::string binary_bytes(const VtuFile& file, const pugi::xml_node& array)
{
  const auto format = std::string_view(array.attribute("format").value());
  std::string text;
  std::string_view from;
  if (format == "appended") {
    const auto offset = array.attribute("offset").as_ullong(file.appended.size());
    if (offset >= file.appended.size())
      file.fail(array, join("an offset \"", shown(array.attribute("offset").value()), "\" into the appended data"),
                join("a number below ", file.appended.size()));
    from = file.appended.substr(offset);
    if (file.is_appended_raw)
      return read_bytes(file, array,
                        [&](std::size_t header, std::size_t n) { return need(file, array, from, header, n); });
  } else {
    text = without_blanks(array.child_value());
    from = text;
  }
  return read_bytes(file, array, [&](std::size_t header, std::size_t n) {
    if (header == 0) return decoded(file, array, from, n);
    // The header may be a base64 text of its own, which then ends in its padding or between two groups of four, or
    // the first bytes of the one text.
    const auto characters = (header + 2) / 3 * 4;
    const auto padding = (3 - header % 3) % 3;
    const bool is_apart = characters <= from.size() &&
                          from.substr(characters - padding, padding) == std::string_view("==").substr(0, padding);
    if (is_apart) return decoded(file, array, from.substr(characters), n);
    return decoded(file, array, from, header + n).substr(header);
  });
}

template <class T, class FromText, class FromBytes>
std::vector<T> read(const VtuFile& file, const pugi::xml_node& array, const FromText& from_text,
                    const FromBytes& from_bytes)
{
  const auto type = type_of(file, array);
  const auto format = std::string_view(array.attribute("format").value());
  std::vector<T> values;
  if (format == "ascii") {
    Scanner in(file.name, array.child_value());
    for (auto word = in.word(); !word.empty(); word = in.word()) {
      T value{};
      if (!from_text(word, value))
        file.fail(array, join("\"", shown(word), "\" in a DataArray"),
                  join("a number of type ", array.attribute("type").value()));
      values.push_back(value);
    }
  } else if (format == "binary" || format == "appended") {
    const auto bytes = binary_bytes(file, array);
    const auto size = size_of(type);
    if (bytes.size() % size != 0)
      file.fail(array, join(bytes.size(), " bytes of data"), join("a multiple of ", size, ", the size of a number"));
    for (std::size_t at = 0; at < bytes.size(); at += size)
      values.push_back(from_bytes(bytes.data() + at, type, file.is_swapped));
  } else {
    file.fail(array, join("a DataArray of format \"", shown(format), '"'), "ascii, binary or appended");
  }
  return values;
}

} // namespace

void VtuFile::fail(const pugi::xml_node& at, const std::string& found, const std::string& right) const
{
  const auto offset = std::clamp<std::ptrdiff_t>(at.offset_debug(), 0, static_cast<std::ptrdiff_t>(bytes.size()));
  const auto line = 1 + std::count(bytes.begin(), bytes.begin() + offset, '\n');
  const std::string array = at.attribute("Name").empty() ? "" : join(" (", shown(at.attribute("Name").value()), ')');
  throw FileError(join(name, ':', line, array, ": ", found, "; ", right));
}

std::vector<double> read_reals(const VtuFile& file, const pugi::xml_node& array)
{
  return read<double>(
      file, array, [](std::string_view word, double& value) { return to_number(word, value); }, real_at);
}

std::vector<std::int64_t> read_integers(const VtuFile& file, const pugi::xml_node& array)
{
  if (is_real(type_of(file, array))) file.fail(array, "an array of real numbers", "integers");
  return read<std::int64_t>(
      file, array, [](std::string_view word, std::int64_t& value) { return to_number(word, value); }, integer_at);
}

} // namespace mullion::mesh_files
