// A library as it may lie in any folder: it has no plug-in symbol.
extern "C" __attribute__((visibility("default"))) int not_a_plugin() { return 1; }
