#include "plugin/library.hpp"

#include <mullion/coupling/driver_plugin.hpp>
#include <mullion/sdk/error.hpp>

#include <dlfcn.h>

#include <string_view>

namespace mullion::plugin {

const char* driver_build_id(); // build_id.cpp

Library::Library(const std::string& path) : path_(path)
{
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw Error(Errc::plugin, fmt::format("plug-in {}: {}", path, dlerror()));
  const auto* header = static_cast<const mullion_header*>(dlsym(handle, MULLION_PLUGIN_SYMBOL));
  MULLION_REQUIRE(header != nullptr && header->magic == MULLION_MAGIC, Errc::plugin,
                  "plug-in {}: not a Mullion plug-in (it exports no '{}' with the right magic number); end the "
                  "library with MULLION_PLUGIN(...) or MULLION_DRIVER(...)",
                  path, MULLION_PLUGIN_SYMBOL);
  MULLION_REQUIRE(header->abi == MULLION_ABI && header->bytes == sizeof(mullion_header), Errc::plugin,
                  "plug-in {}: built for plug-in ABI {}, this mullion has ABI {}; build it again with this "
                  "version's headers",
                  path, header->abi, MULLION_ABI);
  header_ = header;
  if (!is_driver()) return;
  const std::string_view build = header->build == nullptr ? "none" : header->build;
  MULLION_REQUIRE(build == driver_build_id(), Errc::plugin,
                  "driver {}: compiled against another build of libmullion (its build id is {}, this one's is {}); "
                  "drivers share C++ types with libmullion: build it again",
                  path, build, driver_build_id());
}

const mullion_module& Library::module() const
{
  MULLION_ASSERT(!is_driver(), "{} is a driver", path_);
  return *static_cast<const mullion_module*>(header_->entry());
}

const DriverPlugin& Library::driver() const
{
  MULLION_ASSERT(is_driver(), "{} is a module", path_);
  return *static_cast<const DriverPlugin*>(header_->entry());
}

std::span<const mullion_parameter_spec> Library::parameters() const
{
  if (is_driver()) {
    const auto& plugin = driver();
    return {plugin.parameters, plugin.n_parameters};
  }
  return {module().parameters, module().n_parameters};
}

} // namespace mullion::plugin
