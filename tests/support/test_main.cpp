// The only main of the test programs. Long runs live in the doctest suite "full"
// (--test-suite-exclude=full skips them).
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
