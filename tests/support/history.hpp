// history.csv as a test reads it: columns of doubles by name.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace mullion::test {

using History = std::map<std::string, std::vector<double>>;

/// @throws std::runtime_error if the file is missing, ragged or holds something that is no number
History read_history(const std::filesystem::path& file);

} // namespace mullion::test
