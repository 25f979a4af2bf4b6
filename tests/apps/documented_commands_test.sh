#!/bin/bash
# Runs every command block of README.md and doc/*.md as it stands: in a folder that looks like a
# clone in which scripts/demo.sh has been run, with build/bin on the PATH, README.md first. A block is
# a fence of sh; it fails with the first command that fails. One that no test can run has a comment
# on the line above its fence, which says why:
#
#   <!-- not run by the tests: installs packages -->
#
#   documented_commands_test.sh BUILD_FOLDER SOURCE_FOLDER

set -euo pipefail
build=$1 source=$2
most_not_run=1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "FAILED: $*"
  exit 1
}

# blocks_of FILE FOLDER: each block into a file of its own, named by its line; what is not run ends
# in .not_run and holds the reason.
blocks_of() {
  awk -v folder="$2" '
    /^```sh *$/ { inside = 1; file = sprintf("%s/%05d", folder, NR)
                  if (reason != "") { print reason > (file ".not_run"); file = "/dev/null" }
                  else printf "" > file
                  next }
    /^```/      { inside = 0; reason = ""; next }
    inside      { print > file; next }
                { reason = "" }
    /^<!-- not run by the tests: .+ -->$/ { reason = $0 }
  ' "$1"
}

# run_blocks NAME FILE: in the current folder; says which block failed and what it printed.
run_blocks() {
  local name=$1 file=$2 blocks block
  blocks=$(mktemp -d "$work/blocks.XXXX")
  blocks_of "$file" "$blocks"
  for block in "$blocks"/*; do
    [ -e "$block" ] || continue
    if [[ $block == *.not_run ]]; then
      not_run=$((not_run + 1))
      continue
    fi
    run=$((run + 1))
    if ! bash -euo pipefail "$block" >"$work/log" 2>&1 </dev/null; then
      echo "line $((10#$(basename "$block"))) of $name:"
      cat "$block"
      cat "$work/log"
      return 1
    fi
  done
}

# A folder like a clone after the demo: sources and programs are links, what commands write is not.
mkdir "$work/clone" "$work/clone/build"
for entry in "$source"/*; do
  [[ $(basename "$entry") == build* ]] || ln -s "$entry" "$work/clone/"
done
for entry in bin lib share cmake_install.cmake; do ln -s "$build/$entry" "$work/clone/build/"; done
cd "$work/clone"
export PATH=$PWD/build/bin:$PATH
"$source/scripts/demo_job.sh" build/bin build/demo >"$work/log" 2>&1 || fail "the demo: $(cat "$work/log")"
for result in refined.html refined.png; do
  [ -s "build/demo/$result" ] || fail "the demo left no $result"
done

run=0 not_run=0
for file in README.md doc/*.md; do
  run_blocks "$file" "$file" || fail "a command of $file"
done
[ "$run" -ge 7 ] || fail "only $run blocks found"
[ "$not_run" -le "$most_not_run" ] || fail "$not_run blocks are not run, at most $most_not_run may be"
echo "$run blocks run, $not_run not"

# This test sees what is broken: a block that fails in its middle, and one that names no command.
printf '```sh\ntrue\nfalse\ntrue\n```\n' >"$work/broken.md"
run_blocks broken.md "$work/broken.md" >"$work/said" && fail "a broken block passed"
grep -q 'line 1 of broken.md' "$work/said" || fail "the broken block is not named"
printf '# x\n\n```sh\nlocograph optmize a.g2o\n```\n' >"$work/broken.md"
run_blocks broken.md "$work/broken.md" >"$work/said" && fail "a mistyped command passed"
grep -q "did you mean 'optimize'" "$work/said" || fail "what the command says is not shown"
