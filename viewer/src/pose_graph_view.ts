/** Pose graphs: odometry before and after, loop closures, landmarks. */
import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Group,
  Points,
  PointsMaterial,
  Vector3,
} from 'three';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { GraphDescription, SceneError, unpackFloats, unpackIntegers } from './scene_format';
import { fatLine } from './path_view';
import { Theme } from './theme';

export class PoseGraphView {
  readonly before = new Group();
  readonly after = new Group();
  readonly loops = new Group();
  readonly landmarks = new Group();
  readonly vertexCount: number;
  readonly edgeCount: number;
  readonly loopCount: number;
  readonly pointCount: number;
  readonly planar: boolean;
  readonly box = new Box3();

  private readonly beforeLine = fatLine(1.6, 0.75);
  private readonly afterLine = fatLine(2);
  private readonly loopLine = fatLine(1.2, 0.55);
  private readonly pointMaterial = new PointsMaterial({ size: 4, sizeAttenuation: false });

  constructor(graph: GraphDescription) {
    const vertices = unpackFloats(graph.vertices, 7, 'the vertices of the graph');
    this.vertexCount = vertices.length / 7;
    if (this.vertexCount === 0) throw new SceneError('The pose graph holds no vertices.');
    this.planar = graph.dimension === 2;
    const edges = graph.edges ? unpackIntegers(graph.edges, 2, 'the edges of the graph') : null;
    const odometry: number[] = [];
    const loops: number[] = [];
    for (let e = 0; e < (edges?.length ?? 0); e += 2) {
      const [a, b] = [edges![e], edges![e + 1]];
      if (a < 0 || b < 0 || a >= this.vertexCount || b >= this.vertexCount) {
        throw new SceneError(
          `Edge ${e / 2} joins vertices ${a} and ${b}; there are ${this.vertexCount}.`,
        );
      }
      (Math.abs(a - b) === 1 ? odometry : loops).push(a, b);
    }
    this.edgeCount = (edges?.length ?? 0) / 2;
    this.loopCount = loops.length / 2;
    if (!edges) for (let i = 0; i + 1 < this.vertexCount; ++i) odometry.push(i, i + 1);

    this.after.add(segments(vertices, odometry, this.afterLine));
    this.loops.add(segments(vertices, loops, this.loopLine));
    const point = new Vector3();
    for (let i = 0; i < vertices.length; i += 7)
      this.box.expandByPoint(point.fromArray(vertices, i));
    if (graph.before) {
      const old = unpackFloats(graph.before, 7, 'the vertices before');
      if (old.length !== vertices.length) {
        throw new SceneError(
          `There are ${old.length / 7} vertices before and ${this.vertexCount} after.`,
        );
      }
      this.before.add(segments(old, odometry, this.beforeLine));
    }
    const points = graph.points ? unpackFloats(graph.points, 3, 'the points') : new Float32Array();
    this.pointCount = points.length / 3;
    if (this.pointCount > 0) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(points, 3));
      this.landmarks.add(new Points(geometry, this.pointMaterial));
    }
    this.after.renderOrder = 2;
  }

  get hasBefore(): boolean {
    return this.before.children.length > 0;
  }

  applyTheme(theme: Theme): void {
    this.beforeLine.color.set(theme.before);
    this.afterLine.color.set(theme.after);
    this.loopLine.color.set(theme.loop);
    this.pointMaterial.color.set(theme.executed);
  }
}

function segments(
  poses: Float32Array,
  pairs: number[],
  material: ReturnType<typeof fatLine>,
): LineSegments2 {
  const positions = new Float32Array(3 * Math.max(pairs.length, 2));
  pairs.forEach((vertex, i) => {
    for (let k = 0; k < 3; ++k) positions[3 * i + k] = poses[7 * vertex + k];
  });
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(positions);
  const lines = new LineSegments2(geometry, material);
  lines.visible = pairs.length > 0;
  return lines;
}
