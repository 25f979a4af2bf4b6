/**
 * Occupied cubes of a map, coloured by height: the faces that touch free space, all in one geometry.
 * Faces between two occupied cubes are never seen, so they are left out; and what remains is merged
 * rather than instanced, because an instance of four corners costs more to start than to draw.
 */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  Mesh,
  MeshLambertMaterial,
  Vector3,
} from 'three';
import { NearBox } from './near';
import { unpackFloats } from './scene_format';
import { HEIGHT_COLOURS } from './theme';

const SIDES = [
  [1, 0, 0],
  [-1, 0, 0],
  [0, 1, 0],
  [0, -1, 0],
  [0, 0, 1],
  [0, 0, -1],
];

export class VoxelView {
  readonly group = new Group();
  readonly count: number;
  readonly lowest: number;
  readonly highest: number;

  private readonly voxels: Float32Array;
  private readonly lower = new Vector3();
  private readonly upper = new Vector3();

  constructor(packed: string, resolution: number | undefined) {
    const voxels = unpackFloats(packed, 4, 'the map');
    this.voxels = voxels;
    this.count = voxels.length / 4;
    let lowest = Infinity;
    let highest = -Infinity;
    let smallest = Infinity;
    for (let i = 0; i < voxels.length; i += 4) {
      lowest = Math.min(lowest, voxels[i + 2]);
      highest = Math.max(highest, voxels[i + 2]);
      smallest = Math.min(smallest, voxels[i + 3]);
    }
    this.lowest = this.count ? lowest : 0;
    this.highest = this.count ? highest : 0;
    if (this.count === 0) return;
    const material = heightMaterial(this.lowest, this.highest, HEIGHT_COLOURS);
    const mesh = new Mesh(voxelGeometry(voxels, resolution ?? smallest), material);
    mesh.receiveShadow = true;
    this.group.add(mesh);
  }

  /** Adds the voxels above a height: the floor is everywhere. */
  addTo(near: NearBox, above: number): void {
    const { voxels, lower, upper } = this;
    for (let i = 0; i < voxels.length; i += 4) {
      const half = 0.5 * voxels[i + 3];
      if (voxels[i + 2] - half < above) continue;
      lower.set(voxels[i] - half, voxels[i + 1] - half, voxels[i + 2] - half);
      upper.set(voxels[i] + half, voxels[i + 1] + half, voxels[i + 2] + half);
      near.add(lower, upper);
    }
  }
}

/** Which cells of the finest grid are occupied by a voxel of exactly that size. */
class Occupancy {
  private readonly cells = new Set<number>();

  constructor(
    voxels: Float32Array,
    private readonly resolution: number,
  ) {
    for (let i = 0; i < voxels.length; i += 4) {
      if (this.fine(voxels[i + 3])) {
        this.cells.add(this.key(voxels[i], voxels[i + 1], voxels[i + 2]));
      }
    }
  }

  hidden(voxels: Float32Array, i: number, side: number[]): boolean {
    if (!this.fine(voxels[i + 3])) return false;
    const r = this.resolution;
    return this.cells.has(
      this.key(voxels[i] + r * side[0], voxels[i + 1] + r * side[1], voxels[i + 2] + r * side[2]),
    );
  }

  private fine(size: number): boolean {
    return Math.abs(size - this.resolution) < 0.01 * this.resolution;
  }

  /** Cells of an octree of 16 levels: 17 bits for each axis fit into a double. */
  private key(x: number, y: number, z: number): number {
    const cell = (v: number) => Math.floor(v / this.resolution + 1e-3) + 65536;
    return (cell(x) * 131072 + cell(y)) * 131072 + cell(z);
  }
}

/** Corners of the face of a unit cube towards a side, counter-clockwise from outside. */
function faceCorners(side: number[]): { corner: Vector3; u: number; v: number }[] {
  const normal = new Vector3().fromArray(side);
  const across = new Vector3(side[0] === 0 ? 1 : 0, side[0] === 0 ? 0 : 1, 0);
  const along = new Vector3().crossVectors(normal, across);
  return [
    [-0.5, -0.5],
    [0.5, -0.5],
    [0.5, 0.5],
    [-0.5, 0.5],
  ].map(([u, v]) => ({
    corner: normal.clone().multiplyScalar(0.5).addScaledVector(across, u).addScaledVector(along, v),
    u,
    v,
  }));
}

