// The modules' windows as the writers of files take them: meshes, and the fields of one kind of storage.
#pragma once

#include "io/snapshot.hpp"
#include "run/session.hpp"

#include <vector>

namespace mullion::run {

/// Pointers into the windows, valid until the next commit.
/// @param storage  `fixed`: the fields that never change; `level`: those of the last committed level
std::vector<io::WindowData> snapshot_of(Session& session, shm::Storage storage);

} // namespace mullion::run
