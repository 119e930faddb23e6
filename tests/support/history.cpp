#include "support/history.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace mullion::test {

History read_history(const std::filesystem::path& file)
{
  std::ifstream in(file);
  std::string line, cell;
  if (!std::getline(in, line)) throw std::runtime_error("no history in " + file.string());
  std::vector<std::string> names;
  for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
  std::vector<std::vector<double>> columns(names.size());
  while (std::getline(in, line)) {
    const char* at = line.c_str();
    for (std::size_t column = 0; column < names.size(); ++column) {
      char* end = nullptr;
      columns[column].push_back(std::strtod(at, &end));
      const char expected = column + 1 < names.size() ? ',' : '\0';
      if (end == at || *end != expected) throw std::runtime_error("bad line in " + file.string() + ": " + line);
      at = end + 1;
    }
  }
  History history;
  for (std::size_t column = 0; column < names.size(); ++column) history[names[column]] = std::move(columns[column]);
  return history;
}

} // namespace mullion::test
