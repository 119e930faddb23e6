// `mullion check` against cases that are wrong on purpose: the whole of standard error, word for word. Each file of
// broken_cases/ says at its top what is expected (support/broken_file.hpp).
#include "support/broken_file.hpp"

#include <doctest/doctest.h>

using namespace mullion;

TEST_CASE("every broken case is refused with all of its mistakes, each at its place")
{
  test::check_broken_files(MULLION_SOURCE_DIR "/tests/cli/broken_cases", "check", 109);
}
