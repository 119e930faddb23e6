#!/usr/bin/env bash
# Install what is missing, build, and run a case: scripts/run.sh [CASE] [options of mullion run]
# Without a case: configs/closed_piston.toml, the elastic piston with four modules in four processes.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=${MULLION_BUILD_DIR:-$root/build}

"$root/scripts/install_packages.sh"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DMULLION_TESTS="${MULLION_TESTS:-OFF}" >/dev/null
cmake --build "$build"

if (($# == 0)); then
  set -- "$root/configs/closed_piston.toml"
fi
exec "$build/bin/mullion" run "$@"
