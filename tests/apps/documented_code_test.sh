#!/bin/bash
# Code blocks of doc/custom_types.md, doc/custom_constraints.md and doc/tutorial.md are code of the
# examples, which are built and run by other tests: each block stands, line by line, in one of their
# files.
#
#   documented_code_test.sh SOURCE_FOLDER

set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

awk -v folder="$work" '
  /^```(cpp|cmake|xml)$/ { inside = 1; file = folder "/" ++count; next }
  /^```$/ { inside = 0; next }
  inside { print > file }
' "$source"/doc/{custom_types,custom_constraints,tutorial}.md

blocks=0
for block in "$work"/*; do
  blocks=$((blocks + 1))
  found=
  for example in "$source"/examples/{custom_edge,plugin,custom_constraint}/{*.cpp,CMakeLists.txt} \
    "$source"/examples/tutorial/*; do
    text=$(<"$example")
    [[ $text == *"$(<"$block")"* ]] && found=yes
  done
  if [ -z "$found" ]; then
    echo "FAILED: no example holds this code of the documentation:"
    cat "$block"
    exit 1
  fi
done
[ "$blocks" -ge 22 ] || { echo "FAILED: only $blocks code blocks found"; exit 1; }
echo "$blocks code blocks found in the examples"
