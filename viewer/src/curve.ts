/**
 * The curve of a plan from each configuration to the next: cubics through both with the slopes
 * there (Hermite). The base's rotation is R_0 exp(c(s)), c the same cubic from 0 to the rotation
 * vector of the step, the short way round. Without slopes it is the straight way, at one speed.
 *
 *     const curve = new Curve(configurations, slopes, size, floating);
 *     curve.configuration(3, 0.8, 0.5, out);   // half-way from 3 to 4, which takes 0.8 s
 *     curve.jointRates(3, 0.8, 0.5, rates);    // [rad/s]
 *
 * Rows of `configurations`: base pose (if floating), joints. Rows of `slopes`: velocity of the base
 * in the world [m/s], its angular velocity along its own axes [rad/s] (if floating), joint rates.
 * Both are looked at anew in each call.
 */
export type Numbers = Float32Array | Float64Array;

/** How far a cubic has come at s in 0…1: by `change` at 1, with the slopes `begin` and `end`. */
export function hermite(s: number, begin: number, end: number, change: number): number {
  return s * (begin + s * (3 * change - 2 * begin - end + s * (begin + end - 2 * change)));
}

/** The derivative of that by s. */
export function hermiteRate(s: number, begin: number, end: number, change: number): number {
  return begin + s * (6 * change - 4 * begin - 2 * end + 3 * s * (begin + end - 2 * change));
}

/** Rotation vector from the quaternion (x y z w) at `a` to the one at `b`, the short way round. */
export function turnBetween(q: Numbers, a: number, b: number, turn: Numbers, at = 0): void {
  const [ax, ay, az, aw] = [q[a], q[a + 1], q[a + 2], q[a + 3]];
  const [bx, by, bz, bw] = [q[b], q[b + 1], q[b + 2], q[b + 3]];
  const w = aw * bw + ax * bx + ay * by + az * bz;
  const x = aw * bx - ax * bw - ay * bz + az * by;
  const y = aw * by - ay * bw - az * bx + ax * bz;
  const z = aw * bz - az * bw - ax * by + ay * bx;
  const sine = Math.hypot(x, y, z);
  const angle = 2 * Math.atan2(sine, Math.abs(w));
  const factor = sine > 0 ? (w < 0 ? -angle : angle) / sine : 0;
  turn[at] = factor * x;
  turn[at + 1] = factor * y;
  turn[at + 2] = factor * z;
}

/**
 * Jr(d)^-1 w in place of w, Jr the right Jacobian of SO(3): how the rotation vector d changes where
 * the angular velocity along the turned axes is w.
 */
export function inverseRightJacobian(d: Numbers, w: Numbers, at = 0): void {
  const [dx, dy, dz] = [d[at], d[at + 1], d[at + 2]];
  const angle = Math.hypot(dx, dy, dz);
  const factor =
    angle < 1e-3
      ? 1 / 12 + (angle * angle) / 720
      : (1 - (0.5 * angle) / Math.tan(0.5 * angle)) / (angle * angle);
  const x = dy * w[at + 2] - dz * w[at + 1];
  const y = dz * w[at] - dx * w[at + 2];
  const z = dx * w[at + 1] - dy * w[at];
  w[at] += 0.5 * x + factor * (dy * z - dz * y);
  w[at + 1] += 0.5 * y + factor * (dz * x - dx * z);
  w[at + 2] += 0.5 * z + factor * (dx * y - dy * x);
}

/** out[3…6] = the quaternion at `from` times exp of the rotation vector. */
function turned(q: Numbers, from: number, [x, y, z]: number[], out: Numbers): void {
  const [ax, ay, az, aw] = [q[from], q[from + 1], q[from + 2], q[from + 3]];
  const angle = Math.hypot(x, y, z);
  const factor = angle < 1e-6 ? 0.5 : Math.sin(0.5 * angle) / angle;
  const [bx, by, bz, bw] = [factor * x, factor * y, factor * z, Math.cos(0.5 * angle)];
  const scale = 1 / (Math.hypot(ax, ay, az, aw) || 1);
  out[3] = scale * (aw * bx + ax * bw + ay * bz - az * by);
  out[4] = scale * (aw * by + ay * bw + az * bx - ax * bz);
  out[5] = scale * (aw * bz + az * bw + ax * by - ay * bx);
  out[6] = scale * (aw * bw - ax * bx - ay * by - az * bz);
}

