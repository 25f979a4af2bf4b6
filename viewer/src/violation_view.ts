/** What the checker found wrong, where it is wrong: red spheres, and labels over them. */
import { Camera, Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from 'three';
import { Plan } from './plan';
import { Violation } from './scene_format';
import { THEMES } from './theme';
import { element, quantity } from './dom';

/** A violation is shown with its label this long before and after its moment [s]. */
const LABEL_SECONDS = 0.35;

export interface Mark {
  violation: Violation;
  time: number | null;
  point: Vector3 | null;
  sphere: Mesh | null;
  label: HTMLElement | null;
}

export class ViolationView {
  readonly group = new Group();
  readonly marks: Mark[];
  selected = -1;

  private readonly projected = new Vector3();
  private readonly heights: number[] = [];

  constructor(
    violations: Violation[],
    plan: Plan | null,
    private readonly overlay: HTMLElement,
  ) {
    const geometry = new SphereGeometry(1, 28, 18);
    const red = new MeshBasicMaterial({
      color: THEMES.light.violation,
      transparent: true,
      depthTest: false,
      depthWrite: false,
    });
    const halo = new MeshBasicMaterial({
      color: THEMES.light.violation,
      transparent: true,
      opacity: 0.28,
      depthTest: false,
      depthWrite: false,
    });
    this.marks = violations.map((violation) => {
      const time = timeOf(violation, plan);
      const point = violation.violated ? placeOf(violation, time, plan) : null;
      if (!point) return { violation, time, point, sphere: null, label: null };
      const sphere = new Mesh(geometry, red);
      sphere.position.copy(point);
      sphere.renderOrder = 30;
      const glow = new Mesh(geometry, halo);
      glow.scale.setScalar(2.2);
      glow.renderOrder = 31;
      sphere.add(glow);
      this.group.add(sphere);
      const label = element('div', 'mark-label', overlay);
      element('strong', '', label).textContent = violation.constraint;
      element('span', '', label).textContent = quantity(violation.worst, violation.unit);
      label.hidden = true;
      return { violation, time, point, sphere, label };
    });
  }

  update(time: number, camera: Camera, width: number, height: number): void {
    this.heights.length = 0;
    this.marks.forEach(({ sphere, point, label, time: moment }, i) => {
      if (!sphere || !point || !label) return;
      const near = moment !== null && Math.abs(moment - time) <= LABEL_SECONDS;
      const active = near || i === this.selected;
      sphere.scale.setScalar(active ? 0.045 : 0.022);
      this.projected.copy(point).project(camera);
      const inside = Math.abs(this.projected.x) < 1 && Math.abs(this.projected.y) < 1;
      label.hidden = !(active && this.group.visible && inside && this.projected.z < 1);
      if (label.hidden) return;
      const x = Math.min(Math.max(0.5 * (1 + this.projected.x) * width, 90), width - 90);
      let y = 0.5 * (1 - this.projected.y) * height - 18;
      while (this.heights.some((other) => Math.abs(other - y) < 26)) y -= 26;
      this.heights.push(y);
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -100%)`;
      label.classList.toggle('selected', i === this.selected);
    });
  }

  setVisible(on: boolean): void {
    this.group.visible = on;
    this.overlay.hidden = !on;
  }
}

function timeOf(violation: Violation, plan: Plan | null): number | null {
  if (typeof violation.time === 'number' && !plan?.steps) return violation.time;
  const index = violation.index;
  return plan && typeof index === 'number' && index >= 0 && index < plan.count
    ? plan.times[index]
    : null;
}

/** Where it is wrong; without a point, the base of the robot at that time. */
function placeOf(violation: Violation, time: number | null, plan: Plan | null): Vector3 | null {
  if (violation.at_point?.length === 3) return new Vector3().fromArray(violation.at_point);
  if (!plan || time === null || plan.size < 7) return null;
  const configuration = new Float32Array(plan.size);
  plan.sample(time, configuration);
  return new Vector3(configuration[0], configuration[1], configuration[2]);
}
