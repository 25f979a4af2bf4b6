/** Camera presets, and the camera that goes with the robot and sees what is near it. */
import { Box3, Matrix4, Vector3 } from 'three';
import { Stage } from './stage';

export type ViewName = 'overview' | 'front' | 'side' | 'top' | 'follow';
export const VIEWS: ViewName[] = ['overview', 'front', 'side', 'top', 'follow'];

/** Directions from what is looked at to the camera, in the frame of the robot's heading. */
const DIRECTIONS: Record<ViewName, [number, number, number]> = {
  overview: [0.55, -0.75, 0.5],
  front: [1, 0, 0.12],
  side: [0, -1, 0.1],
  top: [-0.0005, 0, 1],
  follow: [0.72, -0.95, 0.5],
};

export class CameraRig {
  view: ViewName = 'follow';
  following = false;

  /** Of the sphere that is looked at. */
  private readonly centre = new Vector3();
  private radius = 1;
  private readonly offset = new Vector3();
  private readonly shift = new Vector3();
  private readonly direction = new Vector3();
  private readonly up = new Vector3(0, 0, 1);

  constructor(private readonly stage: Stage) {}

  /** Looks from a preset direction at a sphere, turned by the heading [rad]. */
  look(view: ViewName, centre: Vector3, radius: number, heading: number): void {
    this.view = view;
    this.centre.copy(centre);
    this.radius = radius;
    const { camera, controls } = this.stage;
    const narrow = Math.min(1, camera.aspect);
    const half = (0.5 * (camera.fov * Math.PI)) / 180;
    const distance = radius / Math.sin(half) / Math.sqrt(narrow) / narrow ** 0.35;
    this.direction
      .fromArray(DIRECTIONS[view])
      .normalize()
      .applyAxisAngle(this.up, view === 'overview' || view === 'top' ? 0 : heading);
    if (view === 'top') this.direction.set(0, -0.0005, 1).normalize();
    controls.target.copy(centre);
    camera.position.copy(centre).addScaledVector(this.direction, distance);
    controls.update();
    this.stage.invalidate();
  }

  lookAtBox(box: Box3, fromAbove: boolean): void {
    const centre = box.getCenter(new Vector3());
    const radius = 0.5 * box.getSize(new Vector3()).length();
    this.look(fromAbove ? 'top' : 'overview', centre, Math.max(0.92 * radius, 0.5), 0);
  }

  /** As an overview of a box, from as near as all of it is in the picture. */
  fitBox(box: Box3): void {
    this.lookAtBox(box, false);
    const { camera, controls } = this.stage;
    const half = Math.tan((0.5 * camera.fov * Math.PI) / 180);
    const right = new Vector3().crossVectors(this.up, this.direction).normalize();
    const above = new Vector3().crossVectors(this.direction, right);
    const corner = new Vector3();
    let distance = 0;
    for (let i = 0; i < 8; ++i) {
      corner.set(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).multiplyScalar(0.5);
      corner.multiply(box.getSize(this.shift));
      const across = Math.abs(corner.dot(right)) / camera.aspect;
      const aside = Math.max(across, Math.abs(corner.dot(above))) / half;
      distance = Math.max(distance, corner.dot(this.direction) + 1.05 * aside);
    }
    camera.position.copy(controls.target).addScaledVector(this.direction, distance);
    controls.update();
  }

  /** Keeps a sphere in the picture, where and as large as the one that was looked at. */
  follow(centre: Vector3, radius: number): void {
    const { camera, controls } = this.stage;
    this.shift.subVectors(centre, this.centre);
    this.offset.subVectors(camera.position, controls.target).multiplyScalar(radius / this.radius);
    controls.target.add(this.shift);
    camera.position.addVectors(controls.target, this.offset);
    controls.update();
    this.centre.copy(centre);
    this.radius = radius;
  }

  /** Aims at a point without turning. */
  aimAt(point: Vector3): void {
    const { camera, controls } = this.stage;
    this.shift.subVectors(point, controls.target).multiplyScalar(0.6);
    controls.target.add(this.shift);
    camera.position.add(this.shift);
    controls.update();
  }
}

/** Direction to a camera that stands before a robot, beside and above it. */
export function threeQuarterView(heading: number, direction: Vector3): Vector3 {
  const up = new Vector3(0, 0, 1);
  return direction.fromArray(DIRECTIONS.follow).normalize().applyAxisAngle(up, heading);
}

/** Heading of a base frame [rad]: of its y axis, since a base may lean forward until x points down. */
export function headingOf(world: Matrix4): number {
  return Math.atan2(-world.elements[4], world.elements[5]);
}
