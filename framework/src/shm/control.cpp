#include "shm/control.hpp"

#include <mullion/sdk/error.hpp>

#include <cstring>

namespace mullion::shm {

const Control& checked_control(const std::byte* object, std::uint64_t bytes)
{
  const auto& control = *reinterpret_cast<const Control*>(object);
  MULLION_REQUIRE(bytes >= sizeof(Control) && control.magic == control_magic && control.version == layout_version &&
                      control.bytes == sizeof(Control),
                  Errc::memory, "the control object is damaged or of another Mullion version ({} bytes, expected {})",
                  bytes, sizeof(Control));
  return control;
}

void forget_windows_and_modules(Control& control)
{
  for (auto& module : control.modules) {
    module.n_parameters = module.n_exchanged = module.n_histories = 0;
    module.interface_window[0] = '\0';
  }
  for (auto& window : control.windows) window = {};
  for (auto& working : control.working) working = {};
  control.n_modules = control.n_windows = 0;
  control.current.module = no_module;
}

void copy_text(char* to, std::size_t capacity, std::string_view text, std::string_view what)
{
  MULLION_REQUIRE(text.size() < capacity, Errc::config, "the {} '{}' is longer than {} characters", what, text,
                  capacity - 1);
  std::memset(to, 0, capacity);
  std::memcpy(to, text.data(), text.size());
}

const char* to_string(Operation operation)
{
  constexpr const char* names[] = {"none", "create", "define", "attach", "start",  "seal",
                                   "step", "call",   "quit",   "park",   "resume", "attach"};
  const auto i = static_cast<std::uint32_t>(operation);
  return i < std::size(names) ? names[i] : "an unknown call";
}

} // namespace mullion::shm
