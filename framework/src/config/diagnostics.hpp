// The mistakes of a case, collected while it is read and handed out in the order of the file, those of the
// command line behind them.
#pragma once

#include "config/toml_document.hpp"

#include <mullion/app/case_file.hpp>

#include <string>
#include <utility>
#include <vector>

namespace mullion::config {

class Diagnostics {
public:
  void add(const Place& place, std::string message) { found_.emplace_back(place, std::move(message)); }
  [[nodiscard]] std::size_t size() const { return found_.size(); }
  [[nodiscard]] bool empty() const { return found_.empty(); }

  /// All of them, each place as "piston.toml:12:3" or as the flag.
  [[nodiscard]] std::vector<Diagnostic> sorted(const std::string& file) const;

private:
  std::vector<std::pair<Place, std::string>> found_;
};

} // namespace mullion::config
