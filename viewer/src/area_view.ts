/** Supporting areas of contacts: filled polygons with a border; no allocation when set again. */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  Vector3,
} from 'three';
import { Vector } from './scene_format';

const MOST_CORNERS = 16;
const LIFT_M = 0.003;

/** Corners of triangles or ends of lines, with their colours. */
class Corners {
  readonly geometry = new BufferGeometry();
  private readonly positions: BufferAttribute;
  private readonly colours: BufferAttribute;
  private count = 0;

  constructor(most: number) {
    this.positions = new BufferAttribute(new Float32Array(3 * most), 3);
    this.colours = new BufferAttribute(new Float32Array(3 * most), 3);
    this.geometry.setAttribute('position', this.positions);
    this.geometry.setAttribute('color', this.colours);
  }

  begin(): void {
    this.count = 0;
  }

  add([x, y, z]: Vector, lift: Vector3, colour: Color): void {
    this.positions.setXYZ(this.count, x + lift.x, y + lift.y, z + lift.z);
    this.colours.setXYZ(this.count++, colour.r, colour.g, colour.b);
  }

  end(): void {
    this.geometry.setDrawRange(0, this.count);
    this.positions.needsUpdate = this.colours.needsUpdate = true;
  }
}

export class AreaView {
  readonly group = new Group();
  private readonly triangles: Corners;
  private readonly borders: Corners;
  private readonly lift = new Vector3();

  constructor(most: number) {
    this.triangles = new Corners(3 * MOST_CORNERS * most);
    this.borders = new Corners(2 * MOST_CORNERS * most);
    const look = { vertexColors: true, transparent: true, depthWrite: false };
    const filled = new MeshBasicMaterial({ ...look, opacity: 0.6, side: DoubleSide });
    // The border is seen through the foot that stands on it.
    const border = new LineBasicMaterial({ ...look, depthTest: false });
    const mesh = new Mesh(this.triangles.geometry, filled);
    const lines = new LineSegments(this.borders.geometry, border);
    mesh.renderOrder = 20;
    lines.renderOrder = 38;
    mesh.frustumCulled = lines.frustumCulled = false;
    this.group.add(mesh, lines);
  }

  begin(): void {
    this.triangles.begin();
    this.borders.begin();
  }

  /** A convex polygon by its corners, or a line by its ends. */
  add(corners: Vector[], normal: Vector3, colour: Color): void {
    const count = Math.min(corners.length, MOST_CORNERS);
    this.lift.copy(normal).multiplyScalar(LIFT_M);
    for (let i = 0; i < count; ++i) {
      const next = corners[(i + 1) % count];
      for (const corner of [corners[i], next]) this.borders.add(corner, this.lift, colour);
      if (i === 0 || i + 1 === count) continue;
      for (const corner of [corners[0], corners[i], next]) {
        this.triangles.add(corner, this.lift, colour);
      }
    }
  }

  end(): void {
    this.triangles.end();
    this.borders.end();
  }
}
