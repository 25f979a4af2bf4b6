/**
 * A plan that is being refined while one looks, over a WebSocket; messages as in
 * doc/scene_format.md: `start`, then `cycle` after each cycle of the planner, then `end`.
 */
import type { App } from './app';
import { number, quantity } from './dom';
import { SeenDescription } from './scene_format';

export interface StartMessage {
  type: 'start';
}

export interface CycleMessage {
  type: 'cycle';
  executed: number;
  window: number;
  /** By their index in the plan. */
  configurations: Record<string, number[]>;
  /** What is new there. */
  perception?: SeenDescription;
  feasible?: boolean;
  cycle_time?: number;
  violation?: { constraint: string; worst?: number; unit?: string; index?: number } | null;
}

export interface EndMessage {
  type: 'end';
  success: boolean;
  reason: string;
}

export type LiveMessage = StartMessage | CycleMessage | EndMessage;

const LONGEST_WAIT_MS = 10000;

/**
 * Where messages come from: `?live=ws://…`, or the path that a scene gives on the server of its
 * page; null: nowhere.
 */
export function liveAddress(location: Location, path: string | undefined): string | null {
  const given = new URLSearchParams(location.search).get('live');
  if (given) return /^wss?:\/\//.test(given) ? given : null;
  if (!path || !/^https?:$/.test(location.protocol)) return null;
  return new URL(path, location.href).href.replace(/^http/, 'ws');
}

/** Follows a run, and connects again when the connection is lost before its end. */
export class LiveSession {
  private wait = 500;
  private ended = false;
  private socket: WebSocket | null = null;

  constructor(
    private readonly app: App,
    private readonly address: string,
  ) {
    this.chip.hidden = false;
    this.chip.addEventListener('click', () => (this.ended ? this.connect() : this.follow()));
    this.connect();
  }

  private get chip(): HTMLButtonElement {
    return this.app.bar.liveChip;
  }

  private follow(): void {
    this.app.followLive = true;
  }

  private tell(state: string, text: string, title: string): void {
    this.chip.dataset.state = state;
    this.chip.textContent = text;
    this.chip.title = title;
  }

  private connect(): void {
    this.ended = false;
    this.socket?.close();
    this.tell('connecting', 'connecting…', this.address);
    const socket = new WebSocket(this.address);
    this.socket = socket;
    socket.addEventListener('open', () => {
      this.wait = 500;
      this.tell('live', 'live', 'Follow what is executed');
      this.follow();
    });
    socket.addEventListener('message', ({ data }) => {
      let message: LiveMessage;
      try {
        message = JSON.parse(String(data)) as LiveMessage;
      } catch {
        return;
      }
      this.take(message);
    });
    socket.addEventListener('close', () => {
      if (this.ended || this.socket !== socket) return;
      this.tell('lost', 'connection lost', 'Trying again');
      setTimeout(() => this.connect(), this.wait);
      this.wait = Math.min(2 * this.wait, LONGEST_WAIT_MS);
    });
  }

  private take(message: LiveMessage): void {
    if (message.type === 'start') {
      this.app.restartLive();
    } else if (message.type === 'cycle') {
      if (message.perception) this.app.views.perception?.add(message.perception);
      this.app.applyLive(message.configurations, message.executed, message.window);
      const { violation, cycle_time } = message;
      const bad = violation
        ? ` · ${violation.constraint} ${quantity(violation.worst, violation.unit)}`
        : '';
      const time = cycle_time === undefined ? '' : ` · ${number(1000 * cycle_time)} ms`;
      this.tell(
        message.feasible === false ? 'lost' : 'live',
        `live${time}${bad}`,
        'Follow what is executed',
      );
    } else if (message.type === 'end') {
      this.ended = true;
      const text = message.success ? 'done' : `stopped: ${message.reason}`;
      this.tell(message.success ? 'live' : 'lost', text, `${message.reason}. Click to run again.`);
    }
  }
}
