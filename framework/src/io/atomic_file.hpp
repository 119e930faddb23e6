// Files that are either the old or the new content, never a part: written to a temporary name beside the target,
// synced, renamed, and the folder synced. Binary files carry a trailer (length and checksum) behind their content,
// so that no reader, least of all the HDF5 library, sees a byte of a file that was cut short or altered. A process
// that dies here leaves `<name>.tmp-<pid>` behind and the old file whole; remove_stale_temporaries() sweeps such
// files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mullion::io {

using Bytes = std::vector<std::byte>;

/// Whether 24 bytes follow the content: its length, its CRC-64/XZ (both 8 bytes, little-endian), "MULLTRL1".
enum class Trailer : bool { none, checksum };
inline constexpr std::size_t trailer_bytes = 24;

/// CRC-64/XZ (ECMA-182 reflected, all ones in and out): the checksum of the .xz format.
[[nodiscard]] std::uint64_t crc64(std::span<const std::byte> content);

/// Replace the file at `path` by `content` in one step. The folder must exist.
/// @throws Error Errc::io: what failed, on which file, and why (disk full, no permission, ...); the old file is whole
void write_atomically(const std::filesystem::path& path, std::span<const std::byte> content, Trailer trailer);
void write_atomically(const std::filesystem::path& path, std::string_view text);

/// The content of a file that write_atomically() wrote with Trailer::checksum.
/// @throws Error Errc::io: unreadable, without a trailer (foreign or truncated), or altered
[[nodiscard]] Bytes read_checked(const std::filesystem::path& path);

/// The content of a text file.
/// @throws Error Errc::io
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// Make a folder and its parents, unless it is there.
/// @throws Error Errc::io
void make_folder(const std::filesystem::path& folder);

/// Remove the temporaries that processes left in `folder` which do not live any more. Never throws.
void remove_stale_temporaries(const std::filesystem::path& folder) noexcept;

} // namespace mullion::io
