// What a checkpoint costs. For the run: building the image of the file in memory, which is all that it waits for,
// beside one copy of the same bytes to new memory. For the writer's thread, while the run goes on: checksum, write and
// sync, beside a plain write and sync of the same bytes. And for a restart: reading it back. One window with two slots,
// from 1 MB to 1 GB of committed values; medians.
//
//   build-dev/bench/checkpoint [--folder DIR] [--rounds R] [--largest MB]
#include "io/checkpoint.hpp"

#include "mullion_run.hpp"

#include <cstring>

namespace {

namespace fs = std::filesystem;
using namespace mullion;
using bench::milliseconds;

void measure(std::size_t megabytes, int rounds, const fs::path& folder)
{
  io::Bytes values(megabytes * 1'000'000), copy;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::byte>(i * 2654435761u >> 13);
  io::Checkpoint checkpoint;
  checkpoint.plugins = {{"driver", "driver", "css", "0.1.0", ""}};
  checkpoint.outputs.texts = {""};
  checkpoint.windows = {{"fluid/volume", "fluid", 2, 0, {}, {values.data(), 4096}, {values}}};
  std::vector<double> copies, images, plain, atomic, reads;
  for (int round = 0; round < rounds; ++round) {
    io::Image image;
    copies.push_back(milliseconds([&] { io::Bytes(values).swap(copy); })); // into memory that is new, as an image is
    images.push_back(milliseconds([&] { image = io::to_image(checkpoint); }));
    plain.push_back(milliseconds([&] { bench::write_plainly(folder / "plain", image); }));
    atomic.push_back(milliseconds([&] { write_atomically(folder / "checkpoint.h5", image, io::Trailer::checksum); }));
    image = {};
    reads.push_back(milliseconds([&] { (void)io::read_checkpoint(folder / "checkpoint.h5"); }));
  }
  const auto row = [](std::vector<double> times) { return bench::median(std::move(times)); };
  fmt::print("| {} MB | {:.2f} ms | {:.2f} ms | {:.1f} | {:.1f} ms | {:.1f} ms | {:.2f} | {:.1f} ms |\n", megabytes,
             row(copies), row(images), row(images) / row(copies), row(plain), row(atomic), row(atomic) / row(plain),
             row(reads));
}

} // namespace

int main(int argc, char** argv)
{
  fs::path base = fs::temp_directory_path();
  int rounds = 5;
  std::size_t largest = 1000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--folder") == 0) base = argv[i + 1];
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--largest") == 0) largest = static_cast<std::size_t>(std::atol(argv[i + 1]));
  }
  const auto folder = base / fmt::format("mullion-checkpoint-{}", ::getpid());
  fs::create_directories(folder);
  fmt::print("| values | a copy | the run waits | / copy | plain write | written | / plain | read |\n"
             "|---|---|---|---|---|---|---|---|\n");
  for (std::size_t megabytes = 1; megabytes <= largest; megabytes *= 10) measure(megabytes, rounds, folder);
  fs::remove_all(folder);
  return 0;
}
