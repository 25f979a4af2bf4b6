#!/bin/bash
# The main job, from nothing: CENTAURO drives four metres, and past a box that it did not know of.
#
# Installs what is missing, builds Release into build/ what the job, the viewer's page and
# `cmake --install build` need, and leaves plans, map, page and picture in build/demo/.

. "$(dirname "$0")/setup.sh"

install_missing
configure build
build build --target locograph make_map locograph_viewer

out=$root/build/demo
"$root/scripts/demo_job.sh" "$root/build/bin" "$out"

say "done. In $out:
   plan.g2o      the plan for the empty world
   box.bt        the map with the box (made from box.xml)
   refined.g2o   the plan past the box
   refined.html  the same to look at: open it in a browser
   refined.png   a picture of it
   Look closer: build/bin/locograph check $out/refined.g2o --map $out/box.bt --json"
