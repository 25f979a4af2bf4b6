// Scenes for the tests and the benchmark: a four-wheeled robot, plans, voxels and pose graphs, as
// doc/scene_format.md describes them. Everything has a closed form, so that tests know what to see.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const TEMPLATE = fileURLToPath(new URL('../dist/template.html', import.meta.url));
const PLACE = '<script type="application/json" id="locograph-scene">{}</script>';
const WHEEL_RADIUS = 0.1;
export const BASE_HEIGHT = 0.7;
export const SPEED = 0.25; // m/s

export const pose = (x = 0, y = 0, z = 0) => [x, y, z, 0, 0, 0, 1];

export function pack(numbers, Type = Float32Array) {
  return Buffer.from(Type.from(numbers).buffer).toString('base64');
}

/** The page with a scene (an object, or raw text) inside. */
export function page(scene) {
  const template = readFileSync(TEMPLATE, 'utf8');
  if (!template.includes(PLACE)) throw new Error('the template has no place for a scene');
  const text = typeof scene === 'string' ? scene : JSON.stringify(scene);
  const [before, after] = template.split(PLACE);
  return `${before}${PLACE.replace('{}', () => text.replaceAll('<', '\\u003c'))}${after}`;
}

/** A base with four legs of `perLeg` joints that end in wheels. */
export function robot(perLeg = 3) {
  const blue = [0.05, 0.3, 0.9, 1];
  const links = [
    {
      name: 'base',
      mass: 20,
      com: [0, 0, 0],
      visual: [{ type: 'box', pose: pose(), size: [0.8, 0.4, 0.2], color: blue }],
      collision: [{ type: 'capsule', pose: pose(), radius: 0.25, length: 0.4 }],
    },
  ];
  const joints = [];
  const drop = (BASE_HEIGHT - WHEEL_RADIUS) / perLeg;
  for (let leg = 0; leg < 4; ++leg) {
    const x = leg < 2 ? 0.35 : -0.35;
    const y = leg % 2 ? -0.3 : 0.3;
    for (let k = 0; k < perLeg; ++k) {
      const last = k === perLeg - 1;
      const axle = [0, Math.SQRT1_2, Math.SQRT1_2, 0];
      links.push({
        name: last ? `wheel_${leg + 1}` : `leg_${leg + 1}_${k + 1}`,
        mass: 2,
        com: [0, 0, 0],
        visual: last
          ? [
              {
                type: 'cylinder',
                pose: [0, 0, 0, ...axle],
                radius: WHEEL_RADIUS,
                length: 0.08,
                color: [0.1, 0.1, 0.12, 1],
              },
            ]
          : [
              {
                type: 'capsule',
                pose: pose(0, 0, -drop / 2),
                radius: 0.05,
                length: drop,
                color: blue,
              },
            ],
        collision: [{ type: 'sphere', pose: pose(), radius: WHEEL_RADIUS }],
      });
      joints.push({
        name: last ? `axle_${leg + 1}` : `joint_${leg + 1}_${k + 1}`,
        type: last ? 'continuous' : 'revolute',
        parent: k === 0 ? 0 : links.length - 2,
        child: links.length - 1,
        origin: k === 0 ? pose(x, y, -drop) : pose(0, 0, -drop),
        axis: [0, 1, 0],
        lower: last ? null : -1,
        upper: last ? null : 1,
        velocity: 5,
        effort: 100,
        index: joints.length,
        frozen: 0,
      });
    }
  }
  return { name: 'testbot', floating_base: true, links, joints, meshes: [] };
}

/** Three arms of 1 m, at the joint's position q, at 0.2 - 2 q, and at rest; one a second. */
export function mimicScene(positions) {
  const arm = (name) => ({
    name,
    mass: 1,
    com: [1, 0, 0],
    visual: [{ type: 'sphere', pose: pose(1), radius: 0.1 }],
  });
  const joint = (name, child, more) => ({
    name,
    type: 'revolute',
    parent: 0,
    child,
    origin: pose(),
    axis: [0, 0, 1],
    index: -1,
    frozen: 0,
    ...more,
  });
  return {
    version: 1,
    kind: 'plan',
    title: 'mimic',
    robot: {
      name: 'mimic',
      links: [{ name: 'base', mass: 0 }, arm('one'), arm('two'), arm('three'), { name: 'held' }],
      joints: [
        joint('second', 2, { mimics: 1, multiplier: -2, offset: 0.2 }),
        joint('first', 1, { index: 0 }),
        joint('held', 4, { frozen: 0.3 }),
        joint('third', 3, { mimics: 2, multiplier: 2, frozen: 0.6 }),
      ],
    },
    plan: {
      times: positions.map((_, i) => i),
      configurations: pack(positions),
      configuration_size: 1,
    },
  };
}

