/**
 * Forward kinematics, centre of mass and static joint torques of the scene's robot.
 *
 *     const kinematics = new Kinematics(scene.robot);
 *     kinematics.update(configuration);          // base pose (if floating), then joints
 *     kinematics.worldFromLink[3];               // Matrix4
 *
 * No allocation after construction.
 */
import { Matrix4, Quaternion, Vector3 } from 'three';
import { Contact, JointDescription, Pose, RobotDescription, SceneError } from './scene_format';

const GRAVITY = 9.80665;

export function matrixOf(pose: Pose | undefined, target = new Matrix4()): Matrix4 {
  if (!pose || pose.length < 7) return target.identity();
  return target.compose(
    new Vector3(pose[0], pose[1], pose[2]),
    new Quaternion(pose[3], pose[4], pose[5], pose[6]).normalize(),
    new Vector3(1, 1, 1),
  );
}

interface Joint {
  description: JointDescription;
  parent: number;
  child: number;
  origin: Matrix4;
  axis: Vector3;
  prismatic: boolean;
  moves: boolean;
  /** In a configuration's joints, of the joint itself or of the one it follows; -1: stands still. */
  index: number;
  multiplier: number;
  offset: number;
}

export class Kinematics {
  readonly floating: boolean;
  readonly worldFromLink: Matrix4[];
  readonly joints: Joint[];
  /** Joints that a configuration moves, by their index in it. */
  readonly moving: JointDescription[] = [];
  readonly mass: number;
  readonly root: number;

  private readonly masses: number[];
  private readonly coms: Vector3[];
  private readonly motion = new Matrix4();
  private readonly position = new Vector3();
  private readonly rotation = new Quaternion();
  private readonly unitScale = new Vector3(1, 1, 1);
  private readonly point = new Vector3();
  private readonly axis = new Vector3();
  private readonly wrenches: Float64Array;

  constructor(robot: RobotDescription) {
    this.floating = robot.floating_base ?? false;
    this.worldFromLink = robot.links.map(() => new Matrix4());
    this.joints = sortedJoints(robot);
    this.masses = robot.links.map((link) => link.mass ?? 0);
    this.coms = robot.links.map((link) => new Vector3().fromArray(link.com ?? [0, 0, 0]));
    this.mass = this.masses.reduce((sum, mass) => sum + mass, 0);
    const children = new Set(this.joints.map((joint) => joint.child));
    this.root = Math.max(
      robot.links.findIndex((_, i) => !children.has(i)),
      0,
    );
    this.wrenches = new Float64Array(6 * robot.links.length);
    for (const joint of this.joints) {
      if (joint.moves && joint.index >= 0 && joint.description.mimics === undefined) {
        this.moving[joint.index] = joint.description;
      }
    }
  }

  /** Numbers of a configuration this robot needs at least. */
  get configurationSize(): number {
    return (this.floating ? 7 : 0) + this.moving.length;
  }

  update(configuration: ArrayLike<number>): void {
    const base = this.worldFromLink[this.root];
    const offset = this.floating ? 7 : 0;
    if (this.floating) {
      this.position.set(configuration[0], configuration[1], configuration[2]);
      this.rotation
        .set(configuration[3], configuration[4], configuration[5], configuration[6])
        .normalize();
      base.compose(this.position, this.rotation, this.unitScale);
    } else {
      base.identity();
    }
    for (const joint of this.joints) {
      const world = this.worldFromLink[joint.child];
      world.multiplyMatrices(this.worldFromLink[joint.parent], joint.origin);
      if (!joint.moves) continue;
      const leader = joint.index >= 0 ? configuration[offset + joint.index] : 0;
      const value = joint.multiplier * leader + joint.offset;
      if (joint.prismatic) {
        this.motion.makeTranslation(
          joint.axis.x * value,
          joint.axis.y * value,
          joint.axis.z * value,
        );
      } else {
        this.motion.makeRotationAxis(joint.axis, value);
      }
      world.multiply(this.motion);
    }
  }

  /** Centre of mass in the world; needs link masses. */
  centreOfMass(target: Vector3): Vector3 {
    target.set(0, 0, 0);
    if (this.mass <= 0) return target;
    for (let i = 0; i < this.masses.length; ++i) {
      const mass = this.masses[i];
      if (mass === 0) continue;
      this.point.copy(this.coms[i]).applyMatrix4(this.worldFromLink[i]);
      target.addScaledVector(this.point, mass / this.mass);
    }
    return target;
  }