/** Of cubes, x y z size each. */
export function voxelGeometry(voxels: Float32Array, resolution: number): BufferGeometry {
  const grid = new Occupancy(voxels, resolution);
  const faces: number[] = [];
  for (let i = 0; i < voxels.length; i += 4) {
    SIDES.forEach((side, k) => {
      if (!grid.hidden(voxels, i, side)) faces.push(i, k);
    });
  }
  const count = faces.length / 2;
  const corners = SIDES.map(faceCorners);
  const positions = new Float32Array(12 * count);
  const heights = new Float32Array(4 * count);
  const normals = new Int8Array(16 * count);
  const places = new Int8Array(8 * count);
  const index = new Uint32Array(6 * count);
  for (let face = 0; face < count; ++face) {
    const [i, k] = [faces[2 * face], faces[2 * face + 1]];
    for (let c = 0; c < 4; ++c) {
      const { corner, u, v } = corners[k][c];
      const vertex = 4 * face + c;
      positions[3 * vertex] = voxels[i] + corner.x * voxels[i + 3];
      positions[3 * vertex + 1] = voxels[i + 1] + corner.y * voxels[i + 3];
      positions[3 * vertex + 2] = voxels[i + 2] + corner.z * voxels[i + 3];
      heights[vertex] = voxels[i + 2];
      for (let axis = 0; axis < 3; ++axis) normals[4 * vertex + axis] = 127 * SIDES[k][axis];
      places[2 * vertex] = 254 * u;
      places[2 * vertex + 1] = 254 * v;
    }
    for (let c = 0; c < 6; ++c) index[6 * face + c] = 4 * face + [0, 1, 2, 0, 2, 3][c];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new BufferAttribute(normals, 4, true));
  geometry.setAttribute('height', new BufferAttribute(heights, 1));
  geometry.setAttribute('place', new BufferAttribute(places, 2, true));
  geometry.setIndex(new BufferAttribute(index, 1));
  geometry.computeBoundingSphere();
  return geometry;
}

/** `colours`: five of them, for heights from the lowest to the highest. */
export function heightMaterial(
  lowest: number,
  highest: number,
  colours: number[],
): MeshLambertMaterial {
  const material = new MeshLambertMaterial();
  material.onBeforeCompile = (shader) => {
    shader.uniforms.uHeights = { value: [lowest, Math.max(highest, lowest + 1e-6)] };
    shader.uniforms.uColours = { value: colours.map((colour) => new Color(colour)) };
    shader.vertexShader = shader.vertexShader.replace(
      'void main() {',
      `attribute float height;
attribute vec2 place;
varying float vHeight;
varying vec2 vPlace;
void main() {
vHeight = height;
vPlace = place;`,
    );
    shader.fragmentShader = shader.fragmentShader
      .replace(
        'void main() {',
        `varying float vHeight;
varying vec2 vPlace;
uniform float uHeights[2];
uniform vec3 uColours[5];
void main() {`,
      )
      .replace(
        '#include <color_fragment>',
        `float h = 4.0 * clamp((vHeight - uHeights[0]) / (uHeights[1] - uHeights[0]), 0.0, 1.0);
int cell = int(min(h, 3.999));
vec3 low = uColours[0], high = uColours[1];
if (cell == 1) { low = uColours[1]; high = uColours[2]; }
if (cell == 2) { low = uColours[2]; high = uColours[3]; }
if (cell == 3) { low = uColours[3]; high = uColours[4]; }
vec2 rim = 1.0 - abs(vPlace);
vec2 pixel = fwidth(vPlace);
float edge = 1.0 - smoothstep(0.0, 1.5, min(rim.x / pixel.x, rim.y / pixel.y));
float close = 1.0 - smoothstep(0.08, 0.4, max(pixel.x, pixel.y));
diffuseColor.rgb *= mix(low, high, h - float(cell)) * (1.0 - 0.32 * edge * close);`,
      );
  };
  return material;
}
