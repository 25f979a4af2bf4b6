#!/bin/bash
# What the demo shows, with a locograph that is built: CENTAURO drives four metres, and past a box
# that its plan did not know of.
#
#   scripts/demo_job.sh FOLDER_OF_PROGRAMS OUTPUT_FOLDER

set -euo pipefail
bin=$1 out=$2
say() { printf '== %s\n' "$*" >&2; }
die() {
  printf 'demo: %s\n' "$*" >&2
  exit 1
}
mkdir -p "$out"
rm -f "$out"/*

say "planning the drive in an empty world"
"$bin/locograph" plan centauro_drive -o "$out/plan.g2o"
"$bin/locograph" check "$out/plan.g2o" || die "the plan is not feasible in its own world"

say "a box appears on the path"
cat >"$out/box.xml" <<'XML'
<obstacles version="1">
  <box name="box" center="2 0 0.25" size="0.5 0.5 0.5"/>
</obstacles>
XML
"$bin/make_map" "$out/box.xml" 0.05 "$out/box.bt"
status=0
"$bin/locograph" check "$out/plan.g2o" --map "$out/box.bt" || status=$?
[ "$status" -eq 1 ] || die "the plan should collide with the box (exit code 1, not $status)"

say "refining the plan against the map, one cycle per step"
"$bin/locograph" refine "$out/plan.g2o" --map "$out/box.bt" -o "$out/refined.g2o"
"$bin/locograph" check "$out/refined.g2o" --map "$out/box.bt" ||
  die "the refined plan is not feasible"

say "drawing the result"
"$bin/locograph" view "$out/refined.g2o" -o "$out/refined.html" --png "$out/refined.png" --at 20
