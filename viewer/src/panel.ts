/** The side panel: what the checker found, figures now, joints, switches. */
import { CheckList } from './check_list';
import { ContactTrack } from './contacts';
import { element, number, quantity, setText } from './dom';
import { JointBars } from './joint_bars';
import { Kinematics } from './kinematics';
import { Layers } from './layers';
import { CloudCount } from './perception_view';
import { Plan } from './plan';
import { PoseGraphView } from './pose_graph_view';
import { Scene } from './scene_format';
import { SeriesCharts } from './series_charts';
import { Mark } from './violation_view';
import { Vector3 } from 'three';

export class Panel {
  readonly element: HTMLElement;
  readonly check: CheckList | null = null;
  private joints: JointBars | null = null;
  private charts: SeriesCharts | null = null;
  private now: HTMLElement | null = null;
  private readonly nowValues = new Map<string, HTMLElement>();

  constructor(
    parent: HTMLElement,
    private readonly scene: Scene,
    marks: Mark[],
    jump: (i: number) => void,
  ) {
    this.element = element('aside', 'panel', parent);
    this.element.id = 'panel';
    this.element.setAttribute('aria-label', 'Details');
    if (scene.check) {
      const steps = scene.plan?.stances_only;
      this.check = new CheckList(this.section('Check'), scene.check, marks, jump, steps);
    }
  }

  private section(title: string, open = true): HTMLElement {
    const details = element('details', '', this.element);
    details.open = open;
    element('summary', '', details).textContent = title;
    return element('div', 'body', details);
  }

  /** Mesh files that were not there; primitives stand in for them. */
  addMissing(files: string[]): void {
    if (files.length === 0) return;
    const body = this.section(`Missing mesh files (${files.length})`, false);
    for (const file of files) element('p', 'note', body).textContent = file;
  }

  addPlan(plan: Plan, kinematics: Kinematics, torques: boolean): void {
    this.now = element('dl', 'now', this.section('Now'));
    if (plan.series.length > 0) {
      this.charts = new SeriesCharts(this.section('Along the plan'), plan);
    }
    if (kinematics.moving.length > 0) {
      this.joints = new JointBars(this.section('Joints'), kinematics.moving, torques);
    }
  }

  addGraph(view: PoseGraphView): void {
    const list = element('dl', 'now', this.section('Pose graph'));
    const row = (name: string, value: string) => {
      element('dt', '', list).textContent = name;
      element('dd', '', list).textContent = value;
    };
    row('poses', number(view.vertexCount));
    row('edges', number(view.edgeCount));
    row('loop closures', number(view.loopCount));
    if (view.pointCount > 0) row('landmarks', number(view.pointCount));
    const chi2 = this.scene.graph?.chi2 ?? [];
    if (chi2.length > 0) row('χ² before', number(chi2[0]));
    if (chi2.length > 1) row('χ² after', number(chi2[chi2.length - 1]));
  }

  addSwitches(layers: Layers): HTMLElement {
    const body = this.section('Show');
    layers.addSwitches(body);
    return body;
  }

  /** Figures of the moment. */
  update(
    time: number,
    base: Vector3 | null,
    com: Vector3 | null,
    contacts: ContactTrack | null,
  ): void {
    this.charts?.update(time);
    if (!this.now) return;
    if (base) this.set('base', `${place(base)} m`);
    if (com) this.set('centre of mass', `${place(com)} m`);
    if (!contacts) return;
    this.set('contacts', kinds(contacts));
    if (contacts.hasForces) {
      let sum = 0;
      for (const contact of contacts.current) {
        if (contact.force) sum += Math.hypot(...contact.force);
      }
      this.set('contact forces', quantity(sum, 'N'));
    }
  }

  /** Of each camera its newest cloud. */
  updateCameras(time: number, counts: CloudCount[]): void {
    for (const { name, stamp, kept, taken } of counts) {
      const text =
        stamp === null
          ? 'nothing yet'
          : `${number(kept)} points, ${number(taken)} the robot's, ${(time - stamp).toFixed(2)} s ago`;
      this.set(name, text);
    }
  }

  updateJoints(
    positions: Float32Array,
    offset: number,
    velocities: Float32Array,
    torques: Float32Array | null,
  ): void {
    this.joints?.update(positions, offset, velocities, torques);
  }

  private set(name: string, value: string): void {
    let cell = this.nowValues.get(name);
    if (!cell) {
      element('dt', '', this.now!).textContent = name;
      cell = element('dd', '', this.now!);
      this.nowValues.set(name, cell);
    }
    setText(cell, value);
  }
}

function place({ x, y, z }: Vector3): string {
  return `${x.toFixed(2)}, ${y.toFixed(2)}, ${z.toFixed(2)}`;
}

function kinds(contacts: ContactTrack): string {
  const counts = new Map<string, number>();
  for (const { kind } of contacts.current) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  if (counts.size === 0) return 'none';
  return [...counts].map(([kind, count]) => `${count} × ${kind}`).join(', ');
}
