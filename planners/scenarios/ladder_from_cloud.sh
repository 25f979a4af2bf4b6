#!/bin/bash
# Writes ladder_from_cloud.pcd, what a scanner would see of a floor and a ladder of round bars:
# `planners/scenarios/ladder_from_cloud.sh`. Points have 3 mm of noise, the same in every run.
#
# Bars have the heights and distances of the scenario ladder_climbing, radius 0.02 m.

set -euo pipefail
cd "$(dirname "$0")"

points() {
  awk 'BEGIN {
    state = 1
    pi = atan2(0, -1)
    for (x = 0.2125; x < 1.41; x += 0.025)
      for (y = -0.5; y < 0.501; y += 0.025) point(x, y, 0)
    for (rung = 0; rung < 8; ++rung)
      for (y = -0.45; y < 0.451; y += 0.025)
        for (side = 0; side < 8; ++side) {
          turn = (side + 0.5 * (int(y / 0.025 + 50) % 2)) * pi / 4
          point(1 + 0.1 * rung + 0.02 * cos(turn), y, 0.2 + 0.2 * rung + 0.02 * sin(turn))
        }
  }
  function random() { state = state * 16807 % 2147483647; return state / 2147483647 }  # Park, Miller
  function noise() { return 0.006 * (random() + random() + random() - 1.5) }
  function point(x, y, z) { printf "%.3f %.3f %.3f\n", x + noise(), y + noise(), z + noise() }'
}

all=$(points)
count=$(wc -l <<<"$all")
cat >ladder_from_cloud.pcd <<END
# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH $count
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS $count
DATA ascii
$all
END
