#!/bin/bash
# Runs the tests of what threads share under ThreadSanitizer. To be run after every change of it: its
# build takes too long for each run of scripts/test.sh.

. "$(dirname "$0")/setup.sh"

install_missing
configure_sanitized build-tsan thread
build build-tsan --target planners_thread_tests world_thread_tests
TSAN_OPTIONS=halt_on_error=1 ctest --test-dir "$root/build-tsan" --output-on-failure \
  --no-tests=error --parallel "$jobs" --tests-regex '_thread_tests$'
