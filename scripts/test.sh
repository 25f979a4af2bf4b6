#!/bin/bash
# Builds and runs every test: sources formatted, unit tests under AddressSanitizer and UBSan, then
# all tests in Release. Quick when nothing has changed; ends with ctest's summary.

. "$(dirname "$0")/setup.sh"

install_missing
configure build -DLOCOGRAPH_BENCHMARKS=ON
build build

say "checking the layout of the sources"
"$root/scripts/format.sh" --check

# Without NDEBUG, so that Eigen's own assertions count too. The libraries' unit tests; the command
# itself and the installed package are tested in Release below.
configure build-asan -DLOCOGRAPH_SANITIZE=address,undefined -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1" -DLOCOGRAPH_BENCHMARKS=OFF
mapfile -t unit_tests < <(
  cd "$root/tests"
  sed -n 's/^locograph_test(\([a-z_]*\).*/\1/p' \
    {common,core,solvers,types,robots,world,plugins}/CMakeLists.txt
)
build build-asan --target "${unit_tests[@]}"
say "running ${unit_tests[*]} under AddressSanitizer and UBSan"
printf "$root/build-asan/tests/bin/%s\n" "${unit_tests[@]}" |
  ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1 \
    xargs -P "$jobs" -I PROGRAM timeout 2400 PROGRAM --gtest_brief=1 >&2 ||
  die "a sanitized test failed"

say "running all tests"
ctest --test-dir "$root/build" --output-on-failure --no-tests=error --parallel "$jobs"