/** Drives straight on; legs stay, wheels roll; base at x = SPEED t. */
export function planScene({ count = 41, step = 0.5, perLeg = 3, voxels = 300 } = {}) {
  const model = robot(perLeg);
  const size = 7 + model.joints.length;
  const times = [];
  const configurations = [];
  const contacts = [];
  for (let i = 0; i < count; ++i) {
    const x = SPEED * step * i;
    times.push(step * i);
    configurations.push(x, 0, BASE_HEIGHT, 0, 0, 0, 1);
    for (const joint of model.joints) {
      configurations.push(joint.type === 'continuous' ? x / WHEEL_RADIUS : 0);
    }
    contacts.push(
      [0, 1, 2, 3].map((leg) => ({
        link: perLeg * (leg + 1),
        kind: 'wheel',
        radius: WHEEL_RADIUS,
        friction: 0.5,
        position: [x + (leg < 2 ? 0.35 : -0.35), leg % 2 ? -0.3 : 0.3, 0],
        normal: [0, 0, 1],
        force: [5, 0, ((20 + 8 * perLeg) * 9.80665) / 4],
      })),
    );
  }
  const end = times[count - 1];
  return {
    version: 1,
    kind: 'plan',
    title: 'test <plan>.g2o',
    robot: model,
    plan: {
      times,
      configurations: pack(configurations),
      configuration_size: size,
      reference: pack(configurations),
      ids: times.map((_, i) => i),
      contacts,
      executed: Math.floor(count / 4),
      window: Math.floor(count / 4),
      series: [
        { name: 'clearance', unit: 'm', limit: 0, values: pack(times.map((t) => Math.cos(t))) },
      ],
    },
    map: { resolution: 0.05, voxels: pack(wall(voxels)) },
    surfaces: [{ name: 'plate', pose: pose(2, -1.2, 0.3), size: [0.5, 0.5] }],
    obstacles: [
      { name: 'pillar', type: 'cylinder', size: [0.1, 1], pose: pose(3, 1, 0.5) },
      {
        name: 'cart',
        type: 'box',
        size: [0.3, 0.3, 0.3],
        pose: pose(4, -1, 0.15),
        keyframes: [{ time: end / 2, pose: pose(4, 1, 0.15) }],
        repeat: end,
      },
    ],
    check: {
      feasible: false,
      min_clearance_m: -0.03,
      max_velocity_ratio: 0.5,
      trusted: ['wheel_1: what it can bear'],
      violations: [
        {
          constraint: 'joint_limits',
          violated: false,
          worst: -0.4,
          unit: 'rad',
          limit: 0,
          at_vertex: 3,
          index: 3,
          count: 0,
          time: times[3],
          at_point: [0, 0, 0.5],
          what: 'joint_1_1',
        },
        {
          constraint: 'torque_limits',
          violated: false,
          judged: false,
          worst: null,
          unit: 'ratio',
          limit: 1,
          at_vertex: null,
          count: 0,
          why: 'no stance is known',
        },
        {
          constraint: 'obstacle_distance',
          violated: true,
          worst: -0.03,
          unit: 'm',
          limit: 0,
          at_vertex: 30,
          index: 30,
          count: 4,
          time: times[30],
          at_point: [SPEED * times[30] + 0.4, 0, 0.6],
          what: 'base and pillar',
        },
      ],
    },
  };
}

