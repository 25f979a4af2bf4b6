/**
 * The scene inside the page, as doc/scene_format.md describes it: types, and how it is read.
 *
 * Metres, radians, seconds; world frame z up; a pose is [x, y, z, qx, qy, qz, qw].
 */

export type Pose = number[];
export type Vector = [number, number, number];

export interface ShapeDescription {
  type: 'sphere' | 'capsule' | 'cylinder' | 'box' | 'mesh';
  pose?: Pose;
  radius?: number;
  length?: number;
  size?: number[];
  mesh?: number;
  scale?: number[];
  color?: number[];
}

export interface LinkDescription {
  name: string;
  mass?: number;
  com?: number[];
  visual?: ShapeDescription[];
  collision?: ShapeDescription[];
}

export interface JointDescription {
  name: string;
  type: string;
  parent: number;
  child: number;
  origin?: Pose;
  axis?: number[];
  lower?: number | null;
  upper?: number | null;
  velocity?: number | null;
  effort?: number | null;
  index?: number;
  frozen?: number;
  /** The joint that leads this one: its position is multiplier · that of the leader + offset. */
  mimics?: number;
  multiplier?: number;
  offset?: number;
}

export interface RobotDescription {
  name: string;
  floating_base?: boolean;
  links: LinkDescription[];
  joints: JointDescription[];
  meshes?: { name: string; triangles: string }[];
  missing?: string[];
}

export interface Contact {
  link: number;
  kind: string;
  position: Vector;
  normal: Vector;
  radius?: number;
  friction?: number;
  /** Corners of what of a surface contact bears, as they go round; two: a line. */
  area?: Vector[];
  force?: Vector;
  moment?: Vector;
}

export interface Series {
  name: string;
  unit?: string;
  values: string;
  limit?: number;
}

export interface PlanDescription {
  times?: number[];
  configurations: string;
  configuration_size: number;
  /** Of the plan's curve; without them the way between configurations is straight. */
  slopes?: string;
  /** Nothing moves between configurations, and times mean nothing. */
  stances_only?: boolean;
  reference?: string;
  /** What was measured when a plan was carried out; the reference is where that had the robot. */
  recorded?: boolean;
  torques?: string;
  ids?: number[];
  executed?: number;
  window?: number;
  contacts?: Contact[][];
  series?: Series[];
}

export interface Stance {
  from: number;
  to: number;
  contacts: string[];
}

export interface Violation {
  constraint: string;
  violated: boolean;
  /** False: nobody looked, and `why` says why not; never to be shown as holding. */
  judged?: boolean;
  why?: string;
  worst?: number | null;
  unit?: string;
  limit?: number | null;
  at_vertex?: number | null;
  index?: number | null;
  count?: number;
  time?: number | null;
  at_point?: number[] | null;
  what?: string;
}

export interface CheckReport {
  feasible?: boolean;
  violations?: Violation[];
  /** What was taken on trust. */
  trusted?: string[];
  /** How far from falling the motion is. */
  robustness?: Record<string, unknown>;
  [figure: string]: unknown;
}

export interface ObstacleDescription {
  name?: string;
  type: 'box' | 'sphere' | 'cylinder';
  size: number[];
  pose?: Pose;
  keyframes?: { time: number; pose: Pose }[];
  repeat?: number;
  /** It is there from the one time to the other. */
  appears?: number;
  vanishes?: number;
}

export interface SurfaceDescription {
  name?: string;
  pose: Pose;
  size: number[];
}

export interface BarDescription {
  name?: string;
  from: Vector;
  to: Vector;
  radius: number;
}

export interface GraphDescription {
  dimension?: number;
  vertices: string;
  before?: string;
  edges?: string;
  points?: string;
  chi2?: number[];
}

/** What the search for stances tried; packed, for each node. */
export interface TreeDescription {
  /** Middles of the contacts. */
  centres: string;
  /** Earlier nodes; -1: a root. */
  parents: string;
  /** 0: failed, 1: found, 2: on the way to a goal. */
  states: string;
}

/** An image of a camera, its points thinned out. */
export interface CloudDescription {
  camera: number;
  stamp: number;
  /** Of the optical frame. */
  pose: Pose;
  /** For each square of pixels, row by row. Packed bytes: which of its pixels is shown. */
  places: string;
  /** Packed int16: its depth in units of 2 mm, negative: taken by the self-filter; 0: none. */
  depths: string;
}

/** The voxels around the robot. */
export interface LocalMapDescription {
  time: number;
  /** Index of the lowest voxel; voxel (i, j, k) is from i to i + 1 times the resolution, … */
  first: Vector;
  size: Vector;
  /** Packed bytes, runs as perception.ts reads them. */
  states: string;
}

/** What has been seen: all of it, or what is new. */
export interface SeenDescription {
  clouds: CloudDescription[];
  maps: LocalMapDescription[];
}

