/**
 * Occupied cubes of a map: one instanced square for each face that touches free space, coloured
 * by height. Faces between two occupied cubes are never seen, so they are left out.
 */
import {
  BufferAttribute, BufferGeometry, Color, Group, InstancedBufferAttribute,
  InstancedBufferGeometry, Mesh, MeshLambertMaterial, Sphere, Vector3,
} from 'three';
import { unpackFloats } from './scene_format';
import { HEIGHT_COLOURS } from './theme';

const SIDES = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];

export class VoxelView {
  readonly group = new Group();
  readonly count: number;
  readonly lowest: number;
  readonly highest: number;

  constructor(packed: string, resolution: number | undefined) {
    const voxels = unpackFloats(packed, 4, 'the map');
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
    const grid = new Occupancy(voxels, resolution ?? smallest);
    const sphere = boundingSphere(voxels);
    const material = heightMaterial(this.lowest, this.highest);
    for (const side of SIDES) this.addSide(voxels, side, grid, material, sphere);
  }

  private addSide(
    voxels: Float32Array, side: number[], grid: Occupancy, material: MeshLambertMaterial,
    sphere: Sphere,
  ): void {
    const faces: number[] = [];
    for (let i = 0; i < voxels.length; i += 4) {
      if (!grid.hidden(voxels, i, side)) {
        faces.push(voxels[i], voxels[i + 1], voxels[i + 2], voxels[i + 3]);
      }
    }
    if (faces.length === 0) return;
    const geometry = squareFacing(side);
    geometry.setAttribute('voxel', new InstancedBufferAttribute(new Float32Array(faces), 4));
    geometry.boundingSphere = sphere;
    const mesh = new Mesh(geometry, material);
    mesh.receiveShadow = true;
    this.group.add(mesh);
  }
}

/** Which cells of the finest grid are occupied by a voxel of exactly that size. */
class Occupancy {
  private readonly cells = new Set<number>();

  constructor(voxels: Float32Array, private readonly resolution: number) {
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

function squareFacing(side: number[]): InstancedBufferGeometry {
  const normal = new Vector3().fromArray(side);
  const u = new Vector3(side[1] !== 0 || side[2] !== 0 ? 1 : 0, side[0] !== 0 ? 1 : 0, 0);
  const v = new Vector3().crossVectors(normal, u);
  const positions: number[] = [];
  const normals: number[] = [];
  const corners: number[] = [];
  for (const [a, b] of [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]) {
    const corner = normal.clone().multiplyScalar(0.5).addScaledVector(u, a).addScaledVector(v, b);
    positions.push(...corner.toArray());
    normals.push(...side);
    corners.push(a, b);
  }
  const geometry: BufferGeometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute('normal', new BufferAttribute(new Float32Array(normals), 3));
  geometry.setAttribute('corner', new BufferAttribute(new Float32Array(corners), 2));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  return geometry as InstancedBufferGeometry;
}

function boundingSphere(voxels: Float32Array): Sphere {
  const centre = new Vector3();
  for (let i = 0; i < voxels.length; i += 4) {
    centre.x += voxels[i];
    centre.y += voxels[i + 1];
    centre.z += voxels[i + 2];
  }
  centre.divideScalar(voxels.length / 4);
  let radius = 0;
  const point = new Vector3();
  for (let i = 0; i < voxels.length; i += 4) {
    point.set(voxels[i], voxels[i + 1], voxels[i + 2]);
    radius = Math.max(radius, point.distanceTo(centre) + voxels[i + 3]);
  }
  return new Sphere(centre, radius);
}

function heightMaterial(lowest: number, highest: number): MeshLambertMaterial {
  const material = new MeshLambertMaterial();
  material.onBeforeCompile = (shader) => {
    shader.uniforms.uHeights = { value: [lowest, Math.max(highest, lowest + 1e-6)] };
    shader.uniforms.uColours = { value: HEIGHT_COLOURS.map((colour) => new Color(colour)) };
    shader.vertexShader = shader.vertexShader
      .replace('void main() {', 'attribute vec4 voxel;\nattribute vec2 corner;\nvarying float vHeight;\nvarying vec2 vCorner;\nvoid main() {')
      .replace(
        '#include <begin_vertex>',
        'vec3 transformed = position * voxel.w + voxel.xyz;\nvHeight = voxel.z;\nvCorner = corner;',
      );
    shader.fragmentShader = shader.fragmentShader
      .replace(
        'void main() {',
        `varying float vHeight;
varying vec2 vCorner;
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
vec2 rim = 0.5 - abs(vCorner);
vec2 pixel = fwidth(vCorner);
float edge = 1.0 - smoothstep(0.0, 1.5, min(rim.x / pixel.x, rim.y / pixel.y));
float close = 1.0 - smoothstep(0.04, 0.2, max(pixel.x, pixel.y));
diffuseColor.rgb *= mix(low, high, h - float(cell)) * (1.0 - 0.32 * edge * close);`,
      );
  };
  return material;
}
