#!/bin/bash
# Shared by the other scripts: installs what is missing, configures and builds.
#
#   . "$(dirname "$0")/setup.sh"
#   install_missing                        # everything in dependencies.txt
#   build build --target locograph         # Release, into build/
#
# Called by itself it does both for everything.

set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs=$(nproc)

say() { printf '== %d:%02d %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*" >&2; }  # since the start
die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo -n "$@" || die "cannot become root without a password: run 'sudo $*' first"
  else
    die "run as root: $*"
  fi
}

listed_packages() { sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$root/scripts/dependencies.txt"; }

# install_missing [PACKAGE…]: the packages given, or all of dependencies.txt.
install_missing() {
  local entry package missing=()
  command -v dpkg-query >/dev/null || die "needs Debian 12; elsewhere install the equivalents of
$(listed_packages)"
  for entry in ${*:-$(listed_packages)}; do
    package=${entry%%:*}
    [ "$package" != "$entry" ] && command -v "${entry#*:}" >/dev/null && continue
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  say "installing ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq >&2
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    "${missing[@]}" >&2
}

# configure FOLDER [cmake options…]: Release by default, in silence unless it fails. Sixteen sources
# at a time: what they share is compiled once.
configure() {
  local folder=$root/$1 options=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON
    -DCMAKE_UNITY_BUILD_BATCH_SIZE=16 -DLOCOGRAPH_LEAVE_OUT_TESTS=)
  shift
  mkdir -p "$folder"
  cmake -S "$root" -B "$folder" -G Ninja "${options[@]}" "$@" >"$folder/configure.log" 2>&1 ||
    {
      cat "$folder/configure.log" >&2
      die "CMake failed"
    }
}

# configure_sanitized FOLDER SANITIZERS: without NDEBUG, so that Eigen's own assertions count too.
# -Og takes a quarter less to compile than -O1.
configure_sanitized() {
  configure "$1" -DLOCOGRAPH_SANITIZE="$2" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DLOCOGRAPH_UNITY_TESTS=ON "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-Og -g1" -DLOCOGRAPH_BENCHMARKS=OFF
}

# build FOLDER [cmake --build options…]
build() {
  local folder=$1
  shift
  say "building $folder"
  cmake --build "$root/$folder" --parallel "$jobs" "$@" >&2
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  install_missing
  configure build
  build build
fi
