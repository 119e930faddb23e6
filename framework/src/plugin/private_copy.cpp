#include "plugin/private_copy.hpp"

#include <mullion/sdk/error.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <unistd.h>

namespace mullion::plugin {

const Library& PrivateCopies::open(const std::string& file)
{
  std::ifstream in(file, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  MULLION_REQUIRE(in.good() || in.eof(), Errc::plugin, "plug-in {}: {}", file, std::strerror(errno));
  MULLION_REQUIRE(!bytes.empty(), Errc::plugin, "plug-in {}: there is no such file, or it is empty", file);
  for (const auto& copy : copies_)
    if (copy.bytes.bytes == bytes.size() && std::memcmp(copy.bytes.data, bytes.data(), bytes.size()) == 0)
      return checked(copy);

  auto& copy = copies_.emplace_back();
  const auto name = std::filesystem::path(file).stem().string();
  copy.object = shm::create_object("plugin:" + name, bytes.size());
  {
    const auto writable = shm::map_object(::getpid(), copy.object.get(), shm::Access::read_write);
    std::memcpy(writable.data, bytes.data(), bytes.size());
  }
  copy.bytes = shm::map_object(::getpid(), copy.object.get(), shm::Access::read_only);
  const auto path = fmt::format("/proc/{}/fd/{}", ::getpid(), copy.object.get());
  try {
    copy.library = std::make_unique<Library>(path);
  } catch (const Error& error) {
    std::string text = error.what();
    for (auto at = text.find(path); at != std::string::npos; at = text.find(path, at + file.size()))
      text.replace(at, path.size(), file);
    copy.refusal = text;
  }
  return checked(copy);
}

const Library& PrivateCopies::checked(const Copy& copy)
{
  if (copy.library == nullptr) throw Error(Errc::plugin, copy.refusal);
  return *copy.library;
}

} // namespace mullion::plugin
