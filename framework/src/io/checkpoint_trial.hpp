// Whether a checkpoint can be read is tried out in a child process first. The checksum in the trailer tells whether a
// file is what was written; whether what was written is sound it cannot tell, and the HDF5 library crashes on some
// images, or never ends. The child does, or its time runs out, and the caller gets an error.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

namespace mullion::io {

/// Read the checkpoint in a child process, to its end. To be called before this process has threads.
/// @param patience  how long it may take; by default 30 s and a second for every 20 MB, which a slow disk gives
/// @throws Error Errc::io: what is wrong with the file, or what became of the child
void try_checkpoint(const std::filesystem::path& file, std::optional<std::chrono::milliseconds> patience = {});

} // namespace mullion::io