export class Curve {
  /** Numbers of a row of slopes. */
  readonly tangentSize: number;

  // Of the step looked at, for each coordinate of the tangent; slopes by s.
  private readonly change: Float64Array;
  private readonly begin: Float64Array;
  private readonly end: Float64Array;

  constructor(
    private readonly configurations: Numbers,
    private readonly slopes: Numbers | null,
    private readonly size: number,
    private readonly floating: boolean,
  ) {
    this.tangentSize = floating ? size - 1 : size;
    this.change = new Float64Array(this.tangentSize);
    this.begin = new Float64Array(this.tangentSize);
    this.end = new Float64Array(this.tangentSize);
  }

  /** At a fraction of the step from a configuration to the next, which takes `duration` seconds. */
  configuration(index: number, duration: number, fraction: number, out: Numbers): void {
    this.load(index, duration);
    const first = index * this.size;
    const beyond = this.size - this.tangentSize;
    for (let k = this.floating ? 6 : 0; k < this.tangentSize; ++k) {
      out[k + beyond] = this.configurations[first + k + beyond] + this.travelled(fraction, k);
    }
    if (!this.floating) return;
    for (let k = 0; k < 3; ++k) {
      out[k] = this.configurations[first + k] + this.travelled(fraction, k);
    }
    const turn = [3, 4, 5].map((k) => this.travelled(fraction, k));
    turned(this.configurations, first + 3, turn, out);
  }

  /** Derivatives of the joints by time there; duration > 0. */
  jointRates(index: number, duration: number, fraction: number, rates: Numbers): void {
    this.load(index, duration);
    const first = this.floating ? 6 : 0;
    for (let k = first; k < this.tangentSize; ++k) {
      const rate = hermiteRate(fraction, this.begin[k], this.end[k], this.change[k]);
      rates[k - first] = rate / duration;
    }
  }

  /**
   * The slope of the parabola through a configuration and those before and after it, which lie
   * `before` and `after` seconds from it; both > 0.
   */
  threePointSlope(index: number, before: number, after: number, slope: Numbers): void {
    const { change, tangentSize } = this;
    const total = before + after;
    this.measure(index - 1);
    for (let k = 0; k < tangentSize; ++k) slope[k] = (after / before / total) * change[k];
    this.measure(index);
    for (let k = 0; k < tangentSize; ++k) slope[k] += (before / after / total) * change[k];
  }

  private travelled(fraction: number, k: number): number {
    return hermite(fraction, this.begin[k], this.end[k], this.change[k]);
  }

  /** Fills `change`, of the step from a configuration to the next. */
  private measure(index: number): void {
    const { configurations, size, change } = this;
    const a = index * size;
    const b = a + size;
    const beyond = size - this.tangentSize;
    for (let k = this.floating ? 6 : 0; k < this.tangentSize; ++k) {
      change[k] = configurations[b + k + beyond] - configurations[a + k + beyond];
    }
    if (!this.floating) return;
    for (let k = 0; k < 3; ++k) change[k] = configurations[b + k] - configurations[a + k];
    turnBetween(configurations, a + 3, b + 3, change, 3);
  }

  /** Fills `change`, `begin` and `end`. */
  private load(index: number, duration: number): void {
    this.measure(index);
    const { change, begin, end, slopes, tangentSize } = this;
    if (!slopes) {
      begin.set(change);
      end.set(change);
      return;
    }
    const first = index * tangentSize;
    for (let k = 0; k < tangentSize; ++k) {
      begin[k] = duration * slopes[first + k];
      end[k] = duration * slopes[first + tangentSize + k];
    }
    if (this.floating) inverseRightJacobian(change, end, 3);
  }
}
