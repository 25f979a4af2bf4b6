/** The bar at the bottom: buttons, scrubber, what is executed, violations, stances. */
import { button, element, number, setText } from './dom';
import { icon } from './icons';
import { kindColour } from './contacts';
import { Plan } from './plan';
import { Player, SPEEDS } from './player';
import { Mark } from './violation_view';
import { Scene, Stance } from './scene_format';
import { changesOf, changeText, stanceAt, StanceChange } from './stances';
import { hex, Theme } from './theme';

const ROW_HEIGHT = 12;
const MOST_ROWS = 8;

interface Row {
  name: string;
  spans: { from: number; to: number; colour: string | null }[];
}

export class Timeline {
  readonly element: HTMLElement;
  private readonly play: HTMLButtonElement;
  private readonly loop: HTMLButtonElement;
  private readonly clock: HTMLElement;
  private readonly where: HTMLElement;
  private readonly speed: HTMLSelectElement;
  private readonly scrubber: HTMLInputElement;
  private readonly track: HTMLElement;
  private readonly strip: HTMLCanvasElement;
  private readonly playhead: HTMLElement;
  private readonly rows: Row[];
  private readonly stances: Stance[];
  private readonly changes: StanceChange[];
  private width = 0;

  constructor(
    parent: HTMLElement,
    scene: Scene,
    private readonly plan: Plan,
    private readonly player: Player,
    private readonly marks: Mark[],
    private readonly changed: () => void,
  ) {
    this.element = element('section', 'timeline', parent);
    this.element.setAttribute('aria-label', 'Time');
    const controls = element('div', 'controls', this.element);
    const act = (action: () => void) => () => {
      action();
      this.changed();
    };
    const step = (by: number) => act(() => this.player.step(by));
    button('', 'One configuration back (←)', controls, step(-1)).innerHTML = icon('back');
    this.play = button(
      '',
      'Play',
      controls,
      act(() => this.player.toggle()),
    );
    this.play.classList.add('play');
    this.play.id = 'play';
    button('', 'One configuration on (→)', controls, step(1)).innerHTML = icon('forward');
    this.loop = button(
      '',
      'Loop (l)',
      controls,
      act(() => (player.loop = !player.loop)),
    );
    this.loop.innerHTML = icon('loop');
    this.speed = element('select', '', controls);
    this.speed.setAttribute('aria-label', 'Speed (+ and -)');
    this.speed.title = 'Speed (+ and -)';
    for (const speed of SPEEDS) {
      this.speed.add(new Option(`× ${speed}`, String(speed)));
    }
    this.speed.addEventListener(
      'change',
      act(() => (player.speed = Number(this.speed.value))),
    );
    this.clock = element('output', 'clock', controls);
    this.where = element('span', 'where', controls);

    const area = element('div', 'tracks', this.element);
    this.stances = scene.stances ?? [];
    this.changes = changesOf(this.stances);
    this.rows = stanceRows(scene, plan).slice(0, MOST_ROWS);
    const names = element('div', 'names', area);
    for (const row of this.rows) element('span', '', names).textContent = row.name;
    this.track = element('div', 'track', area);
    this.strip = element('canvas', '', this.track);
    this.playhead = element('div', 'playhead', this.track);
    this.scrubber = element('input', 'scrubber', this.track);
    this.scrubber.type = 'range';
    this.scrubber.id = 'scrubber';
    this.scrubber.min = String(plan.start);
    this.scrubber.max = String(plan.end);
    this.scrubber.step = 'any';
    this.scrubber.setAttribute('aria-label', 'Time in seconds');
    this.scrubber.addEventListener(
      'input',
      act(() => {
        this.player.playing = false;
        this.player.setTime(Number(this.scrubber.value));
      }),
    );
    const height = 16 + this.rows.length * ROW_HEIGHT + (this.rows.length > 0 ? 4 : 0);
    this.track.style.height = `${height}px`;
  }

  /** Redraws the strip; after a change of size, theme or of what is executed. */
  draw(theme: Theme, executed: number | null): void {
    const ratio = Math.min(devicePixelRatio, 2);
    this.width = this.track.clientWidth;
    const height = this.track.clientHeight;
    if (this.width === 0) return;
    this.strip.width = Math.round(this.width * ratio);
    this.strip.height = Math.round(height * ratio);
    const context = this.strip.getContext('2d');
    if (!context) return;
    context.scale(ratio, ratio);
    const part = (index: number) => hex(theme[this.plan.partOf(index, executed) ?? 'rest']);
    for (let i = 0; i < this.plan.count; ++i) {
      const x = this.x(this.plan.times[i]);
      const end = this.x(this.plan.until(i));
      context.fillStyle = part(this.plan.steps ? i : i + 1);
      if (end > x) context.fillRect(x, 6, Math.max(end - x + 0.5, 0.5), 5);
    }
    this.rows.forEach((row, k) => {
      const y = 20 + k * ROW_HEIGHT;
      context.globalAlpha = 0.13;
      context.fillStyle = hex(theme.grid);
      context.fillRect(0, y, this.width, ROW_HEIGHT - 5);
      context.globalAlpha = 0.85;
      for (const { from, to, colour } of row.spans) {
        context.fillStyle = colour ?? hex(theme.base);
        const x = this.x(this.plan.times[from]);
        const end = this.x(this.plan.until(Math.max(to - 1, from)));
        context.beginPath();
        context.roundRect(x, y, Math.max(end - x - 1, 1.5), ROW_HEIGHT - 5, 2);
        context.fill();
      }
      context.globalAlpha = 1;
      this.drawChanges(context, theme, row.name, y);
    });
    this.markChanges(context, theme, height);
    context.fillStyle = hex(theme.violation);
    for (const { violation, time } of this.marks) {
      if (!violation.violated || time === null) continue;
      const x = this.x(this.plan.steps ? time + 0.5 : time);
      context.beginPath();
      context.moveTo(x - 4, 0);
      context.lineTo(x + 4, 0);
      context.lineTo(x, 6);
      context.fill();
      context.fillRect(x - 0.75, 4, 1.5, height - 4);
    }
  }

