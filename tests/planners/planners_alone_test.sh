#!/bin/bash
# Proves that planners share no formula with the judge: of its headers their sources include only
# those of values and of the judge itself, and of its library they need nothing else.
#
#   planners_alone_test.sh SOURCE_FOLDER CHECK_LIBRARY LIBRARY…

set -euo pipefail
source=$1 check=$2
shift 2

fail() {
  echo "FAILED: $*"
  exit 1
}

# Motions, the one curve that they define, options, reports, tolerances and tasks; and who is asked.
values='check_report|judge|limits|motion|motion_curve|plan_ends'
! grep -rnE '#include [<"]([^>"]*/)?check/' "$source"/{planners,plugins} --include='*.h' \
  --include='*.cpp' | grep -vE "#include <locograph/check/($values)\.h>" ||
  fail "planners include formulas of the judge"

# Functions that the judge defines and a library of planners needs; signatures left out.
ours() { nm -C "$@" 2>/dev/null | sed -nE "s/^[0-9a-f ]* $kind (locograph::[^([]*).*/\1/p" | sort -u; }
asked='Judge::.*|CheckReport::.*|CheckOptions::validate|violation_text|plan_ends|end_violations'
asked+='|MotionCurve::.*|CurveStep::.*|part_of'
for library; do
  needed=$(comm -12 <(kind='U' ours "$library") <(kind='[TtWVu]' ours "$check"))
  formulas=$(grep -vE "^locograph::($asked)$" <<<"$needed" || true)
  [ -z "$formulas" ] || fail "$library needs of the judge: $formulas"
done
