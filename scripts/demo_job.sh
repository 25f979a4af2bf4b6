#!/bin/bash
# What the demo shows, with a locograph that is built: COMAN+ stands up, and CENTAURO drives four
# metres and past a box that its plan did not know of.
#
#   scripts/demo_job.sh FOLDER_OF_PROGRAMS OUTPUT_FOLDER
#
# Each plan is judged, and drawn; the table at the end goes to standard output.

set -euo pipefail
export LC_ALL=C
bin=$1 out=$2
say() { printf '== %s\n' "$*" >&2; }
die() {
  printf 'demo: %s\n' "$*" >&2
  exit 1
}

# number KEY FILE: the first one of that name in a JSON file.
number() { sed -n "/\"$1\": *[0-9]/{s/.*\"$1\": *\\([0-9.e+-]*\\).*/\\1/p;q}" "$2"; }

# judge NAME [options…]: NAME.g2o, leaves NAME_check.json.
judge() {
  local name=$1
  shift
  "$bin/locograph" check "$out/$name.g2o" "$@"
  "$bin/locograph" check "$out/$name.g2o" "$@" --json >"$out/${name}_check.json"
}

# draw NAME TIME: a page, and a picture of it at that time.
draw() {
  "$bin/locograph" view "$out/$1.g2o" -o "$out/$1.html" --png "$out/$1.png" --at "$2"
}

row() { printf '%-34s %18s %10s %15s  %s\n' "$@"; }

mkdir -p "$out"
rm -f "$out"/*

say "planning how COMAN+ stands up: stances, motion, timing"
"$bin/locograph" plan standing_up -o "$out/standing_up.g2o" --json >"$out/standing_up.json" ||
  die "there is no plan: $(cat "$out/standing_up.json")"
judge standing_up || die "the plan to stand up is not feasible"
standing_s=$(number duration_s "$out/standing_up.json")
draw standing_up "$(awk "BEGIN { print 0.6 * $standing_s }")"

say "planning the drive in an empty world"
"$bin/locograph" plan centauro_drive -o "$out/plan.g2o" --json >"$out/plan.json"
judge plan || die "the plan is not feasible in its own world"

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
"$bin/locograph" refine "$out/plan.g2o" --map "$out/box.bt" -o "$out/refined.g2o" --json \
  >"$out/refined.json"
judge refined --map "$out/box.bt" || die "the refined plan is not feasible"
draw refined 20

# seconds KEY FILE, milliseconds KEY FILE
seconds() { printf '%.2f s' "$(number "$1" "$2")"; }
milliseconds() { awk "BEGIN { printf \"%.1f ms a cycle\", 1e3 * $(number "$1" "$2") }"; }
configurations() { number configurations "$out/$1_check.json"; }

echo
row "" "computed in" "motion" "configurations" "judged"
row "COMAN+ stands up" "$(seconds total "$out/standing_up.json")" \
  "$(seconds duration_s "$out/standing_up.json")" "$(configurations standing_up)" feasible
row "CENTAURO drives 4 m" "$(seconds total "$out/plan.json")" \
  "$(seconds duration_s "$out/plan.json")" "$(configurations plan)" feasible
row "the same past a box, refined" "$(milliseconds mean "$out/refined.json")" \
  "$(seconds duration_s "$out/plan.json")" "$(configurations refined)" feasible
