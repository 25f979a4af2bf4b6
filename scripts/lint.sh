#!/bin/bash
# Runs clang-tidy (rules: .clang-tidy) on the files given, or on every source file.

. "$(dirname "$0")/setup.sh"

install_missing clang-tidy
# A folder of its own: clang cannot read the precompiled headers of GCC.
configure build-lint -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
  -DLOCOGRAPH_BENCHMARKS=ON
if [ $# -gt 0 ]; then
  realpath "$@"
else
  sed -n 's/^ *"file": "\(.*\)",\?$/\1/p' "$root/build-lint/compile_commands.json"
fi | xargs -P "$jobs" -n 1 clang-tidy --quiet -p "$root/build-lint"
