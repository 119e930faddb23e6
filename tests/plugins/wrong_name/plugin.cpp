// A library that calls itself otherwise than its file.
#include <mullion/sdk/abi.h>

namespace {
const void* entry() { return nullptr; }
} // namespace

extern "C" __attribute__((visibility("default"))) const mullion_header mullion_plugin;
extern "C" constexpr mullion_header mullion_plugin = {
    MULLION_MAGIC, MULLION_ABI, sizeof(mullion_header), "fluid", "another_name", "0.1.0", "", nullptr, &entry};
