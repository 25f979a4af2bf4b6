#!/bin/bash
# Builds and runs the tests: sources formatted, unit tests under AddressSanitizer and UBSan, then the
# others in Release, and once more those of what is vectorised. Quick when nothing has changed; ends
# with ctest's summary. By hand besides, as their builds take long: `scripts/setup.sh && ctest
# --test-dir build` runs every test in Release; scripts/fuzz.sh after changes of parsers,
# scripts/threads.sh of what threads share.

. "$(dirname "$0")/setup.sh"

# run_tests FOLDER [ctest options…]
run_tests() {
  local folder=$1
  shift
  ctest --test-dir "$root/$folder" --output-on-failure --no-tests=error --parallel "$jobs" "$@"
}

export LOCOGRAPH_CACHE=$root/build/cache  # not the user's
install_missing
# Compiled and run once, under sanitizers: in Release too they would take a quarter of the time.
sanitized_only=(robots_tests world_tests check_tests plugins_tests planners_tests execution_tests)
# Benchmarks are built by scripts/lint.sh.
configure build -DLOCOGRAPH_UNITY_TESTS=ON \
  "-DLOCOGRAPH_LEAVE_OUT_TESTS=$(IFS=';' && echo "${sanitized_only[*]}")"
build build

say "checking the layout of the sources"
"$root/scripts/format.sh" --check

# The libraries' unit tests; the command itself, the examples of headers and the installed package
# are tested in Release.
configure_sanitized build-asan address,undefined
mapfile -t unit_tests < <(
  cd "$root/tests"
  sed -n 's/^locograph_test(\([a-z_]*\).*/\1/p' \
    {common,core,solvers,types,robots,world,check,plugins,planners,execution}/CMakeLists.txt |
    grep -vx '.*_thread_tests'
)
build build-asan --target "${unit_tests[@]}"
say "running ${unit_tests[*]} under AddressSanitizer and UBSan"
ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1 run_tests build-asan \
  --tests-regex "^(simd_v[23]_plugins_tests|$(IFS='|' && echo "${unit_tests[*]}"))" >&2

say "running all tests"
run_tests build