/** Sets off from rest and speeds up, in two steps of 2 s; the base is at x = distance(t). */
export function rollingScene() {
  const distance = (t) => 0.05 * t * t;
  const { check, ...scene } = planScene({ count: 3, step: 2 });
  const { joints } = scene.robot;
  const row = (x) => joints.map(({ type }) => (type === 'continuous' ? x / WHEEL_RADIUS : 0));
  const { plan } = scene;
  const places = plan.times.map(distance);
  plan.configurations = pack(places.flatMap((x) => [...pose(x, 0, BASE_HEIGHT), ...row(x)]));
  plan.slopes = pack(plan.times.flatMap((t) => [0.1 * t, 0, 0, 0, 0, 0, ...row(0.1 * t)]));
  plan.contacts.forEach((contacts, i) =>
    contacts.forEach(({ position }, k) => (position[0] = places[i] + (k < 2 ? 0.35 : -0.35))),
  );
  return { scene, distance };
}

/** Ten metres in 40 s, past an orange box that stands beside the way after five metres. */
export function farScene() {
  const { map, surfaces, check, ...scene } = planScene({ step: 1 });
  const place = pose(5, -0.9, 0.15);
  const keyframes = [{ time: 20, pose: place }];
  scene.obstacles = [{ name: 'cart', type: 'box', size: [0.3, 0.3, 0.3], pose: place, keyframes }];
  return scene;
}

/** Cubes of 5 cm: a wall two cubes thick along y = 2. */
function wall(count) {
  const numbers = [];
  const long = Math.max(10, Math.ceil(Math.sqrt(count / 2) * 1.6));
  for (let i = 0; i < count; ++i) {
    const [column, layer, row] = [i % long, Math.floor(i / long) % 2, Math.floor(i / (2 * long))];
    numbers.push(0.05 * column - 1, 2 + 0.05 * layer, 0.05 * row + 0.025, 0.05);
  }
  return numbers;
}

/** Stances of soles, on all four or without one, 0.125 m apart, on a floor before a rail. */
export function stancesScene(count = 5) {
  const scene = planScene({ count, voxels: 0 });
  const all = [1, 2, 3, 4].map((k) => `wheel_${k}`);
  const lifted = Array.from({ length: count }, (_, i) => (i % 2 ? all[(i >> 1) % 4] : null));
  const sole = ({ link, position: [x, y, z], force }) => ({
    link,
    kind: 'surface',
    position: [x, y, z],
    normal: [0, 0, 1],
    friction: 0.5,
    force,
    area: [
      [x + 0.2, y + 0.15, z],
      [x - 0.2, y + 0.15, z],
      [x - 0.2, y - 0.15, z],
      [x + 0.2, y - 0.15, z],
    ],
  });
  const { plan } = scene;
  plan.contacts = plan.contacts.map((contacts, i) =>
    contacts.filter((_, k) => all[k] !== lifted[i]).map(sole),
  );
  delete plan.executed;
  delete plan.window;
  return {
    version: 1,
    kind: 'plan',
    title: 'stances.g2o',
    robot: scene.robot,
    plan: { ...plan, stances_only: true },
    stances: lifted.map((name, i) => ({
      from: i,
      to: Math.min(i + 1, count - 1),
      contacts: all.filter((other) => other !== name),
    })),
    surfaces: [
      { name: 'floor', pose: pose(0.2), size: [3, 2] },
      { name: 'wall', pose: [1.7, 0, 0.5, 0, -Math.SQRT1_2, 0, Math.SQRT1_2], size: [1, 2] },
    ],
    bars: [{ name: 'rail', from: [-1, 0.8, 0.8], to: [1.5, 0.8, 0.8], radius: 0.03 }],
  };
}

/**
 * A tree over those stances: the way along them, a move each, and from each a found move to one side
 * and a failed one to the other, all 0.9 m above the floor.
 */
export function stancesTree(count = 5) {
  const centres = [];
  const parents = [];
  const states = [];
  const add = (x, y, parent, state) => {
    centres.push(x, y, 0.9);
    parents.push(parent);
    states.push(state);
    return parents.length - 1;
  };
  let last = -1;
  for (let i = 0; i < count; ++i) {
    last = add(0.125 * i, 0, last, 2);
    add(0.125 * i, 0.8, last, 1);
    add(0.125 * i, -0.8, last, 0);
  }
  return { centres: pack(centres), parents: pack(parents, Int32Array), states: pack(states, Int32Array) };
}