  /**
   * Joint torques [N m] that hold the robot still: τ = -Σ axis · ((p_k - p) × f_k + m_k) over the
   * weights and contact forces beyond the joint (principle of virtual work).
   */
  staticTorques(contacts: Contact[], torques: Float32Array): void {
    const w = this.wrenches;
    w.fill(0);
    torques.fill(0);
    for (let i = 0; i < this.masses.length; ++i) {
      if (this.masses[i] === 0) continue;
      this.point.copy(this.coms[i]).applyMatrix4(this.worldFromLink[i]);
      addForce(w, i, this.point.x, this.point.y, this.point.z, 0, 0, -this.masses[i] * GRAVITY);
    }
    for (const contact of contacts) {
      const [x, y, z] = contact.position;
      const force = contact.force;
      if (force && contact.link >= 0 && contact.link < this.masses.length) {
        addForce(w, contact.link, x, y, z, force[0], force[1], force[2]);
        for (let k = 0; k < 3; ++k) w[6 * contact.link + 3 + k] += contact.moment?.[k] ?? 0;
      }
    }
    for (let j = this.joints.length - 1; j >= 0; --j) {
      const joint = this.joints[j];
      const c = 6 * joint.child;
      if (joint.moves && joint.index >= 0) {
        const world = this.worldFromLink[joint.child];
        const p = this.position.setFromMatrixPosition(world);
        const a = this.axis.copy(joint.axis).transformDirection(world);
        const fx = w[c],
          fy = w[c + 1],
          fz = w[c + 2];
        const torque = joint.prismatic
          ? a.x * fx + a.y * fy + a.z * fz
          : a.x * (w[c + 3] - (p.y * fz - p.z * fy)) +
            a.y * (w[c + 4] - (p.z * fx - p.x * fz)) +
            a.z * (w[c + 5] - (p.x * fy - p.y * fx));
        torques[joint.index] -= joint.multiplier * torque;
      }
      for (let k = 0; k < 6; ++k) w[6 * joint.parent + k] += w[c + k];
    }
  }
}

function addForce(
  wrenches: Float64Array,
  link: number,
  x: number,
  y: number,
  z: number,
  fx: number,
  fy: number,
  fz: number,
): void {
  const first = 6 * link;
  wrenches[first] += fx;
  wrenches[first + 1] += fy;
  wrenches[first + 2] += fz;
  wrenches[first + 3] += y * fz - z * fy;
  wrenches[first + 4] += z * fx - x * fz;
  wrenches[first + 5] += x * fy - y * fx;
}

/** Joints from the root outwards. */
function sortedJoints(robot: RobotDescription): Joint[] {
  const waiting = new Map<number, JointDescription[]>();
  const children = new Set<number>();
  for (const joint of robot.joints ?? []) {
    if (children.has(joint.child)) {
      throw new SceneError(`Link "${robot.links[joint.child].name}" has two parents.`);
    }
    children.add(joint.child);
    waiting.set(joint.parent, [...(waiting.get(joint.parent) ?? []), joint]);
  }
  const reached = robot.links.map((_, i) => i).filter((i) => !children.has(i));
  const sorted: Joint[] = [];
  for (let head = 0; head < reached.length; ++head) {
    for (const joint of waiting.get(reached[head]) ?? []) {
      const moves = joint.type !== 'fixed';
      const leader = joint.mimics === undefined ? joint : robot.joints[joint.mimics];
      const index = leader.index ?? -1;
      sorted.push({
        description: joint,
        parent: joint.parent,
        child: joint.child,
        origin: matrixOf(joint.origin),
        axis: new Vector3().fromArray(joint.axis ?? [1, 0, 0]).normalize(),
        prismatic: joint.type === 'prismatic',
        moves,
        index,
        multiplier: index >= 0 ? (joint.multiplier ?? 1) : 0,
        offset: index >= 0 ? (joint.offset ?? 0) : (joint.frozen ?? 0),
      });
      reached.push(joint.child);
    }
  }
  if (reached.length !== robot.links.length) {
    throw new SceneError('The joints of the robot form a loop: expected a tree of links.');
  }
  return sorted;
}
