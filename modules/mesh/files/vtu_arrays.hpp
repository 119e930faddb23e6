// The data arrays of VTK's XML files: however they are encoded, as numbers.
#pragma once

#include "numbers.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pugi {
class xml_node;
}

namespace mullion::mesh_files {

/// What the whole file says about its arrays, and its text.
struct VtuFile {
  std::string name;
  std::string_view bytes;    ///< of the file
  std::string_view appended; ///< what follows the '_' of AppendedData
  bool is_appended_raw = false, is_swapped = false, is_compressed = false;
  Number header = Number::u32; ///< of the sizes before binary data

  /// @throws FileError "FILE:LINE: found; right" at this element
  [[noreturn]] void fail(const pugi::xml_node& at, const std::string& found, const std::string& right) const;
};

/// All values of a DataArray.
std::vector<double> read_reals(const VtuFile& file, const pugi::xml_node& array);
/// @throws FileError also where the array is declared as real
std::vector<std::int64_t> read_integers(const VtuFile& file, const pugi::xml_node& array);

} // namespace mullion::mesh_files
