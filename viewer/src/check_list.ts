/** What the judge found: violated constraints on top, red, then what was not judged; a click goes
 *  there. */
import { element, quantity } from './dom';
import { CheckReport, Violation } from './scene_format';
import { Mark } from './violation_view';

const FIGURES: [string, string, string][] = [
  ['min_clearance_m', 'clearance', 'm'],
  ['min_self_clearance_m', 'self-clearance', 'm'],
  ['min_balance_margin', 'balance margin', ''],
  ['max_torque_ratio', 'torque / limit', ''],
  ['max_velocity_ratio', 'velocity / limit', ''],
  ['max_contact_error_m', 'contact error', 'm'],
  ['max_ball_rolling_m', 'balls roll', 'm'],
];

/** Of `check.robustness`: the change at which some moment no longer holds. */
const ROBUSTNESS: [string, string, string][] = [
  ['friction', 'friction may shrink by', ''],
  ['area', 'areas may shrink by', ''],
  ['torque', 'torques may shrink by', ''],
  ['push_N', 'holds a push of', 'N'],
  ['mass', 'holds added mass, share', ''],
];

export class CheckList {
  private readonly rows = new Map<number, HTMLElement>();

  constructor(
    parent: HTMLElement,
    check: CheckReport,
    marks: Mark[],
    private readonly jump: (i: number) => void,
    private readonly steps = false,
  ) {
    const bad = marks.filter(({ violation }) => violation.violated).length;
    const unjudged = marks.filter(({ violation }) => violation.judged === false).length;
    const judged = marks.length - unjudged;
    const verdict = element('p', 'verdict', parent);
    const feasible = check.feasible ?? bad === 0;
    verdict.classList.add(feasible ? 'good' : 'bad');
    verdict.textContent = feasible
      ? `Feasible: all ${judged || ''} constraints hold`.replace('  ', ' ')
      : `Infeasible: ${bad} of ${judged} constraints violated`;
    if (unjudged > 0) verdict.textContent += `, ${unjudged} not judged`;

    const figures = element('dl', 'figures', parent);
    addFigures(figures, check, FIGURES);
    addFigures(figures, check.robustness ?? {}, ROBUSTNESS);
    const list = element('ul', 'violations', parent);
    list.id = 'violations';
    const order = marks.map((_, i) => i);
    order.sort((a, b) => urgency(marks[b].violation) - urgency(marks[a].violation));
    for (const i of order) this.addRow(list, marks[i], i);
    if (!check.trusted?.length) return;
    element('p', 'trusted', parent).textContent = `On trust: ${check.trusted.join('; ')}`;
  }

  select(index: number): void {
    for (const [i, row] of this.rows) {
      if (i === index) row.setAttribute('aria-current', 'true');
      else row.removeAttribute('aria-current');
    }
  }

  private addRow(list: HTMLElement, { violation, time }: Mark, index: number): void {
    const unjudged = violation.judged === false;
    const state = violation.violated ? 'bad' : unjudged ? 'unjudged' : 'good';
    const row = element('button', state, element('li', '', list));
    row.type = 'button';
    row.disabled = time === null || unjudged;
    element('span', 'name', row).textContent = violation.constraint;
    element('span', 'worst', row).textContent = unjudged
      ? 'not judged'
      : quantity(violation.worst, violation.unit);
    const detail = element('span', 'detail', row);
    details(violation, time, this.steps).forEach((part, i) => {
      if (i > 0) detail.append(' · ');
      element('span', part.length < 24 ? 'short' : '', detail).textContent = part;
    });
    row.addEventListener('click', () => this.jump(index));
    this.rows.set(index, row);
  }
}

function addFigures(
  parent: HTMLElement,
  values: Record<string, unknown>,
  figures: [string, string, string][],
): void {
  for (const [key, name, unit] of figures) {
    if (typeof values[key] !== 'number') continue;
    const tile = element('div', '', parent);
    element('dt', '', tile).textContent = name;
    element('dd', '', tile).textContent = quantity(values[key], unit);
  }
}

function urgency(violation: Violation): number {
  if (violation.violated) return 2;
  return violation.judged === false ? 1 : 0;
}

/** `steps`: times are numbers of stances. */
function details(violation: Violation, time: number | null, steps: boolean): string[] {
  if (violation.judged === false) return violation.why ? [violation.why] : [];
  const parts: string[] = [];
  if (violation.what) parts.push(violation.what);
  if (typeof violation.limit === 'number') {
    parts.push(`limit ${quantity(violation.limit, violation.unit)}`);
  }
  if (violation.violated && violation.count) parts.push(`${violation.count} ×`);
  if (time !== null) parts.push(steps ? `at stance ${time}` : `at ${time.toFixed(2)} s`);
  return parts;
}
