/**
 * A plan: configurations over time, interpolated (linear, and slerp for the base). In a plan of
 * stances nothing lies between configurations: each is shown for a second.
 *
 *     const plan = new Plan(scene.plan, scene.robot.floating_base);
 *     plan.sample(12.3, configuration);   // into an array of plan.size numbers
 */
import { Quaternion } from 'three';
import { Contact, PlanDescription, SceneError, Series, unpackFloats } from './scene_format';

export type Part = 'executed' | 'window' | 'rest';

export interface PlanSeries {
  name: string;
  unit: string;
  limit: number | null;
  values: Float32Array;
}

export class Plan {
  readonly size: number;
  readonly count: number;
  /** A plan of stances. */
  readonly steps: boolean;
  readonly times: Float64Array;
  readonly configurations: Float32Array;
  readonly reference: Float32Array | null;
  readonly torques: Float32Array | null;
  readonly contacts: Contact[][];
  readonly series: PlanSeries[];
  readonly ids: number[];
  executed: number | null;
  window: number;

  private readonly floating: boolean;
  private readonly from = new Quaternion();
  private readonly to = new Quaternion();

  constructor(description: PlanDescription, floating: boolean) {
    this.size = description.configuration_size;
    this.floating = floating;
    this.configurations = unpackFloats(description.configurations, this.size, 'configurations');
    this.count = this.configurations.length / this.size;
    if (this.count === 0) throw new SceneError('The plan is empty: it holds no configurations.');
    this.steps = description.stances_only ?? false;
    this.times = this.steps
      ? Float64Array.from({ length: this.count }, (_, i) => i)
      : timesOf(description.times, this.count);
    this.reference = description.reference
      ? unpackFloats(description.reference, this.size, 'the reference plan')
      : null;
    const joints = this.size - (floating ? 7 : 0);
    this.torques =
      description.torques && joints > 0
        ? unpackFloats(description.torques, joints, 'torques')
        : null;
    this.contacts = description.contacts ?? [];
    this.series = (description.series ?? []).map((series) => unpackSeries(series));
    this.ids = description.ids ?? [];
    this.executed = description.executed ?? null;
    this.window = description.window ?? 0;
  }

  get start(): number {
    return this.times[0];
  }

  get end(): number {
    return this.until(this.count - 1);
  }

  /** Until when a configuration is the last one passed. */
  until(index: number): number {
    if (this.steps) return index + 1;
    return this.times[Math.min(index + 1, this.count - 1)];
  }

  /** Last configuration at or before a time. */
  indexAt(time: number): number {
    let low = 0;
    let high = this.count - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= time + 1e-9) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** The configuration nearest in time. */
  nearestIndex(time: number): number {
    const index = this.indexAt(time);
    if (this.steps) return index;
    const next = Math.min(index + 1, this.count - 1);
    return time - this.times[index] > this.times[next] - time ? next : index;
  }

  /** How far between configurations `index` and the next one a time lies, in 0…1. */
  fractionAt(time: number, index: number): number {
    if (this.steps || index + 1 >= this.count) return 0;
    const begin = this.times[index];
    const step = this.times[index + 1] - begin;
    return step > 0 ? Math.min(Math.max((time - begin) / step, 0), 1) : 0;
  }

  sample(time: number, configuration: Float32Array): void {
    const index = this.indexAt(time);
    const fraction = this.fractionAt(time, index);
    const a = index * this.size;
    const b = Math.min(index + 1, this.count - 1) * this.size;
    const values = this.configurations;
    for (let k = 0; k < this.size; ++k) {
      configuration[k] = values[a + k] + fraction * (values[b + k] - values[a + k]);
    }
    if (this.floating) {
      this.from.fromArray(values, a + 3).normalize();
      this.to.fromArray(values, b + 3).normalize();
      this.from.slerp(this.to, fraction).toArray(configuration, 3);
    }
  }

  copyConfiguration(index: number, configuration: Float32Array): void {
    const first = index * this.size;
    for (let k = 0; k < this.size; ++k) configuration[k] = this.configurations[first + k];
  }

  /** Joint velocities [rad/s] between the configurations around a time; zero at the end. */
  velocities(time: number, velocities: Float32Array): void {
    const index = Math.min(this.indexAt(time), Math.max(this.count - 2, 0));
    const next = Math.min(index + 1, this.count - 1);
    const step = this.steps ? 0 : this.times[next] - this.times[index];
    const offset = this.floating ? 7 : 0;
    for (let k = 0; k < this.size - offset; ++k) {
      const change =
        this.configurations[next * this.size + offset + k] -
        this.configurations[index * this.size + offset + k];
      velocities[k] = step > 0 ? change / step : 0;
    }
  }

  partOf(index: number, executed = this.executed): Part | null {
    if (executed === null) return null;
    if (index <= executed) return 'executed';
    return index <= executed + this.window ? 'window' : 'rest';
  }

  replace(index: number, configuration: ArrayLike<number>): boolean {
    if (!Number.isInteger(index) || index < 0 || index >= this.count) return false;
    if (configuration.length !== this.size) return false;
    this.configurations.set(configuration, index * this.size);
    return true;
  }
}

function timesOf(times: number[] | undefined, count: number): Float64Array {
  if (!times) return Float64Array.from({ length: count }, (_, i) => 0.1 * i);
  if (times.length !== count) {
    throw new SceneError(`The plan has ${count} configurations but ${times.length} times.`);
  }
  for (let i = 1; i < count; ++i) {
    if (!(times[i] >= times[i - 1])) {
      throw new SceneError(`Time ${i} of the plan (${times[i]} s) is before the one before it.`);
    }
  }
  return Float64Array.from(times);
}

function unpackSeries(series: Series): PlanSeries {
  return {
    name: series.name,
    unit: series.unit ?? '',
    limit: series.limit ?? null,
    values: unpackFloats(series.values, 1, series.name),
  };
}