/** The map around the robot, as doc/scene_format.md packs it. */
export function localMap(time, first, size, states) {
  const bytes = [];
  for (let at = 0, end = 0; at < states.length; at = end) {
    while (end < states.length && states[end] === states[at]) ++end;
    let run = 3 * (end - at) + states[at];
    for (; run > 127; run = Math.floor(run / 128)) bytes.push((run % 128) | 128);
    bytes.push(run);
  }
  return { time, first, size, states: pack(bytes, Uint8Array) };
}

/**
 * The drive with a camera that looks down from 3 m above its start, 4 × 2 squares of 1 pixel, and
 * another one that never shows anything. At -0.1 s the first row shows the floor, the second one, in
 * this order, two pixels of the robot 2 m below the camera, one beyond the range and one of a thing;
 * at 9.9 s all of them show the floor. In a map of 4 × 4 × 2 m a column of voxels of 0.1 m is occupied
 * at x = 1.25 m, y = 0.65 m; from 10 s on it is gone.
 */
export function perceptionScene() {
  const down = [0, 0, 3, 1, 0, 0, 0]; // half a turn about x
  const camera = (name) => ({
    name,
    square: 1,
    between: 1,
    columns: 4,
    rows: 2,
    focal: [2, 2],
    centre: [1.5, 0.5],
    range: 4,
  });
  const cloud = (stamp, depths) => ({
    camera: 0,
    stamp,
    pose: down,
    places: pack(Array(8).fill(0), Uint8Array),
    depths: pack(depths, Int16Array),
  });
  const size = [40, 40, 20];
  const states = Array(size[0] * size[1] * size[2]).fill(1);
  const free = [...states];
  for (let k = 0; k < size[2]; ++k) states[(k * size[1] + 26) * size[0] + 22] = 2;
  return {
    ...planScene({ voxels: 0 }),
    perception: {
      cameras: [camera('above'), camera('covered')],
      resolution: 0.1,
      unknown: 'free',
      floor: 0.05,
      clouds: [
        cloud(-0.1, [1500, 1500, 1500, 1500, -1000, -1000, 2500, 1000]),
        cloud(9.9, Array(8).fill(1500)),
      ],
      maps: [localMap(0, [-10, -20, 0], size, states), localMap(10, [-10, -20, 0], size, free)],
    },
  };
}

/** Poses on a spiral over a sphere, with loop closures between its rounds. */
export function sphereGraph({ rounds = 25, each = 50, radius = 50 } = {}) {
  const vertices = [];
  const before = [];
  const edges = [];
  const count = rounds * each;
  for (let i = 0; i < count; ++i) {
    const height = (2 * (i + 0.5)) / count - 1;
    const angle = (2 * Math.PI * i) / each;
    const ring = radius * Math.sqrt(1 - height * height);
    const at = [ring * Math.cos(angle), ring * Math.sin(angle), radius * height];
    vertices.push(...at, 0, 0, 0, 1);
    before.push(at[0] + 8 * Math.sin(i / 90), at[1] + 0.01 * i, at[2], 0, 0, 0, 1);
    if (i > 0) edges.push(i - 1, i);
    if (i >= each) edges.push(i - each, i);
  }
  return {
    version: 1,
    kind: 'pose_graph',
    title: 'sphere.g2o',
    graph: {
      dimension: 3,
      vertices: pack(vertices),
      before: pack(before),
      edges: pack(edges, Int32Array),
      chi2: [2500000, 727.1],
    },
  };
}

/** A square of 4 × `side` planar poses, ends joined, with one landmark in its middle. */
export function squareGraph(side = 10) {
  const vertices = [];
  const edges = [];
  for (let i = 0; i < 4 * side; ++i) {
    const [edge, k] = [Math.floor(i / side), i % side];
    const [x, y] = [
      [k, 0],
      [side, k],
      [side - k, side],
      [0, side - k],
    ][edge];
    vertices.push(x, y, 0, 0, 0, 0, 1);
    edges.push(i, (i + 1) % (4 * side));
  }
  return {
    version: 1,
    kind: 'pose_graph',
    title: 'square.g2o',
    graph: {
      dimension: 2,
      vertices: pack(vertices),
      edges: pack(edges, Int32Array),
      points: pack([side / 2, side / 2, 0]),
      chi2: [10, 1],
    },
  };
}
