#include "faults.hpp"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

namespace mullion::test {
namespace {

struct SomethingForeign {};

char* find_mapping(const std::function<bool(std::uintptr_t begin, std::uintptr_t end, const std::string& name)>& is_it)
{
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    std::string rights, offset, device, inode, name;
    words >> std::hex >> begin >> dash >> end >> rights >> offset >> device >> inode;
    std::getline(words, name);
    if (is_it(begin, end, name)) return reinterpret_cast<char*>(begin); // NOLINT: that is what the file says
  }
  return nullptr;
}

} // namespace

void throw_foreign() { throw SomethingForeign{}; }

void segfault()
{
  volatile std::uintptr_t nowhere = 64; // not null: the compiler and the sanitizers have their own idea about that
  *reinterpret_cast<volatile int*>(nowhere) = 1;
}

void hang()
{
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

void dawdle(double seconds)
{
  for (int i = 0; i < static_cast<int>(seconds * 100); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

void print_two_megabytes()
{
  for (int i = 0; i < 16384; ++i) {
    std::printf("stdout line %05d of a megabyte, which nobody asked this for...\n", i);
    std::fprintf(stderr, "stderr line %05d of a megabyte, which nobody asked this for...\n", i);
  }
}

char* mapping_of(const void* address)
{
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  return find_mapping([&](auto begin, auto end, const auto&) { return begin <= at && at < end; });
}

char* mapping_named(const std::string& part)
{
  return find_mapping([&](auto, auto, const auto& name) { return name.find(part) != std::string::npos; });
}

} // namespace mullion::test
