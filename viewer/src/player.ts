/** The clock of the page: time, playing, speed, loop, steps from configuration to configuration. */
import { Plan } from './plan';

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];

export class Player {
  time = 0;
  playing = false;
  loop = true;
  speed = 1;

  constructor(private readonly plan: Plan | null) {
    this.time = this.start;
  }

  get start(): number {
    return this.plan?.start ?? 0;
  }

  get end(): number {
    return this.plan?.end ?? 0;
  }

  get index(): number {
    return this.plan?.nearestIndex(this.time) ?? 0;
  }

  setTime(time: number): void {
    if (Number.isFinite(time)) this.time = Math.min(Math.max(time, this.start), this.end);
  }

  toggle(): void {
    if (!this.playing && this.time >= this.end) this.time = this.start;
    this.playing = !this.playing && this.end > this.start;
  }

  /** To the next configuration or the one before. */
  step(by: number): void {
    if (!this.plan) return;
    this.playing = false;
    const index = Math.min(Math.max(this.index + by, 0), this.plan.count - 1);
    this.time = this.plan.times[index];
  }

  faster(by: number): void {
    const now = SPEEDS.indexOf(this.speed);
    this.speed = SPEEDS[Math.min(Math.max(now + by, 0), SPEEDS.length - 1)];
  }

  /** Moves on by a stretch of real time [s]; says whether the time changed. */
  advance(seconds: number): boolean {
    if (!this.playing) return false;
    const next = this.time + this.speed * seconds;
    if (next <= this.end) {
      this.time = next;
    } else if (this.loop) {
      this.time = this.start;
    } else {
      this.time = this.end;
      this.playing = false;
    }
    return true;
  }
}
