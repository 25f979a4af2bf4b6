#!/bin/bash
# Lays out the sources with clang-format; with --check only tells which files are not laid out.

set -euo pipefail
cd "$(dirname "$0")/.."

files() { find . \( -path './build*' -o -path './.*' \) -prune -o -name '*.h' -print -o -name '*.cpp' -print; }

if [ "${1:-}" = --check ]; then
  files | xargs -r clang-format --dry-run --Werror
else
  files | xargs -r clang-format -i
fi
