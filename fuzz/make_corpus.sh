#!/bin/bash
# Makes the seeds of the fuzz targets, a folder for each, out of small files of the repository, of
# its tests' texts and, where it is there, of ../shared/data: `make_corpus.sh BUILD_FOLDER`.

set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$1
seeds=$build/fuzz/seeds
data=$root/../shared/data
rm -rf "$seeds"
mkdir -p "$seeds"/{bal,cloud,clouds,contacts,graph,image,map,plan,obstacles,scenario,srdf,stl,urdf}

# raw_string FILE NAME: the text of a raw string literal NAME = R"(…)" of a test.
raw_string() { sed -n "/$2 = R\"(/,/)\";/p" "$root/$1" | sed -e '1s/.*R"(//' -e '$s/)";.*//'; }

# snippets FILE PATTERN: the string literals that match, unescaped.
snippets() {
  grep -oE "\"($2)([^\"\\\\]|\\\\.)*\"" "$root/$1" | sed -e 's/^"//; s/"$//' -e 's/\\n/\n/g; s/\\"/"/g'
}

# wrap FOLDER BEFORE AFTER: one seed for each line of standard input, between the two.
wrap() {
  local folder=$1 before=$2 after=$3 number=0 line
  while IFS= read -r line; do
    printf '%s\n%s\n%s' "$before" "$line" "$after" >"$seeds/$folder/line_$((number += 1))"
  done
}

# Graphs: a seed for each type, a small plan and the same with each line that the tests try.
"$build/fuzz/bin/graph_seeds" "$seeds/graph" "$build/fuzz/graph.dict"
cp "$root/examples/plugin/beacons.g2o" "$seeds/graph"
plan=$(sed -n '/kGood =/,/;$/p' "$root/tests/plugins/bad_input_test.cpp" |
  grep -oE '"[^"]*"' | sed -e 's/^"//; s/"$//; s/\\n//')
snippets tests/plugins/bad_input_test.cpp 'EDGE_|VERTEX_|PARAMS_' | wrap plan "$plan" ""

# Robots: the cart of the tests; two links of a robot that comes along, with what hangs on them.
raw_string tests/plugins/small_robot.h kCartUrdf >"$seeds/urdf/cart"
raw_string tests/plugins/small_robot.h kCartSrdf >"$seeds/srdf/cart"
{ head -c 6000 "$root/robots/models/coman_plus/coman_plus.urdf"; echo '</robot>'; } >"$seeds/urdf/part"
printf '%s' '<robot name="r"><link name="a"><inertial><origin rpy="0 0 1"/><mass value="2"/>' \
  '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial><visual><geometry>' \
  '<box size="1 2 3"/></geometry></visual><collision><geometry><cylinder radius="1" length="2"/>' \
  '</geometry></collision></link><link name="b"><collision><geometry><mesh filename="a.stl" ' \
  'scale="1 1 1"/></geometry></collision></link><joint name="j" type="prismatic"><parent link="a"/>' \
  '<child link="b"/><mimic joint="j" multiplier="2" offset="1"/><limit lower="-1" upper="1" ' \
  'effort="1" velocity="1"/></joint></robot>' >"$seeds/urdf/kinds"
printf '%s' '<robot name="cart"><group name="all"><link name="arm"/><chain base_link="base" ' \
  'tip_link="arm"/><group name="limb"/></group><group name="limb"><joint name="lift_joint"/></group>' \
  '<group_state name="home" group="all"><joint name="lift_joint" value="0.2"/></group_state>' \
  '<disable_collisions link1="arm" link2="base" reason="Never"/><end_effector name="e" ' \
  'parent_link="arm" group="limb"/><virtual_joint name="v" type="floating" parent_frame="w" ' \
  'child_link="base"/><disable_default_collisions link="lift"/><enable_collisions link1="lift" ' \
  'link2="arm"/></robot>' >"$seeds/srdf/kinds"

# Worlds and tasks
raw_string tests/world/obstacles_test.cpp kGood >"$seeds/obstacles/good" || true
snippets tests/world/obstacles_test.cpp '\\n<' | tr -d '\n' | sed 's/<\(sphere\|box\|cyl\)/\n<\1/g' |
  wrap obstacles '<obstacles version="1">' '</obstacles>'
printf '%s' '<obstacles version="1"><box name="cart" center="2 -1 0.5" size="0.6 0.4 1" ' \
  'repeat="10" appears="1" vanishes="7"><keyframe time="4" position="2 1 0.5" rpy="0 0 1.57"/><keyframe time="5" ' \
  'position="2 1 0.5"/></box><sphere center="0 0 0" radius="1" rotation="1 0 0 0 1 0 0 0 1"/>' \
  '<cylinder center="3 1 1" radius="0.15" height="2"/></obstacles>' >"$seeds/obstacles/kinds"
