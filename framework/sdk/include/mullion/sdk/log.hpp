// Logging from a module: one line a call, which Mullion prints with the module's name. Modules never print.
#pragma once

#include <mullion/sdk/abi.h>
#include <mullion/sdk/window.hpp>

#include <fmt/format.h>

#include <utility>

namespace mullion {

class Log {
public:
  explicit Log(const Services* services) : services_(services) {}

  template <class... T> void debug(fmt::format_string<T...> text, T&&... values) const
  {
    write(MULLION_DEBUG, fmt::format(text, std::forward<T>(values)...));
  }
  template <class... T> void info(fmt::format_string<T...> text, T&&... values) const
  {
    write(MULLION_INFO, fmt::format(text, std::forward<T>(values)...));
  }
  template <class... T> void warning(fmt::format_string<T...> text, T&&... values) const
  {
    write(MULLION_WARNING, fmt::format(text, std::forward<T>(values)...));
  }
  template <class... T> void error(fmt::format_string<T...> text, T&&... values) const
  {
    write(MULLION_ERROR, fmt::format(text, std::forward<T>(values)...));
  }

private:
  void write(std::uint32_t level, const std::string& text) const
  {
    services_->raw()->log(services_->context(), level, text.c_str());
  }
  const Services* services_;
};

} // namespace mullion
