#include "base64.hpp"

#include <cstdint>

namespace mullion::mesh_files {
namespace {

int value_of(char c)
{
  if ('A' <= c && c <= 'Z') return c - 'A';
  if ('a' <= c && c <= 'z') return c - 'a' + 26;
  if ('0' <= c && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

} // namespace

std::optional<std::string> from_base64(std::string_view text)
{
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t at = 0; at < text.size(); at += 4) {
    const auto group = text.substr(at, 4);
    if (group.size() < 4) return {};
    const int n = group[2] == '=' ? 1 : group[3] == '=' ? 2 : 3; // bytes in this group
    std::uint32_t bits = 0;
    for (int k = 0; k < 4; ++k) {
      const int value = k <= n ? value_of(group[static_cast<std::size_t>(k)]) : 0;
      if (value < 0) return {};
      bits = bits << 6 | static_cast<std::uint32_t>(value);
    }
    for (int k = 0; k < n; ++k) bytes += static_cast<char>(bits >> (16 - 8 * k) & 0xff);
    if (n < 3) break;
  }
  return bytes;
}

} // namespace mullion::mesh_files