cp "$root"/planners/scenarios/*.xml "$seeds/scenario"
printf '%s' '<scenario version="1" name="s"><robot urdf="r.urdf" srdf="r.srdf" active="a" ' \
  'state="home"/><wheels><wheel link="w" radius="0.1" friction="0.5" max_force="9"/></wheels>' \
  '<end_effectors><end_effector name="f" link="l" kind="surface" half_x="0.1" half_y="0.1" ' \
  'point="0 0 0" link_normal="0 0 1" link_forward="1 0 0" max_force="9"/><end_effector name="g" ' \
  'link="l" kind="rung" max_force="9" max_moment="1"/><end_effector name="h" link="l" ' \
  'kind="point" radius="0.1" max_force="9"/></end_effectors><limits base_linear="1" ' \
  'base_angular="1" joint_acceleration="1"/><environment map="m.bt" obstacles="o.xml" ' \
  'friction="0.8"/><drive distance="4" curvature="0.1" speed="0.1" configurations="50"/>' \
  '<planner torque_limits="report"/></scenario>' >"$seeds/scenario/all"
printf '%s' '<scenario version="1" name="s"><robot urdf="r.urdf" effort_scale="2"><camera name="c" ' \
  'link="l" position="0 0 1" rpy="0 1 0" width="640" height="480" fov_x="1.2" range_min="0.2" ' \
  'range_max="5"/></robot><end_effectors><end_effector name="f" link="l" kind="surface" ' \
  'half_x="0.1" half_y="0.1" max_force="9"/><end_effector name="g" link="h" kind="rung" ' \
  'max_force="9" max_moment="1"/></end_effectors><environment friction="0.8"><plane name="p" ' \
  'center="0 0 0" normal="0 0 1" forward="1 0 0" size="2 2"/><box name="b" center="1 0 0" ' \
  'size="1 1 1" rpy="0 0 1" friction="0.5"/><rung name="r" from="0 0 1" to="0 1 1" ' \
  'radius="0.02"/><mesh name="m" file="m.stl" position="0 0 1" rpy="0 0 1" scale="0.1"/>' \
  '<cloud name="c" file="c.pcd" voxel="0.1" friction="0.5"/><octomap name="o" file="o.bt"/>' \
  '</environment><start base="0 0 1 0 0 0 1"><joint name="k" position="0.5"/><contact ' \
  'end_effector="f" position="0 0 0" normal="0 0 1" forward="1 0 0"/></start><goal><contact ' \
  'end_effector="f" position="1 0 0" normal="0 0 1"/></goal><goal><contact end_effector="g" ' \
  'position="0 0.5 1" normal="0 0 1" forward="1 0 0"/></goal></scenario>' >"$seeds/scenario/contacts"
printf '%s' '<contacts version="1" name="n"><contact link="base" kind="surface" position="0 0 0" ' \
  'normal="0 0 1" forward="1 0 0" half_x="0.1" half_y="0.1" mu="0.5" max_force="9"/>' \
  '<contact link="arm" kind="point" radius="0.1" point="0 0 0.1" position="1 0 1" ' \
  'normal="-1 0 0" mu="0.5" max_force="9" load="no"/><contact link="wheel" kind="wheel" ' \
  'radius="0.1" position="0 0 0" normal="0 0 1" mu="0.5" max_force="9"/><contact link="lift" ' \
  'kind="rung" position="0 1 1" normal="0 0 1" forward="1 0 0" link_normal="0 0 1" ' \
  'link_forward="1 0 0" max_force="9" max_moment="1"/></contacts>' >"$seeds/contacts/kinds"

# Clouds: as text, in binary records among other fields, and compressed with a copy of itself.
pcd() {
  printf '# .PCD v0.7\nVERSION 0.7\nFIELDS %s\nSIZE %s\nTYPE %s\nCOUNT %s\nWIDTH %s\n' "${@:1:5}"
  printf 'HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %s\nDATA %s\n' "$5" "$6"
}
{ pcd 'x y z rgb' '4 4 4 4' 'F F F U' '1 1 1 1' 2 ascii; printf '0 1 2.5 9\n-1e-3 nan 4 9\n'; } \
  >"$seeds/cloud/text"
{
  pcd 'ring x y z' '1 4 4 4' 'U F F F' '2 1 1 1' 1 binary
  printf '\x01\x02\x00\x00\x80\x3f\x00\x00\x80\x3f\x00\x00\x00\x40'
} >"$seeds/cloud/binary"
{
  pcd 'x y z' '4 4 4' 'F F F' '1 1 1' 2 binary_compressed
  printf '\x11\x00\x00\x00\x18\x00\x00\x00\x07\x00\x00\x80\x3f\x00\x00\x80\x3f'
  printf '\x03\x00\x00\x00\x40\xe0\x03\x03'
} >"$seeds/cloud/compressed"
{ pcd 'x y z' '4 4 4' 'F F F' '1 1 1' 4 ascii; printf '0 0 1\nnan 0 1\n0 1 2\n-1 0 1\n'; } |
  sed 's/WIDTH 4/WIDTH 2/; s/HEIGHT 1/HEIGHT 2/; s/VIEWPOINT.*/VIEWPOINT 1 0 0 0.6 0.8 0 0/' \
    >"$seeds/cloud/organised"
