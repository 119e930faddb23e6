#include "process/self.hpp"

#include <mullion/sdk/error.hpp>

#include <filesystem>

namespace mullion::process {

std::string host_executable()
{
  namespace fs = std::filesystem;
  const auto bin = fs::read_symlink("/proc/self/exe").parent_path();
  std::string tried;
  for (const char* relative : {"../" MULLION_LIBDIR "/mullion/mullion-host", "../lib/mullion/mullion-host"}) {
    const auto path = (bin / relative).lexically_normal();
    if (fs::exists(path)) return path;
    tried += (tried.empty() ? "" : ", ") + path.string();
  }
  throw Error(Errc::process, fmt::format("this installation has no host program; tried {}", tried));
}

} // namespace mullion::process
