#!/bin/bash
# The main job, from nothing: CENTAURO drives four metres, and past a box that it did not know of.
#
# Installs what is missing, builds Release into build/, and leaves plans and map in build/demo/.

. "$(dirname "$0")/setup.sh"

install_missing
configure build
build build --target locograph make_map

locograph=$root/build/bin/locograph
out=$root/build/demo
mkdir -p "$out"
rm -f "$out"/*

say "planning the drive in an empty world"
"$locograph" plan centauro_drive -o "$out/plan.g2o"
"$locograph" check "$out/plan.g2o" || die "the plan is not feasible in its own world"

say "a box appears on the path"
cat >"$out/box.xml" <<'XML'
<obstacles version="1">
  <box name="box" center="2 0 0.25" size="0.5 0.5 0.5"/>
</obstacles>
XML
"$root/build/bin/make_map" "$out/box.xml" 0.05 "$out/box.bt"
status=0
"$locograph" check "$out/plan.g2o" --map "$out/box.bt" || status=$?
[ "$status" -eq 1 ] || die "the plan should collide with the box (exit code 1, not $status)"

say "refining the plan against the map, one cycle per step"
"$locograph" refine "$out/plan.g2o" --map "$out/box.bt" -o "$out/refined.g2o"
"$locograph" check "$out/refined.g2o" --map "$out/box.bt" ||
  die "the refined plan is not feasible"

say "done. In $out:
   plan.g2o     the plan for the empty world
   box.bt       the map with the box (made from box.xml)
   refined.g2o  the plan past the box
   Look closer: build/bin/locograph check $out/refined.g2o --map $out/box.bt --json"
