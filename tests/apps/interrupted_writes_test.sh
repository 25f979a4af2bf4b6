#!/bin/bash
# interrupted_writes_test.sh BINARY N [SEED]: ends `locograph optimize` by SIGKILL, SIGINT, SIGTERM
# and SIGHUP at N random moments, every other one while it writes. Its output must be the old file or
# a whole new one, and nothing else may be left: of SIGKILL as soon as the next run has ended. Then a
# full disk and folders that may not be written, where this user can have them.

set -u
binary=$1 runs=$2
RANDOM=${3:-14}
folder=$(mktemp -d)
# A job that a signal ends before it is a program of its own still is this shell, with its trap.
clean_up() {
  [ "$BASHPID" = $$ ] || return
  mountpoint -q "$folder/disk" && umount "$folder/disk"
  rm -rf "$folder"
}
trap clean_up EXIT
cd "$folder" || exit 1
mkdir out disk
set -m # else what runs in the background ignores SIGINT

fail() {
  echo "interrupted_writes: $*" >&2
  exit 1
}
# optimise OUTPUT [ITERATIONS]: only exit code 2 and signals are failures, as 3 iterations are few.
optimise() { "$binary" optimize in.g2o --iterations "${2:-3}" --threads 1 -o "$1"; }
beside_the_target() { find out -mindepth 1 ! -name graph.g2o; }

# A chain of poses: little to solve, much to write.
awk 'BEGIN {
  for (i = 0; i < 8000; ++i) printf "VERTEX_SE3:QUAT %d %.2f 0.1 0 0 0 0 1\n", i, 1.01 * i
  for (i = 1; i < 8000; ++i) {
    printf "EDGE_SE3:QUAT %d %d 1 0.01 0 0 0 0.1 0.99498743710662", i - 1, i
    print " 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1"
  }
}' >in.g2o
# Ctrl-C ends with the best so far: the result of any iteration is a whole one.
for i in 1 2 3; do optimise "whole_$i" "$i" >log 2>&1 || [ $? = 1 ] || fail "$(cat log)"; done
begin=$(date +%s%N)
optimise out/graph.g2o >/dev/null 2>&1
milliseconds=$((($(date +%s%N) - begin) / 1000000 + 1))
echo "the old file" >old

signals=(KILL INT TERM HUP)
old_ones=0 new_ones=0 while_writing=0 left_by_kill=0
for ((run = 0; run < runs; ++run)); do
  signal=${signals[$((run / 2 % 4))]}
  cp old out/graph.g2o
  "$binary" optimize in.g2o --iterations 3 --threads 1 -o out/graph.g2o >/dev/null 2>&1 &
  job=$!
  temporary=(out/.graph.g2o.locograph-*)
  if ((run % 2)); then
    # One that has ended has no executable any more; `kill -0` finds it until the shell waits for it.
    until [ -e "${temporary[0]}" ] || [ ! -e /proc/$job/exe ]; do
      temporary=(out/.graph.g2o.locograph-*)
    done
    for ((i = RANDOM % 2000; i > 0; --i)); do :; done
  else
    moment=$((RANDOM % milliseconds))
    sleep "$((moment / 1000)).$(printf %03d $((moment % 1000)))"
    temporary=(out/.graph.g2o.locograph-*)
  fi
  [ -e "${temporary[0]}" ] && while_writing=$((while_writing + 1))
  kill -$signal -- -$job 2>/dev/null
  { wait $job; } 2>/dev/null

  if cmp -s out/graph.g2o old; then
    old_ones=$((old_ones + 1))
  elif cmp -s out/graph.g2o whole_1 || cmp -s out/graph.g2o whole_2 || cmp -s out/graph.g2o whole_3
  then
    new_ones=$((new_ones + 1))
  else
    fail "run $run, SIG$signal: neither the old file nor a whole new one"
  fi
  [ -z "$(beside_the_target)" ] && continue
  [ $signal = KILL ] || fail "run $run, SIG$signal left $(beside_the_target)"
  left_by_kill=$((left_by_kill + 1))
  optimise out/graph.g2o >/dev/null 2>&1
  [ -z "$(beside_the_target)" ] || fail "run $run: the next run left $(beside_the_target)"
done
set +m
echo "$runs runs: $old_ones old files, $new_ones new ones; $while_writing signals while it wrote;" \
  "$left_by_kill temporary files left by SIGKILL, all removed by the next run"

# refused WORDS COMMAND...: one line that says so, exit code 2, and the target as it was.
refused() {
  local words=$1 target=$2
  shift 2
  "$@" >/dev/null 2>log
  [ $? = 2 ] || fail "'$words' expected, not exit code 2 but: $(cat log)"
  [ "$(wc -l <log)" = 1 ] && grep -q "cannot be written: $words" log ||
    fail "'$words' expected, not: $(cat log)"
  cmp -s "$target" old || fail "$target is not the old file any more"
  [ "$(ls -A "$(dirname "$target")" | wc -l)" = 1 ] || fail "more than $target in its folder"
}

if mount -t tmpfs -o size=256k none disk 2>/dev/null; then
  cp old disk/graph.g2o
  refused "no space left on device" disk/graph.g2o optimise disk/graph.g2o
  mount -o remount,ro disk
  refused "read-only file system" disk/graph.g2o optimise disk/graph.g2o
  umount disk
  echo "full disk and read-only file system: refused, target intact, nothing left"
else
  echo "full disk and read-only file system: not tried, no right to mount one"
fi

cp old disk/graph.g2o
chmod 755 "$folder"
chmod 555 disk
as_nobody=()
[ "$(id -u)" = 0 ] && as_nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
if "${as_nobody[@]}" test -x "$binary"; then
  for name in graph.g2o new; do
    refused "permission denied" disk/graph.g2o \
      "${as_nobody[@]}" "$binary" optimize in.g2o -o "disk/$name"
  done
  echo "folder without the right to write: refused, target intact, nothing left"
else
  echo "folder without the right to write: not tried, no other user may run $binary"
fi
chmod 755 disk
