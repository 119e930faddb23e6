#include "shm/memory_object.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <csignal>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace mullion;
using namespace mullion::shm;

TEST_CASE("an object is shared: what the writer writes the reader sees")
{
  const auto object = create_object("test", 8192);
  const auto writer = map_object(::getpid(), object.get(), Access::read_write);
  const auto reader = map_object(::getpid(), object.get(), Access::read_only);

  writer.data[5000] = std::byte{42};

  CHECK(reader.bytes == 8192);
  CHECK(reader.data[5000] == std::byte{42});
  CHECK(reader.data != writer.data);
}

TEST_CASE("the kernel refuses to turn a read-only mapping into a writable one")
{
  const auto object = create_object("test", 4096);
  const auto reader = map_object(::getpid(), object.get(), Access::read_only);

  CHECK(::mprotect(reader.data, 4096, PROT_READ | PROT_WRITE) != 0);
}

TEST_CASE("a write through a read-only mapping kills the offender and leaves the data whole")
{
  const auto object = create_object("test", 4096);
  const auto writer = map_object(::getpid(), object.get(), Access::read_write);
  const auto reader = map_object(::getpid(), object.get(), Access::read_only);
  writer.data[0] = std::byte{1};

  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGSEGV, SIG_DFL);
    const_cast<volatile std::byte&>(reader.data[0]) = std::byte{2};
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);

  CHECK(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGSEGV);
  CHECK(writer.data[0] == std::byte{1});
}

TEST_CASE("an object can be neither shrunk nor grown")
{
  const auto object = create_object("test", 8192);

  CHECK(::ftruncate(object.get(), 4096) != 0);
  CHECK(::ftruncate(object.get(), 16384) != 0);
}

TEST_CASE("an object lives on when another process adopted it, and its maker may die")
{
  int ready[2], done[2];
  REQUIRE(::pipe(ready) == 0);
  REQUIRE(::pipe(done) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto object = create_object("test", 4096);
    map_object(::getpid(), object.get(), Access::read_write).data[7] = std::byte{9};
    const int fd = object.get();
    (void)!::write(ready[1], &fd, sizeof fd);
    char go = 0;
    (void)!::read(done[0], &go, 1);
    ::_exit(0);
  }
  int fd = -1;
  REQUIRE(::read(ready[0], &fd, sizeof fd) == sizeof fd);

  const auto adopted = adopt_object(child, fd);
  (void)!::write(done[1], "x", 1);
  ::waitpid(child, nullptr, 0);

  CHECK(map_object(::getpid(), adopted.get(), Access::read_only).data[7] == std::byte{9});
  for (const int end : {ready[0], ready[1], done[0], done[1]}) ::close(end);
}

TEST_CASE("more memory than the machine has is refused before anything is allocated")
{
  const auto before = available_memory();

  std::string message;
  try {
    (void)create_object("fluid/volume", UINT64_C(1) << 50);
  } catch (const Error& error) {
    message = error.what();
  }

  CHECK(message.find("too little memory for 'fluid/volume': it needs 1.0 PiB") != std::string::npos);
  CHECK(available_memory() > before / 2);
}

TEST_CASE("sizes are printed for people")
{
  CHECK(human_bytes(512) == "512 bytes");
  CHECK(human_bytes(1536) == "1.5 KiB");
  CHECK(human_bytes(UINT64_C(3) << 30) == "3.0 GiB");
}
