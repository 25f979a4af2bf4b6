/** One row per joint: position between its limits, velocity and torque against theirs. */
import { element, number, quantity, setText } from './dom';
import { JointDescription } from './scene_format';

interface Row {
  marker: HTMLElement;
  velocity: HTMLElement;
  torque: HTMLElement;
  value: HTMLElement;
  row: HTMLElement;
}

export class JointBars {
  private readonly rows: (Row | null)[];

  constructor(
    parent: HTMLElement,
    private readonly joints: JointDescription[],
    torques: boolean,
  ) {
    const legend = element('p', 'note', parent);
    legend.textContent = torques
      ? 'Dot: position between its limits. Thin bars: velocity (blue) and holding torque (orange), full at the limit.'
      : 'Dot: position between its limits. Thin bar: velocity, full at the limit.';
    const list = element('div', 'joints', parent);
    this.rows = joints.map((joint) => {
      if (!joint) return null;
      const row = element('div', 'joint', list);
      const name = element('span', 'joint-name', row);
      name.textContent = joint.name;
      name.title = describe(joint);
      const bars = element('div', 'bars', row);
      const range = element('div', 'range', bars);
      const marker = element('i', '', range);
      const velocity = element('i', '', element('div', 'rate', bars));
      const torqueBar = element('div', 'rate torque', bars);
      torqueBar.hidden = !torques;
      const torque = element('i', '', torqueBar);
      const value = element('span', 'joint-value', row);
      if (!limited(joint)) range.classList.add('unlimited');
      return { marker, velocity, torque, value, row };
    });
  }

  update(
    positions: Float32Array,
    offset: number,
    velocities: Float32Array,
    torques: Float32Array | null,
  ): void {
    this.rows.forEach((row, i) => {
      if (!row) return;
      const joint = this.joints[i];
      const position = positions[offset + i];
      let outside = false;
      let place = 0.5;
      if (limited(joint)) {
        place = (position - joint.lower!) / (joint.upper! - joint.lower!);
        outside = place < -1e-4 || place > 1 + 1e-4;
      } else {
        place = (((position / (2 * Math.PI)) % 1) + 1) % 1;
      }
      row.marker.style.left = `${(100 * Math.min(Math.max(place, 0), 1)).toFixed(1)}%`;
      const speed = fill(row.velocity, velocities[i], joint.velocity);
      const load = torques ? fill(row.torque, torques[i], joint.effort) : 0;
      row.row.classList.toggle('over', outside || speed > 1.001 || load > 1.001);
      const unit = joint.type === 'prismatic' ? 'm' : 'rad';
      setText(row.value, `${position.toFixed(2)} ${unit}`);
      row.row.title =
        `${joint.name}: ${number(position)} ${unit}, ${quantity(velocities[i], `${unit}/s`)}` +
        (torques ? `, ${quantity(torques[i], unit === 'm' ? 'N' : 'N m')}` : '');
    });
  }
}

function limited(joint: JointDescription): boolean {
  return (
    typeof joint.lower === 'number' && typeof joint.upper === 'number' && joint.upper > joint.lower
  );
}

/** Bar from the middle, half its width at the limit; returns the ratio to the limit. */
function fill(bar: HTMLElement, value: number, limit: number | null | undefined): number {
  const ratio = limit ? value / limit : 0;
  const half = 50 * Math.min(Math.abs(ratio), 1);
  bar.style.left = `${(ratio < 0 ? 50 - half : 50).toFixed(1)}%`;
  bar.style.width = `${half.toFixed(1)}%`;
  bar.classList.toggle('over', Math.abs(ratio) > 1.001);
  return Math.abs(ratio);
}

function describe(joint: JointDescription): string {
  const unit = joint.type === 'prismatic' ? 'm' : 'rad';
  const limits = limited(joint)
    ? `${number(joint.lower!)} … ${number(joint.upper!)} ${unit}`
    : 'no position limits';
  const effort = unit === 'm' ? 'N' : 'N m';
  return `${joint.name} (${joint.type}): ${limits}, at most ${quantity(joint.velocity, `${unit}/s`)}, ${quantity(joint.effort, effort)}`;
}
