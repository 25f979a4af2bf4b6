#!/bin/bash
# Proves that the judge shares nothing with what it judges: its sources include none of it, what its
# library misses is all in the libraries below it, and a program that links it alone runs.
#
#   check_alone_test.sh SOURCE_FOLDER PROGRAM CHECK_LIBRARY LIBRARY_BELOW…

set -euo pipefail
source=$1 program=$2 check=$3
shift 3

fail() {
  echo "FAILED: $*"
  exit 1
}

! grep -rnE '#include <locograph/(core|solvers|types|plugins|planners|apps)/' \
  "$source"/{check,world,robots,common} --include='*.h' --include='*.cpp' ||
  fail "the judge includes what it judges"

# Undefined symbols of our own, less those that the judge or a library below it defines.
ours() { nm -C "$@" 2>/dev/null | sed -n "s/^[0-9a-f ]* $kind \(.*locograph::.*\)/\1/p" | sort -u; }
missing=$(comm -23 <(kind='U' ours "$check") <(kind='[TtWVBDRu]' ours "$check" "$@"))
[ -z "$missing" ] || fail "the judge needs: $missing"

! nm -C "$program" | grep -qE 'locograph::(Graph|Problem|Optimiser|Edge[A-Z])' ||
  fail "the program holds a graph or an edge"
model=$source/robots/models/coman_plus/coman_plus
"$program" "$model.urdf" "$model.srdf" | grep -q '^stance ' || fail "the program does not judge"
