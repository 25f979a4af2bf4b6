#!/bin/bash
# The main job, from nothing: COMAN+ stands up, and CENTAURO drives four metres and past a box that
# it did not know of.
#
# Installs what is missing, builds Release into build/ what the job, the viewer's page and
# `cmake --install build` need, and leaves plans, map, pages and pictures in build/demo/.

. "$(dirname "$0")/setup.sh"

install_missing
configure build
build build --target locograph make_map locograph_viewer

out=$root/build/demo
"$root/scripts/demo_job.sh" "$root/build/bin" "$out"

say "done:
   $out/standing_up.html   COMAN+ stands up: open it in a browser
   $out/standing_up.png    a picture of it
   $out/refined.html       CENTAURO past the box
   $out/refined.png        a picture of it
   Look closer: build/bin/locograph check $out/standing_up.g2o --all"
