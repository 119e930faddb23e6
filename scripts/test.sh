#!/usr/bin/env bash
# Install what is missing, build, and test.
#
#   scripts/test.sh          the short tier: every kind of test
#   scripts/test.sh --full   also every repetition, and the suite under the sanitizers (address + undefined, there with the
#                            mutated checkpoints, windows and cases of the full unit tests; thread);
#                            the outcome is written to docs/results/full_tier.md
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
tier=${1:-short}
case $tier in
  short | --full) ;;
  *) echo "usage: scripts/test.sh [--full]" >&2; exit 2 ;;
esac

"$root/scripts/install_packages.sh"

# build_and_test NAME CTEST-ARGUMENTS… -- CMAKE-ARGUMENTS…
build_and_test() {
  local name=$1 build=$root/build-$1 ctest_arguments=()
  shift
  while [[ $1 != -- ]]; do ctest_arguments+=("$1"); shift; done
  shift
  cmake -S "$root" -B "$build" -G Ninja -DMULLION_TESTS=ON "$@" >/dev/null
  cmake --build "$build"
  ctest --test-dir "$build" --output-on-failure "${ctest_arguments[@]}"
}

if [[ $tier == short ]]; then
  build_and_test test -L short -- -DCMAKE_BUILD_TYPE=Release
  exit
fi

failed=0
record=$root/docs/results/full_tier.md
mkdir -p "$root/docs/results"
run() { # run TITLE build_and_test-arguments…
  local title=$1 log
  shift
  log=$(mktemp)
  if build_and_test "$@" 2>&1 | tee "$log"; then verdict=passed; else verdict=FAILED; failed=1; fi
  { echo "## $title: $verdict"; echo; echo '```'; grep -E '^ *[0-9]+/[0-9]+ Test|tests passed|Total Test time' "$log"; echo '```'; echo; } >>"$record"
  rm -f "$log"
}
{
  echo "# Outcome of scripts/test.sh --full"
  echo
  echo "Made by that command on $(date -u +%Y-%m-%d), commit $(git -C "$root" rev-parse --short HEAD 2>/dev/null || echo unknown), $(nproc) cores."
  echo
} >"$record"
run "Release, short and full" test -C Full -- -DCMAKE_BUILD_TYPE=Release
run "Address and undefined-behaviour sanitizer" asan -C Full -L "short|unit" -- -DCMAKE_BUILD_TYPE=RelWithDebInfo "-DMULLION_SANITIZE=address;undefined"
run "Thread sanitizer" tsan -L short -- -DCMAKE_BUILD_TYPE=RelWithDebInfo -DMULLION_SANITIZE=thread
exit $failed