printf 'time_s,camera,file\n0,head,a.pcd\n0.1,head,b.png\n' >"$seeds/clouds/both"

# Images: 2 x 1 pixels, stored, with a stamp and with a camera.
printf '\x89PNG\r\n\x1a\n' >"$seeds/image/texts"
png_chunk() {
  local data=$1 size crc
  size=$(printf '%b' "$data" | wc -c)
  crc=$(printf '%b' "$data" | gzip -c | tail -c 8 | head -c 4 | od -An -tx1 | awk '{print $4 $3 $2 $1}')
  printf "$(printf '%08x' $((size - 4)) | sed 's/../\\x&/g')$data$(sed 's/../\\x&/g' <<<"$crc")"
}
{
  png_chunk 'IHDR\x00\x00\x00\x02\x00\x00\x00\x01\x10\x00\x00\x00\x00'
  for text in stamp_s=0.5 camera=head fx=2 fy=2 cx=0.5 cy=0 range_min_m=0.3 range_max_m=6; do
    png_chunk "tEXt${text/=/\\x00}"
  done
  png_chunk 'IDAT\x78\x01\x01\x05\x00\xfa\xff\x00\x01\x2c\x00\x00\x00\x8d\x00\x2e'
  png_chunk IEND
} >>"$seeds/image/texts"

# Binary files: of maps a root with leaves, a chain of nodes, log-odds; one triangle of a mesh.
map() { printf '# Octomap OcTree %sfile\nid OcTree\nsize %s\nres %s\ndata\n' "$1" "$2" "$3"; }
{ map 'binary ' 9 0.1; printf '\x55\xaa'; } >"$seeds/map/root"
{ map 'binary ' 5 0.05; printf '\x03\x00\x03\x00\x03\x00\x01\x00'; } >"$seeds/map/chain"
{ map '' 2 0.1; printf '\x00\x00\x80\x3f\x01\x00\x00\x80\x3f\x00'; } >"$seeds/map/log_odds"
printf 'solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n' \
  >"$seeds/stl/text"
{
  head -c 80 /dev/zero
  printf '\x01\x00\x00\x00'
  head -c 12 /dev/zero
  printf '\x00\x00\x80\x3f%.0s' 1 2 3 4 5 6 7 8 9
  printf '\x00\x00'
} >"$seeds/stl/binary"
printf '1 1 1\n0 0 1.5 2.5\n0\n0\n0\n0\n0\n-5\n500\n0\n0\n1\n2\n3\n' >"$seeds/bal/one"

# Small pieces of public data
if [ -d "$data" ]; then
  cp "$data/bundle/dubrovnik-3-7-pre.txt" "$seeds/bal"
  cp "$data/robots/go2_description/collisions/foot_convex.stl" "$seeds/stl" 2>/dev/null || true
  head -c 3000 "$data/robots/go2_description/collisions/calf_upper_convex.stl" >"$seeds/stl/cut"
  for graph in "$data"/pose_graphs/*.g2o; do
    { head -2 "$graph"; tail -2 "$graph"; } >"$seeds/graph/$(basename "$graph")"
  done
fi

# Words of the XML formats: elements and attributes that the readers know.
for format in contacts obstacles scenario srdf urdf; do
  cat "$seeds/$format"/* | grep -oE '<[a-z_]+|[a-z_]+="[^"<>&]*"' | sort -u |
    sed -e 's/\\/\\\\/g; s/"/\\"/g' -e 's/.*/"&"/' >"$build/fuzz/$format.dict"
done
