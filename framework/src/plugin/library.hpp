// One plug-in library: opened RTLD_LOCAL | RTLD_NOW and checked (magic, ABI, kind, name, build id) before
// anything in it is called. Libraries stay open until the process ends: code that ran once may be on a stack.
#pragma once

#include <mullion/sdk/abi.h>

#include <span>
#include <string>

namespace mullion {
struct DriverPlugin;
}

namespace mullion::plugin {

class Library {
public:
  /// Open and check the header; runs no entry of the plug-in.
  /// @throws Error Errc::plugin: no such file, not a plug-in, another ABI, another build's driver
  explicit Library(const std::string& path);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const mullion_header& header() const { return *header_; }
  [[nodiscard]] bool is_driver() const { return std::string_view(header_->kind) == "driver"; }

  /// The entries of a module / a driver. @pre is_driver() is false / true
  [[nodiscard]] const mullion_module& module() const;
  [[nodiscard]] const DriverPlugin& driver() const;

  [[nodiscard]] std::span<const mullion_parameter_spec> parameters() const;

private:
  std::string path_;
  const mullion_header* header_ = nullptr;
};

} // namespace mullion::plugin
