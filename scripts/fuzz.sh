#!/bin/bash
# Builds the fuzz targets and runs each of them: `scripts/fuzz.sh [SECONDS | RUNSx] [TARGET…]`.
#
#   scripts/fuzz.sh                  # 5 s each, as the tests do
#   scripts/fuzz.sh 1000000x graph   # a million executions of one
#
# `plan`, graphs with the types of robots, is run by its name only: it takes minutes to build.
# What a target finds is left in build-fuzz/fuzz/findings/ and ends the script with an error; what it
# learns stays in build-fuzz/fuzz/corpus/. The seeds are made by fuzz/make_corpus.sh.

. "$(dirname "$0")/setup.sh"

amount=${1:-5}
shift || true
targets=("$@")
[ ${#targets[@]} -gt 0 ] ||
  targets=(bal cloud clouds contacts graph image map obstacles scenario srdf stl urdf)

limit=(-max_total_time="$amount")
[[ $amount == *x ]] && limit=(-runs="${amount%x}")

install_missing
# Without debug information and several sources at a time: it is made for each test run.
configure build-fuzz -DCMAKE_CXX_COMPILER=clang++-14 -DLOCOGRAPH_FUZZ=ON -DLOCOGRAPH_TESTS=OFF \
  -DLOCOGRAPH_NATIVE=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_UNITY_BUILD_BATCH_SIZE=16 "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -gline-tables-only"
build build-fuzz --target graph_seeds "${targets[@]/#/fuzz_}"

folder=$root/build-fuzz/fuzz
"$root/fuzz/make_corpus.sh" "$root/build-fuzz"
mkdir -p "$folder/findings"
failed=()
for target in "${targets[@]}"; do
  say "fuzzing $target"
  mkdir -p "$folder/corpus/$target"
  options=(-max_len=4096 -timeout=5 -rss_limit_mb=1024 -malloc_limit_mb=256 -print_final_stats=1 -seed=1
    -artifact_prefix="$folder/findings/$target-" -close_fd_mask=1 "${limit[@]}")
  [ -f "$folder/$target.dict" ] && options+=(-dict="$folder/$target.dict")
  ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0 \
    "$folder/bin/fuzz_$target" "${options[@]}" "$folder/corpus/$target" "$folder/seeds/$target" \
    >"$folder/$target.log" 2>&1 || failed+=("$target")
  grep -E '^#[0-9]+.*(DONE|INITED)|stat::number_of_executed_units|stat::peak_rss' \
    "$folder/$target.log" >&2 || true
done
[ ${#failed[@]} -eq 0 ] || die "findings: ${failed[*]} (see $folder/TARGET.log)"