  /** A line through all rows where the stance changes along a motion. */
  private markChanges(context: CanvasRenderingContext2D, theme: Theme, height: number): void {
    if (this.plan.steps) return;
    context.fillStyle = hex(theme.grid);
    for (const { from } of this.stances.slice(1)) {
      context.fillRect(this.x(this.plan.times[from]) - 0.5, 4, 1, height - 4);
    }
  }

  /** + and − where a stance takes a contact or leaves it, as far as there is room. */
  private drawChanges(
    context: CanvasRenderingContext2D,
    theme: Theme,
    name: string,
    y: number,
  ): void {
    context.font = 'bold 11px sans-serif';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    this.stances.forEach(({ from, to }, i) => {
      const begin = this.x(this.plan.times[from]);
      const width = this.x(this.plan.until(Math.max(to - 1, from))) - begin;
      if (width < ROW_HEIGHT) return;
      const { added, removed } = this.changes[i];
      const middle = begin + (this.plan.steps ? width : ROW_HEIGHT) / 2;
      const sign = added.includes(name) ? '+' : removed.includes(name) ? '−' : '';
      context.fillStyle = sign === '+' ? '#ffffff' : hex(theme.violation);
      context.fillText(sign, middle, y + (ROW_HEIGHT - 5) / 2);
    });
  }

  update(): void {
    const { player, plan } = this;
    const index = player.index;
    const time = plan.steps ? plan.times[index] + 0.5 : player.time;
    this.playhead.style.transform = `translateX(${this.x(time).toFixed(1)}px)`;
    this.scrubber.value = String(player.time);
    const clock = plan.steps
      ? `stance ${index} of ${plan.count}`
      : `${player.time.toFixed(2)} / ${plan.end.toFixed(2)} s`;
    setText(this.clock, clock);
    const id = plan.ids[index];
    const text = id === undefined || id === index ? `${index}` : `${index} (vertex ${id})`;
    const parts = plan.steps ? [] : [`configuration ${text} of ${plan.count}`];
    const stance = this.stances.length > 1 ? stanceAt(this.stances, index) : -1;
    if (stance >= 0) {
      parts.unshift(changeText(this.changes[stance]));
      parts.push(quantityOf(this.stances[stance].contacts.length));
    }
    setText(this.where, parts.filter((part) => part).join(' · '));
    this.scrubber.setAttribute('aria-valuetext', plan.steps ? clock : `${player.time.toFixed(2)} s, ${index}`);
    const state = player.playing ? 'Pause (space)' : 'Play (space)';
    if (this.play.title !== state) {
      this.play.title = state;
      this.play.setAttribute('aria-label', state);
      this.play.innerHTML = icon(player.playing ? 'pause' : 'play');
    }
    const pressed = String(player.loop);
    if (this.loop.getAttribute('aria-pressed') !== pressed) {
      this.loop.setAttribute('aria-pressed', pressed);
    }
    if (this.speed.value !== String(player.speed)) this.speed.value = String(player.speed);
  }

  private x(time: number): number {
    const length = this.plan.end - this.plan.start;
    return length > 0 ? ((time - this.plan.start) / length) * this.width : 0;
  }
}

function quantityOf(contacts: number): string {
  return contacts === 1 ? '1 contact' : `${contacts} contacts`;
}

/** Which contact is in force when: from the stances, or from the contacts of the plan. */
function stanceRows(scene: Scene, plan: Plan): Row[] {
  const rows = new Map<string, Row>();
  const row = (name: string) => {
    const found = rows.get(name) ?? { name, spans: [] };
    rows.set(name, found);
    return found;
  };
  for (const stance of scene.stances ?? []) {
    for (const name of stance.contacts) addSpan(row(name), stance, null);
  }
  if (rows.size > 0) return [...rows.values()];
  plan.contacts.forEach((contacts, i) => {
    for (const contact of contacts) {
      const name = scene.robot?.links[contact.link]?.name ?? `link ${number(contact.link)}`;
      addSpan(row(name), { from: i, to: i + 1, contacts: [] }, hex(kindColour(contact.kind)));
    }
  });
  return [...rows.values()];
}

function addSpan(row: Row, { from, to }: Stance, colour: string | null): void {
  const last = row.spans[row.spans.length - 1];
  if (last && colour !== null && last.to === from && last.colour === colour) last.to = to;
  else row.spans.push({ from, to, colour });
}
