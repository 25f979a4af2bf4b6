// The curve of a plan, and the plan on it. No browser.
import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { pack, rollingScene } from './scenes.mjs';
import { source } from './sources.mjs';

const { Curve, turnBetween } = await source('curve');
const { Plan } = await source('plan');
const { ContactTrack } = await source('contacts');
const { Kinematics } = await source('kinematics');

/** Numbers in -1…1, the same in each run. */
function random(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 31 - 1;
  };
}

function assertNear(actual, expected, tolerance) {
  assert.equal(actual.length, expected.length);
  expected.forEach((value, k) =>
    assert.ok(
      Math.abs(actual[k] - value) <= tolerance,
      `${[...actual]} is not near ${[...expected]}`,
    ),
  );
}

/** A floating base with two joints: two configurations and their slopes. */
function floatingStep(seed, angle) {
  const next = random(seed);
  const unit = (n) => {
    const v = Array.from({ length: n }, next);
    return v.map((x) => x / Math.hypot(...v));
  };
  const from = unit(4);
  const turn = [...unit(3).map((x) => x * Math.sin(angle / 2)), Math.cos(angle / 2)];
  const to = product(from, turn);
  const rows = [from, to].map((q) => [next(), next(), next(), ...q, next(), next()]);
  return {
    configurations: Float64Array.from(rows.flat()),
    slopes: Float64Array.from({ length: 16 }, next),
  };
}

