// Numbers as bytes of a file: their types, and reading them whatever the order of their bytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mullion::mesh_files {

enum class Number { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

std::size_t size_of(Number type);
inline bool is_real(Number type) { return type == Number::f32 || type == Number::f64; }

/// One number, wherever it stands. `is_swapped`: its bytes are in the order that this machine does not use.
double real_at(const char* bytes, Number type, bool is_swapped);
/// @pre the type is an integer; a u64 beyond the largest i64 comes out negative, which no count or node is
std::int64_t integer_at(const char* bytes, Number type, bool is_swapped);

/// Is the order of bytes of this machine the one with the smallest first?
bool is_little_endian();

} // namespace mullion::mesh_files
