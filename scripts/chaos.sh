#!/usr/bin/env bash
# A run that is disturbed for a long time: hosts killed, stopped, swapped, set and looked at, at random moments.
#
#   scripts/chaos.sh [EVENTS [SEED]]    default: 10000 events, a seed of its own, which is printed
#
# It fails if a byte of the results differs from an undisturbed run's, or a process is left.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
events=${1:-10000}

"$root/scripts/install_packages.sh"
cmake -S "$root" -B "$root/build-test" -G Ninja -DMULLION_TESTS=ON -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$root/build-test" --target process_tests all
export MULLION_CHAOS_EVENTS=$events
if [[ $# -ge 2 ]]; then export MULLION_CHAOS_SEED=$2; fi
exec "$root/build-test/bin/process_tests" --test-suite=full --test-case='*change no byte'