export interface PerceptionDescription extends SeenDescription {
  cameras: {
    name: string;
    /** Pixels along the sides of the squares of which a cloud has one each. */
    square: number;
    /** Pixels from one that may be shown to the next. */
    between: number;
    /** Of squares. */
    columns: number;
    rows: number;
    /** In pixels. */
    focal: [number, number];
    centre: [number, number];
    /** Depth beyond which nothing goes into the map. */
    range: number;
  }[];
  resolution: number;
  unknown: 'free' | 'occupied';
  /** What is seen below this height is the floor. */
  floor?: number;
}

export interface Scene {
  version: number;
  kind: 'plan' | 'pose_graph';
  title: string;
  robot?: RobotDescription;
  plan?: PlanDescription;
  stances?: Stance[];
  tree?: TreeDescription;
  perception?: PerceptionDescription;
  map?: { resolution?: number; voxels: string; left_out?: number };
  surfaces?: SurfaceDescription[];
  bars?: BarDescription[];
  obstacles?: ObstacleDescription[];
  check?: CheckReport;
  graph?: GraphDescription;
  live?: string;
}

/** A scene that cannot be shown: says what is wrong and what was expected. */
export class SceneError extends Error {}

/** The scene in the page. Throws SceneError. */
export function readScene(document: Document): Scene {
  const text = document.getElementById('locograph-scene')?.textContent?.trim() ?? '';
  if (text === '' || text === '{}') {
    throw new SceneError(
      'This page holds no scene. Write one with `locograph view PLAN.g2o -o OUT.html`.',
    );
  }
  let scene: Scene;
  try {
    scene = JSON.parse(text) as Scene;
  } catch (error) {
    throw new SceneError(`The scene is not valid JSON: ${(error as Error).message}.`);
  }
  validate(scene);
  return scene;
}

function require(condition: unknown, message: string): asserts condition {
  if (!condition) throw new SceneError(message);
}

function validate(scene: Scene): void {
  require(scene.version ===
    1, `The scene has version ${String(scene.version)}; this viewer shows version 1.`);
  require(scene.kind === 'plan' ||
    scene.kind ===
      'pose_graph', `The scene is of kind "${String(scene.kind)}"; expected "plan" or "pose_graph".`);
  if (scene.kind === 'pose_graph') {
    require(scene.graph?.vertices, 'The pose graph holds no vertices: there is nothing to show.');
    return;
  }
  require(scene.robot ||
    scene.map ||
    scene.surfaces ||
    scene.bars ||
    scene.obstacles, 'The scene holds neither a robot nor a world: there is nothing to show.');
  if (scene.robot) validateRobot(scene.robot);
  if (scene.plan) {
    require(scene.robot, 'The scene holds a plan but no robot that follows it.');
    require(scene.plan.configuration_size >
      0, `The plan says configuration_size ${scene.plan.configuration_size}; expected a positive number.`);
    require(scene.plan.configurations, 'The plan is empty: it holds no configurations.');
  }
}

function validateRobot(robot: RobotDescription): void {
  require(Array.isArray(robot.links) &&
    robot.links.length > 0, `Robot "${robot.name}" has no links.`);
  for (const joint of robot.joints ?? []) {
    const leader = joint.mimics;
    require(leader === undefined ||
      robot.joints[leader] !==
        undefined, `Joint "${joint.name}" follows joint ${leader}; the robot has ${robot.joints.length} joints.`);
    for (const end of [joint.parent, joint.child]) {
      require(Number.isInteger(end) &&
        end >= 0 &&
        end <
          robot.links
            .length, `Joint "${joint.name}" refers to link ${end}; the robot has ${robot.links.length} links.`);
    }
  }
}

function bytesOf(packed: string, numberSize: number, what: string): ArrayBuffer {
  let text: string;
  try {
    text = atob(packed);
  } catch {
    throw new SceneError(`The numbers of ${what} are not base64.`);
  }
  require(text.length % numberSize ===
    0, `The numbers of ${what} are cut off: ${text.length} bytes.`);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

/** Rows of `width` little-endian float32 numbers. */
export function unpackFloats(packed: string, width: number, what: string): Float32Array {
  const numbers = new Float32Array(bytesOf(packed, 4, what));
  require(numbers.length % width ===
    0, `${what}: ${numbers.length} numbers are not whole rows of ${width}.`);
  return numbers;
}

/** Rows of `width` little-endian int32 numbers. */
export function unpackIntegers(packed: string, width: number, what: string): Int32Array {
  const numbers = new Int32Array(bytesOf(packed, 4, what));
  require(numbers.length % width ===
    0, `${what}: ${numbers.length} numbers are not whole rows of ${width}.`);
  return numbers;
}

/** `count` little-endian int16 numbers. */
export function unpackShorts(packed: string, count: number, what: string): Int16Array {
  const numbers = new Int16Array(bytesOf(packed, 2, what));
  require(numbers.length === count, `${what}: ${numbers.length} numbers instead of ${count}.`);
  return numbers;
}

export function unpackBytes(packed: string, what: string): Uint8Array {
  return new Uint8Array(bytesOf(packed, 1, what));
}
