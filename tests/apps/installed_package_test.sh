#!/bin/bash
# Installs the build into a fresh prefix, moves it, and uses it as a stranger would: the examples are
# built against it with find_package(locograph) and run.
#
#   installed_package_test.sh BUILD_FOLDER SOURCE_FOLDER GENERATOR COMPILER

set -euo pipefail
build=$1 source=$2 generator=$3 compiler=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "FAILED: $*"
  exit 1
}

cmake --install "$build" --prefix "$work/first" >"$work/log" || fail "cmake --install: $(cat "$work/log")"
mv "$work/first" "$work/prefix"

package=$(find "$work/prefix" -type d -path '*/cmake/locograph')
for leak in -march -Werror "$build" "$source" "$work/first"; do
  ! grep -rn -e "$leak" "$package" || fail "the exported targets carry $leak"
done

# configure EXAMPLE [options…]
configure() {
  local example=$1
  shift
  cmake -S "$source/examples/$example" -B "$work/$example" -G "$generator" \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$work/prefix" "$@"
}
build_type() { sed -n 's/^CMAKE_BUILD_TYPE:[A-Z]*=//p' "$work/$1/CMakeCache.txt"; }
without() { printf -- '-DCMAKE_DISABLE_FIND_PACKAGE_%s=ON\n' "$@"; }

# The optimiser needs nothing but Eigen.
mapfile -t nothing_else < <(without octomap fcl tinyxml2 PkgConfig Ceres CLI11 nlohmann_json)
configure custom_edge "${nothing_else[@]}" -DCMAKE_BUILD_TYPE=Debug
[ "$(build_type custom_edge)" = Debug ] || fail "the build type that was asked for is not kept"
rm -r "$work/custom_edge"
# Users who ask for no build type get an optimised one, and are told.
configure custom_edge "${nothing_else[@]}" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
grep -q 'locograph: no CMAKE_BUILD_TYPE is chosen: Release' "$work/log" || fail "no message"
[ "$(build_type custom_edge)" = Release ] || fail "built as '$(build_type custom_edge)'"
cmake --build "$work/custom_edge"
(cd "$work" && custom_edge/custom_edge out.g2o) || fail "custom_edge"
grep -q '^RANGE_SE2_XY 0 1 ' "$work/out.g2o" || fail "the custom edge is not in the file"

# A plug-in built out of the tree, with other flags than the command was, is loaded by it; the pages
# of doc/ build it, and a constraint on a robot, with the same flags (documented_commands_test.sh).
configure plugin "${nothing_else[@]}" "-DCMAKE_CXX_FLAGS=-march=native -O1 -fno-inline"
cmake --build "$work/plugin"
(cd "$work" && prefix/bin/locograph optimize "$source/examples/plugin/beacons.g2o" \
  --plugin plugin/range.so -o ranges.g2o) || fail "optimize with the plug-in"
grep -Eq '^VERTEX_RANGE_BIAS 2 0\.2(5000|4999)' "$work/ranges.g2o" || fail "wrong bias"
# Installed beside the command, it is found by its name.
mkdir -p "$work/prefix/lib/locograph"
cp "$work/plugin/range.so" "$work/prefix/lib/locograph/"
"$work/prefix/bin/locograph" list types --plugin range | grep -qx EDGE_BIASED_RANGE ||
  fail "the plug-in is not found by its name"

# A component whose libraries are missing is refused by name, one whose libraries are there works.
configure make_map "${nothing_else[@]}" >"$work/log" 2>&1 && fail "world was found without octomap"
grep -q 'component world needs: .*octomap' "$work/log" || fail "no clear message: $(cat "$work/log")"
echo '<obstacles version="1"><box center="1 0 0" size="1 1 1"/></obstacles>' >"$work/box.xml"
# Whatever processor a user compiles for, the layout of Eigen members is that of the library.
for flags in "" "-march=native"; do
  rm -r "$work/make_map"
  configure make_map "-DCMAKE_CXX_FLAGS=$flags"
  cmake --build "$work/make_map"
  "$work/make_map/make_map" "$work/box.xml" 0.1 "$work/box.bt" || fail "make_map with '$flags'"
done

# The installed command finds what was installed with it.
"$work/prefix/bin/locograph" info "$work/box.bt" || fail "locograph info"
"$work/prefix/bin/locograph" list robots | grep -qx centauro || fail "the robots were not installed"
"$work/prefix/bin/locograph" list scenarios | grep -qx centauro_drive || fail "no scenarios"
[ -f "$work/prefix/share/locograph/robots/models/centauro/centauro.urdf" ] || fail "no model"
