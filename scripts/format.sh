#!/bin/bash
# Lays out the sources with clang-format; with --check only tells which files are not laid out, and
# which cast by int(x).

set -euo pipefail
cd "$(dirname "$0")/.."

files() { find . \( -path './build*' -o -path './.*' \) -prune -o -name '*.h' -print -o -name '*.cpp' -print; }

# Lines that cast a number by the name of its type: double(x). Not in comments, not `operator int()`,
# not function types such as std::function<double(int)>. The folders left out are still to follow.
function_style_casts() {
  local type='(int|long|unsigned|char|bool|float|double|(std::)?(size_t|ptrdiff_t|u?int[0-9]+_t)|Eigen::Index)'
  files | grep -vE '^\./(planners/plan|check|tests/planners|tests/check)/' |
    xargs -r grep -nE "^([^/\"]|/[^/]|\"[^\"]*\")*(^|[^[:alnum:]_:<])$type\\(([^)*]|\$)" /dev/null |
    grep -vE "operator $type\\("
}

if [ "${1:-}" = --check ]; then
  files | xargs -r clang-format --dry-run --Werror
  if function_style_casts >&2; then
    echo "Write static_cast<int>(x), not int(x)." >&2
    exit 1
  fi
else
  files | xargs -r clang-format -i
fi
