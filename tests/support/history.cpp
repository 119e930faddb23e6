#include "support/history.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace mullion::test {

History read_history(const std::filesystem::path& file)
{
  std::ifstream in(file);
  std::string line, cell;
  if (!std::getline(in, line)) throw std::runtime_error("no history in " + file.string());
  std::vector<std::string> names;
  for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
  History history;
  while (std::getline(in, line)) {
    std::size_t column = 0;
    for (std::istringstream row(line); std::getline(row, cell, ','); ++column) {
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      if (column >= names.size() || *end != '\0') throw std::runtime_error("bad line in " + file.string() + ": " + line);
      history[names[column]].push_back(value);
    }
    if (column != names.size()) throw std::runtime_error("short line in " + file.string() + ": " + line);
  }
  return history;
}

} // namespace mullion::test
