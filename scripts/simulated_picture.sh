#!/bin/bash
# A looping picture of a plan as it is simulated, for doc/execution.md.
#
#     scripts/simulated_picture.sh PLAN.g2o OUT.gif [FRAMES]
#
# Wants ImageMagick (Debian's imagemagick) and what `locograph view --png` wants.
set -euo pipefail
plan=$1 out=$2 frames=${3:-24}
locograph=${LOCOGRAPH:-$(dirname "$0")/../build/bin/locograph}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$locograph" simulate "$plan" -o "$folder/record.g2o" --json --quiet > "$folder/run.json"
seconds=$(sed -n 's/.*"time_s": \([0-9.]*\).*/\1/p' "$folder/run.json" | head -1)
for ((i = 0; i < frames; ++i)); do
  at=$(awk -v t="$seconds" -v i="$i" -v n="$frames" 'BEGIN { printf "%.3f", 0.995 * t * i / (n - 1) }')
  "$locograph" view "$folder/record.g2o" -o "$folder/page.html" --no-check --quiet \
    --png "$folder/$(printf 'frame_%03d' "$i").png" --at "$at"
done
convert -delay 25 -loop 0 "$folder"/frame_*.png -resize 360x -colors 48 +dither \
  -layers optimize "$out"