function product([ax, ay, az, aw], [bx, by, bz, bw]) {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by + ay * bw + az * bx - ax * bz,
    aw * bz + az * bw + ax * by - ay * bx,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

/** How a curve moves at a fraction, along the base's own axes for its rotation, by differences. */
function tangent(curve, duration, fraction) {
  const d = 1e-5;
  const [a, b] = [-d, d].map((step) => {
    const out = new Float64Array(9);
    curve.configuration(0, duration, fraction + step, out);
    return out;
  });
  const turn = new Float64Array(3);
  turnBetween(Float64Array.from([...a.slice(3, 7), ...b.slice(3, 7)]), 0, 4, turn);
  const change = [0, 1, 2].map((k) => b[k] - a[k]);
  change.push(...turn, b[7] - a[7], b[8] - a[8]);
  return change.map((x) => x / (2 * d * duration));
}

describe('the curve of a step', () => {
  it('is the cubic itself where a joint follows a cubic', () => {
    const at = (t) => t ** 3 - 2 * t ** 2 + 0.5 * t - 1;
    const rate = (t) => 3 * t ** 2 - 4 * t + 0.5;
    const [t0, t1] = [0.3, 2];
    const curve = new Curve(
      Float64Array.of(at(t0), at(t1)),
      Float64Array.of(rate(t0), rate(t1)),
      1,
      false,
    );
    const out = new Float64Array(1);
    for (const s of [0, 0.1, 0.5, 0.77, 1]) {
      const t = t0 + s * (t1 - t0);
      curve.configuration(0, t1 - t0, s, out);
      assertNear(out, [at(t)], 1e-12);
      curve.jointRates(0, t1 - t0, s, out);
      assertNear(out, [rate(t)], 1e-12);
    }
  });

  for (const angle of [0, 1e-5, 0.4, 1.7, 3.1]) {
    it(`has its slopes at both ends, also of a base that turns by ${angle}`, () => {
      for (let seed = 1; seed <= 20; ++seed) {
        const { configurations, slopes } = floatingStep(seed, angle);
        const curve = new Curve(configurations, slopes, 9, true);
        const out = new Float64Array(9);
        for (const end of [0, 1]) {
          curve.configuration(0, 0.7, end, out);
          assertNear(out.slice(0, 3), configurations.slice(9 * end, 9 * end + 3), 1e-12);
          assertNear(out.slice(7), configurations.slice(9 * end + 7, 9 * end + 9), 1e-12);
          const both = Float64Array.of(
            ...out.slice(3, 7),
            ...configurations.slice(9 * end + 3, 9 * end + 7),
          );
          const off = new Float64Array(3);
          turnBetween(both, 0, 4, off);
          assertNear(off, [0, 0, 0], 1e-12);
          assertNear(tangent(curve, 0.7, end), slopes.slice(8 * end, 8 * end + 8), 1e-7);
        }
      }
    });
  }

  it('has the derivatives of its joints as their rates', () => {
    const { configurations, slopes } = floatingStep(7, 1);
    const curve = new Curve(configurations, slopes, 9, true);
    const rates = new Float64Array(2);
    for (const s of [0, 0.2, 0.6, 1]) {
      curve.jointRates(0, 0.7, s, rates);
      assertNear(rates, tangent(curve, 0.7, s).slice(6), 1e-7);
    }
  });

  it('does not depend on the sign of a quaternion', () => {
    const { configurations, slopes } = floatingStep(3, 2);
    const other = configurations.slice();
    for (let k = 12; k < 16; ++k) other[k] *= -1;
    const [a, b] = [configurations, other].map((numbers) => {
      const out = new Float64Array(9);
      new Curve(numbers, slopes, 9, true).configuration(0, 0.7, 0.3, out);
      return out;
    });
    assertNear(a, b, 1e-12);
  });

  it('turns about an axis by the cubic of the angle', () => {
    const pose = (angle) => [0, 0, 0, 0, 0, Math.sin(angle / 2), Math.cos(angle / 2)];
    const configurations = Float64Array.of(...pose(0.5), ...pose(1.5));
    const slopes = Float64Array.of(0, 0, 0, 0, 0, 0.4, 0, 0, 0, 0, 0, -0.2);
    const out = new Float64Array(7);
    new Curve(configurations, slopes, 7, true).configuration(0, 2, 0.25, out);
    // Basis functions of Hermite at a quarter.
    assertNear(out, pose(0.5 + 0.15625 + 0.140625 * 0.8 + 0.046875 * 0.4), 1e-12);
  });

  it('is straight, at one speed, without slopes', () => {
    const { configurations } = floatingStep(5, 1.2);
    const curve = new Curve(configurations, null, 9, true);
    const straight = tangent(curve, 2, 0.5);
    assertNear(
      [7, 8].map((k) => (configurations[9 + k] - configurations[k]) / 2),
      straight.slice(6),
      1e-9,
    );
    assert.ok(Math.abs(Math.hypot(...straight.slice(3, 6)) - 0.6) < 1e-9);
    assertNear(tangent(curve, 2, 0.1), straight, 1e-9);
  });
});

describe('a plan', () => {
  const times = [0, 0.5, 1.5, 2, 3];
  const description = (q, slopes) => ({
    times,
    configurations: pack(q),
    configuration_size: 1,
    ...(slopes && { slopes: pack(slopes) }),
  });
  const at = (plan, t) => {
    const out = new Float32Array(1);
    plan.sample(t, out);
    return out[0];
  };
  const rate = (plan, t) => {
    const out = new Float32Array(1);
    plan.velocities(t, out);
    return out[0];
  };
  const parabola = (t) => 1 - 2 * t + 0.75 * t * t;
  const rises = (t) => -2 + 1.5 * t;
  const near = (a, b, tolerance = 1e-5) => assert.ok(Math.abs(a - b) < tolerance, `${a}, not ${b}`);

  it('follows its curve, with its derivative as the joint velocity', () => {
    const plan = new Plan(description(times.map(parabola), times.map(rises)), false);
    for (const t of [0, 0.2, 0.5, 1.1, 1.9, 2.99, 3]) {
      near(at(plan, t), parabola(t));
      near(rate(plan, t), rises(t));
    }
  });

  it('goes straight on without slopes', () => {
    const plan = new Plan(description([0, 1, 1, 3, 0]), false);
    near(at(plan, 0.1), 0.2);
    near(rate(plan, 0.1), 2);
    near(at(plan, 1.75), 2);
    near(rate(plan, 3), -3);
  });

  it('stands still in each of its stances, whatever slopes it has', () => {
    const stances = { ...description([0, 1, 2, 3, 4], [1, 1, 1, 1, 1]), stances_only: true };
    const plan = new Plan(stances, false);
    assert.equal(plan.slopes, null);
    near(at(plan, 1.5), 1);
    near(rate(plan, 1.5), 0);
  });

  it('takes the slopes of three points where configurations are replaced, in any order', () => {
    for (const order of [
      [0, 1, 2, 3, 4],
      [3, 0, 4, 2, 1],
    ]) {
      const plan = new Plan(description([0, 0, 0, 0, 0], [9, 9, 9, 9, 9]), false);
      for (const i of order) assert.ok(plan.replace(i, [parabola(times[i])]));
      assertNear(plan.slopes, [0, rises(0.5), rises(1.5), rises(2), 0], 1e-5);
      near(at(plan, 1.7), parabola(1.7));
      near(rate(plan, 1.7), rises(1.7));
      near(rate(plan, 3), 0);
      plan.restoreSlopes();
      assertNear(plan.slopes, [9, 9, 9, 9, 9], 0);
    }
  });

  it('keeps the slopes of what is not replaced', () => {
    const plan = new Plan(description([0, 0, 0, 0, 0], [9, 8, 7, 6, 5]), false);
    plan.replace(2, [3]);
    // 3 up in 1 s, 3 down in 0.5 s.
    assertNear(plan.slopes, [9, 8, -3, 6, 5], 1e-5);
  });

  it('rests where the stance changes', () => {
    const stances = [
      { from: 0, to: 2, contacts: ['a'] },
      { from: 2, to: 4, contacts: ['b'] },
    ];
    const plan = new Plan(description([0, 0, 0, 0, 0], [9, 9, 9, 9, 9]), false, stances);
    times.forEach((t, i) => plan.replace(i, [parabola(t)]));
    assertNear(plan.slopes, [0, rises(0.5), 0, rises(2), 0], 1e-5);
  });

  it('refuses slopes that are not of all configurations', () => {
    assert.throws(
      () => new Plan(description([0, 1, 2, 3, 4], [1, 1, 1, 1]), false),
      /5 configurations but slopes of 4/,
    );
  });
});

describe('a contact', () => {
  it('stays under the wheel that the curve takes along', () => {
    const { scene, distance } = rollingScene();
    const kinematics = new Kinematics(scene.robot);
    const plan = new Plan(scene.plan, true);
    const track = new ContactTrack(plan, new Kinematics(scene.robot));
    const configuration = new Float32Array(plan.size);
    for (const t of [0, 0.5, 1.3, 2, 3.9, 4]) {
      plan.sample(t, configuration);
      kinematics.update(configuration);
      track.update(t, kinematics);
      track.current.forEach(({ position }, i) => {
        assertNear(position, [distance(t) + (i < 2 ? 0.35 : -0.35), i % 2 ? -0.3 : 0.3, 0], 1e-5);
      });
    }
  });
});
