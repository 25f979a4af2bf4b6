/**
 * A plan: configurations over time, and the curve between them. In a plan of stances nothing lies
 * between configurations: each is shown for a second.
 *
 *     const plan = new Plan(scene.plan, scene.robot.floating_base, scene.stances);
 *     plan.sample(12.3, configuration);   // into an array of plan.size numbers
 */
import { Curve } from './curve';
import { Contact, PlanDescription, SceneError, Series, Stance, unpackFloats } from './scene_format';

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
  /** Of the curve, a row for each configuration; null: the straight way. */
  readonly slopes: Float32Array | null;
  readonly reference: Float32Array | null;
  /** The record of a plan carried out, which is the reference. */
  readonly recorded: boolean;
  readonly torques: Float32Array | null;
  readonly contacts: Contact[][];
  readonly series: PlanSeries[];
  readonly ids: number[];
  executed: number | null;
  window: number;

  private readonly floating: boolean;
  private readonly curve: Curve;
  private readonly given: Float32Array | null;
  /** Configurations whose slopes follow from their neighbours. */
  private readonly byRule = new Set<number>();
  /** Configurations at which stances change. */
  private readonly rests: Set<number>;

  constructor(description: PlanDescription, floating: boolean, stances: Stance[] = []) {
    this.size = description.configuration_size;
    this.floating = floating;
    this.configurations = unpackFloats(description.configurations, this.size, 'configurations');
    this.count = this.configurations.length / this.size;
    if (this.count === 0) throw new SceneError('The plan is empty: it holds no configurations.');
    this.steps = description.stances_only ?? false;
    this.times = this.steps
      ? Float64Array.from({ length: this.count }, (_, i) => i)
      : timesOf(description.times, this.count);
    this.slopes =
      description.slopes && !this.steps ? slopesOf(description, this.count, floating) : null;
    this.given = this.slopes?.slice() ?? null;
    this.curve = new Curve(this.configurations, this.slopes, this.size, floating);
    this.rests = new Set(stances.flatMap(({ from, to }) => [from, to]));
    this.reference = description.reference
      ? unpackFloats(description.reference, this.size, 'the reference plan')
      : null;
    this.recorded = (description.recorded ?? false) && this.reference !== null;
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

  /** The configuration at a time [s]. */
  sample(time: number, configuration: Float32Array): void {
    const index = this.indexAt(time);
    const fraction = this.fractionAt(time, index);
    if (fraction === 0) this.copyConfiguration(index, configuration);
    else this.curve.configuration(index, this.stepAfter(index), fraction, configuration);
  }

  copyConfiguration(index: number, configuration: Float32Array): void {
    const first = index * this.size;
    for (let k = 0; k < this.size; ++k) configuration[k] = this.configurations[first + k];
  }

  /** Where the plan had the robot that was recorded, at the moment nearest to a time [s]. */
  planned(time: number, configuration: Float32Array): void {
    const first = this.nearestIndex(time) * this.size;
    for (let k = 0; k < this.size; ++k) configuration[k] = this.reference![first + k];
  }

  /** Joint velocities [rad/s] at a time [s]; zero where there is no step. */
  velocities(time: number, velocities: Float32Array): void {
    const index = Math.min(this.indexAt(time), Math.max(this.count - 2, 0));
    const step = this.steps ? 0 : this.stepAfter(index);
    if (step > 0) this.curve.jointRates(index, step, this.fractionAt(time, index), velocities);
    else velocities.fill(0, 0, this.size - (this.floating ? 7 : 0));
  }

  partOf(index: number, executed = this.executed): Part | null {
    if (executed === null) return null;
    if (index <= executed) return 'executed';
    return index <= executed + this.window ? 'window' : 'rest';
  }

  /** Puts in another configuration; its slope is from now on the one of three points. */
  replace(index: number, configuration: ArrayLike<number>): boolean {
    if (!Number.isInteger(index) || index < 0 || index >= this.count) return false;
    if (configuration.length !== this.size) return false;
    this.configurations.set(configuration, index * this.size);
    this.byRule.add(index);
    for (const at of [index - 1, index, index + 1]) {
      if (this.byRule.has(at)) this.followRule(at);
    }
    return true;
  }

  /** Slopes as they were at first, for when all configurations are. */
  restoreSlopes(): void {
    this.byRule.clear();
    if (this.given) this.slopes?.set(this.given);
  }

  /** Seconds from a configuration to the next; 0 at the last one. */
  private stepAfter(index: number): number {
    return this.times[Math.min(index + 1, this.count - 1)] - this.times[index];
  }

  /** Of three points; zero at both ends and where the stance changes. */
  private followRule(index: number): void {
    if (!this.slopes) return;
    const { tangentSize } = this.curve;
    const slope = this.slopes.subarray(index * tangentSize, (index + 1) * tangentSize);
    const before = index > 0 ? this.stepAfter(index - 1) : 0;
    const after = this.stepAfter(index);
    if (before > 0 && after > 0 && !this.rests.has(index)) {
      this.curve.threePointSlope(index, before, after, slope);
    } else {
      slope.fill(0);
    }
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

function slopesOf(description: PlanDescription, count: number, floating: boolean): Float32Array {
  const width = description.configuration_size - (floating ? 1 : 0);
  const slopes = unpackFloats(description.slopes!, width, 'slopes');
  if (slopes.length !== count * width) {
    throw new SceneError(
      `The plan has ${count} configurations but slopes of ${slopes.length / width}.`,
    );
  }
  return slopes;
}

function unpackSeries(series: Series): PlanSeries {
  return {
    name: series.name,
    unit: series.unit ?? '',
    limit: series.limit ?? null,
    values: unpackFloats(series.values, 1, series.name),
  };
}
