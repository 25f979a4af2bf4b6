/** Where the plan goes: contact dots (executed, in the window, the rest), base and reference line. */
import {
  BufferGeometry,
  Color,
  Group,
  InstancedMesh,
  Matrix4,
  MeshBasicMaterial,
  OctahedronGeometry,
} from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { Kinematics } from './kinematics';
import { Plan } from './plan';
import { Theme } from './theme';

/** Of the base's line, where it is curved. */
const MOST_POINTS = 4000;
const MOST_POINTS_A_STEP = 8;

export function fatLine(width: number, opacity = 1): LineMaterial {
  return new LineMaterial({ linewidth: width, transparent: opacity < 1, opacity });
}

export class PathView {
  readonly dots = new Group();
  readonly lines = new Group();
  readonly referenceLine = new Group();

  private readonly spheres: InstancedMesh<BufferGeometry, MeshBasicMaterial>;
  private readonly baseMaterial = fatLine(2.5);
  private readonly referenceMaterial = fatLine(1.5);
  private readonly base: Line2;
  private readonly indices: number[] = [];
  private readonly colour = new Color();
  private readonly matrix = new Matrix4();

  constructor(
    private readonly plan: Plan,
    private readonly kinematics: Kinematics,
  ) {
    plan.contacts.forEach((contacts, i) => contacts.forEach(() => this.indices.push(i)));
    this.spheres = new InstancedMesh(
      new OctahedronGeometry(0.017, 1),
      new MeshBasicMaterial(),
      Math.max(this.indices.length, 1),
    );
    this.spheres.count = this.indices.length;
    this.spheres.frustumCulled = false;
    this.dots.add(this.spheres);

    this.referenceMaterial.dashed = true;
    this.referenceMaterial.dashSize = 0.06;
    this.referenceMaterial.gapSize = 0.04;
    this.base = new Line2(new LineGeometry(), this.baseMaterial);
    this.base.frustumCulled = false;
    this.lines.add(this.base);
    if (plan.reference) {
      const reference = new Line2(new LineGeometry(), this.referenceMaterial);
      reference.geometry.setPositions(this.basePositions(plan.reference));
      reference.computeLineDistances();
      this.referenceLine.add(reference);
    }
    this.place();
  }

  /** Root link of each configuration. A robot bolted down has no path. */
  private basePositions(configurations: Float32Array): Float32Array {
    const { size } = this.plan;
    const count = this.kinematics.floating ? configurations.length / size : 1;
    const positions = new Float32Array(3 * Math.max(count, 2));
    for (let i = 0; i < count; ++i) {
      for (let k = 0; k < 3; ++k) positions[3 * i + k] = configurations[i * size + k];
    }
    if (count === 1) positions.copyWithin(3, 0, 3);
    return positions;
  }

  /** The same along the plan's curve. */
  private curvePositions(): Float32Array {
    const { plan } = this;
    const steps = plan.count - 1;
    const pieces = Math.min(Math.floor(MOST_POINTS / Math.max(steps, 1)), MOST_POINTS_A_STEP);
    if (!plan.slopes || !this.kinematics.floating || steps < 1 || pieces < 2) {
      return this.basePositions(plan.configurations);
    }
    const configuration = new Float32Array(plan.size);
    const positions = new Float32Array(3 * (steps * pieces + 1));
    for (let i = 0; i <= steps * pieces; ++i) {
      const index = Math.floor(i / pieces);
      const begin = plan.times[index];
      const end = plan.times[Math.min(index + 1, steps)];
      plan.sample(begin + ((i % pieces) / pieces) * (end - begin), configuration);
      positions.set(configuration.subarray(0, 3), 3 * i);
    }
    return positions;
  }

  /** Puts dots and lines where the plan has them now. */
  place(): void {
    let dot = 0;
    for (const contacts of this.plan.contacts) {
      for (const contact of contacts) {
        this.spheres.setMatrixAt(dot++, this.matrix.makeTranslation(...contact.position));
      }
    }
    this.spheres.instanceMatrix.needsUpdate = true;
    this.base.visible = this.kinematics.floating;
    this.base.geometry.dispose();
    this.base.geometry = new LineGeometry();
    this.base.geometry.setPositions(this.curvePositions());
  }

  /** Colours by what has been executed up to a configuration. */
  paint(theme: Theme, executed: number | null): void {
    this.baseMaterial.color.set(theme.base);
    this.referenceMaterial.color.set(theme.reference);
    for (let dot = 0; dot < this.indices.length; ++dot) {
      const part = this.plan.partOf(this.indices[dot], executed) ?? 'rest';
      this.spheres.setColorAt(dot, this.colour.set(theme[part]));
    }
    if (this.spheres.instanceColor) this.spheres.instanceColor.needsUpdate = true;
  }
}
