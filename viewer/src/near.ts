/**
 * What is near the robot: the box that a camera which goes with it has to see. Things within half
 * the robot's size count in full, things a whole size away not at all, and in between in part, so
 * that the picture widens and narrows without a jump when the robot passes something.
 */
import { Box3, Vector3 } from 'three';

export class NearBox {
  /** After the things were added; the robot's own box to begin with. */
  readonly box = new Box3();

  private readonly robot = new Box3();
  private readonly reach = new Box3();
  private size = 1;

  begin(robot: Box3): void {
    this.robot.copy(robot);
    this.box.copy(robot);
    this.size = robot.min.distanceTo(robot.max);
    this.reach.copy(robot).expandByScalar(this.size);
  }

  /** A thing by its lowest and highest corner; what reaches out of sight is cut off. */
  add(lower: Vector3, upper: Vector3): void {
    let squaredGap = 0;
    for (const axis of ['x', 'y', 'z'] as const) {
      const { min, max } = this.robot;
      const gap = Math.max(lower[axis] - max[axis], min[axis] - upper[axis], 0);
      squaredGap += gap * gap;
    }
    const gap = Math.sqrt(squaredGap) / this.size;
    const weight = Math.min(Math.max(2 - 2 * gap, 0), 1);
    if (weight === 0) return;
    for (const axis of ['x', 'y', 'z'] as const) {
      const low = Math.max(lower[axis], this.reach.min[axis]) - this.robot.min[axis];
      const high = Math.min(upper[axis], this.reach.max[axis]) - this.robot.max[axis];
      this.box.min[axis] = Math.min(this.box.min[axis], this.robot.min[axis] + weight * low);
      this.box.max[axis] = Math.max(this.box.max[axis], this.robot.max[axis] + weight * high);
    }
  }
}
