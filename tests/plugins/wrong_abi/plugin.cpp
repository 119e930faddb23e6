// A module of a plug-in ABI that never was: refused before anything in it is called.
#include <mullion/sdk/abi.h>

namespace {
const void* entry() { return nullptr; }
} // namespace

extern "C" __attribute__((visibility("default"))) const mullion_header mullion_plugin;
extern "C" constexpr mullion_header mullion_plugin = {
    MULLION_MAGIC, 999, sizeof(mullion_header), "fluid", "wrong_abi", "0.1.0", "", nullptr, &entry};
