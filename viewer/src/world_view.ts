/** Surfaces, bars and obstacles, which move, appear and vanish with the plan's time. */
import {
  BackSide,
  Box3,
  BoxGeometry,
  BufferGeometry,
  CylinderGeometry,
  EdgesGeometry,
  FrontSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  PlaneGeometry,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three';
import { NearBox } from './near';
import { BarDescription, ObstacleDescription, Pose, SurfaceDescription } from './scene_format';
import { cylinderAlongZ } from './shapes';
import { Theme } from './theme';

/** Of a surface's normal, in its shorter side. */
const NORMAL_LENGTH = 0.15;
/** Surfaces are drawn above themselves, so that those in the ground are seen. */
const LIFT_M = 0.002;
const FADED_OPACITY = 0.4;

interface KeyFrame {
  time: number;
  position: Vector3;
  rotation: Quaternion;
}

interface MovingObstacle {
  object: Group;
  frames: KeyFrame[];
  repeat: number;
}

interface PassingObstacle {
  object: Group;
  appears: number;
  vanishes: number;
}

function keyFrame(time: number, pose: Pose | undefined): KeyFrame {
  const [x, y, z, qx, qy, qz, qw] = pose?.length === 7 ? pose : [0, 0, 0, 0, 0, 0, 1];
  return {
    time,
    position: new Vector3(x, y, z),
    rotation: new Quaternion(qx, qy, qz, qw).normalize(),
  };
}

function obstacleGeometry({ type, size }: ObstacleDescription): BufferGeometry {
  if (type === 'sphere') return new SphereGeometry(size[0], 40, 24);
  if (type === 'cylinder') return cylinderAlongZ(size[0], size[1], 40);
  return new BoxGeometry(size[0], size[1], size[2]);
}

export class WorldView {
  readonly obstacles = new Group();
  readonly surfaces = new Group();
  private readonly moving: MovingObstacle[] = [];
  private readonly passing: PassingObstacle[] = [];
  private readonly shape = new Box3();
  private readonly resting = new MeshLambertMaterial();
  private readonly mobile = new MeshLambertMaterial();
  /** The side of the normal, which may be touched, and the other one. */
  private readonly sides = [
    { side: FrontSide, opacity: 0.55 },
    { side: BackSide, opacity: 0.14 },
  ].map(
    (look) =>
      new MeshLambertMaterial({
        ...look,
        transparent: true,
        depthWrite: false,
      }),
  );
  private readonly bar = new MeshLambertMaterial();
  private readonly edges = new LineBasicMaterial({ transparent: true, opacity: 0.55 });

  constructor(
    obstacles: ObstacleDescription[],
    surfaces: SurfaceDescription[],
    bars: BarDescription[],
  ) {
    for (const obstacle of obstacles) this.addObstacle(obstacle);
    for (const surface of surfaces) this.addSurface(surface);
    for (const bar of bars) this.addBar(bar);
  }

  /** From now on what is in obstacles, and beyond them, shines through. */
  fadeObstacles(): void {
    for (const material of [this.resting, this.mobile]) {
      material.transparent = true;
      material.opacity = FADED_OPACITY;
      material.depthWrite = false;
    }
  }

  get hasMoving(): boolean {
    return this.moving.length > 0;
  }

  private addSurface({ pose, size }: SurfaceDescription): void {
    const geometry = new PlaneGeometry(size[0], size[1]);
    const object = new Group();
    for (const material of this.sides) {
      const mesh = new Mesh(geometry, material);
      mesh.receiveShadow = material.side === FrontSide;
      mesh.renderOrder = 1;
      object.add(mesh);
    }
    const normal = new BufferGeometry().setFromPoints([
      new Vector3(),
      new Vector3(0, 0, NORMAL_LENGTH * Math.min(size[0], size[1])),
    ]);
    for (const lines of [new EdgesGeometry(geometry), normal]) {
      object.add(new LineSegments(lines, this.edges));
    }
    const { position, rotation } = keyFrame(0, pose);
    object.quaternion.copy(rotation);
    object.position.set(0, 0, LIFT_M).applyQuaternion(rotation).add(position);
    this.surfaces.add(object);
  }

  private addBar({ from, to, radius }: BarDescription): void {
    const axis = new Vector3().fromArray(to).sub(new Vector3().fromArray(from));
    const mesh = new Mesh(new CylinderGeometry(radius, radius, axis.length(), 24), this.bar);
    mesh.position.fromArray(from).addScaledVector(axis, 0.5);
    mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), axis.normalize());
    mesh.castShadow = mesh.receiveShadow = true;
    this.surfaces.add(mesh);
  }

  private addObstacle(obstacle: ObstacleDescription): void {
    const frames = [keyFrame(0, obstacle.pose)];
    for (const { time, pose } of obstacle.keyframes ?? []) frames.push(keyFrame(time, pose));
    const repeat = obstacle.repeat ?? 0;
    if (repeat > 0) frames.push({ ...frames[0], time: repeat });
    const geometry = obstacleGeometry(obstacle);
    const object = new Group();
    const mesh = new Mesh(geometry, frames.length > 1 ? this.mobile : this.resting);
    mesh.castShadow = mesh.receiveShadow = true;
    object.add(mesh);
    if (obstacle.type !== 'sphere') {
      object.add(new LineSegments(new EdgesGeometry(geometry, 30), this.edges));
    }
    object.position.copy(frames[0].position);
    object.quaternion.copy(frames[0].rotation);
    this.obstacles.add(object);
    if (frames.length > 1) this.moving.push({ object, frames, repeat });
    const { appears = -Infinity, vanishes = Infinity } = obstacle;
    if (appears > -Infinity || vanishes < Infinity) {
      this.passing.push({ object, appears, vanishes });
    }
  }

  applyTheme(theme: Theme): void {
    this.resting.color.set(theme.obstacle);
    this.mobile.color.set(theme.moving);
    for (const material of [...this.sides, this.bar]) material.color.set(theme.surface);
    this.edges.color.set(theme.grid);
  }

  /** Adds the obstacles where they are now. */
  addTo(near: NearBox): void {
    for (const object of this.obstacles.children) {
      if (!object.visible) continue;
      this.shape.setFromObject(object);
      near.add(this.shape.min, this.shape.max);
    }
  }

  update(time: number): void {
    for (const { object, appears, vanishes } of this.passing) {
      object.visible = appears <= time && time <= vanishes;
    }
    for (const { object, frames, repeat } of this.moving) {
      const t = repeat > 0 ? ((time % repeat) + repeat) % repeat : time;
      let next = 1;
      while (next < frames.length - 1 && frames[next].time < t) ++next;
      const a = frames[next - 1];
      const b = frames[next];
      const fraction = Math.min(Math.max((t - a.time) / Math.max(b.time - a.time, 1e-9), 0), 1);
      object.position.lerpVectors(a.position, b.position, fraction);
      object.quaternion.slerpQuaternions(a.rotation, b.rotation, fraction);
    }
  }
}
