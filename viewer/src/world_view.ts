/** Surfaces and obstacles; obstacles with key frames move with the plan's time. */
import {
  Box3,
  BoxGeometry,
  BufferGeometry,
  DoubleSide,
  EdgesGeometry,
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
import { ObstacleDescription, Pose, SurfaceDescription } from './scene_format';
import { cylinderAlongZ } from './shapes';
import { Theme } from './theme';

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
  private readonly shape = new Box3();
  private readonly resting = new MeshLambertMaterial();
  private readonly mobile = new MeshLambertMaterial();
  private readonly plane = new MeshLambertMaterial({
    side: DoubleSide,
    transparent: true,
    opacity: 0.55,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  private readonly edges = new LineBasicMaterial({ transparent: true, opacity: 0.55 });

  constructor(obstacles: ObstacleDescription[], surfaces: SurfaceDescription[]) {
    for (const obstacle of obstacles) this.addObstacle(obstacle);
    for (const surface of surfaces) {
      const geometry = new PlaneGeometry(surface.size[0], surface.size[1]);
      const mesh = new Mesh(geometry, this.plane);
      mesh.receiveShadow = true;
      mesh.add(new LineSegments(new EdgesGeometry(geometry), this.edges));
      const { position, rotation } = keyFrame(0, surface.pose);
      mesh.position.copy(position);
      mesh.quaternion.copy(rotation);
      this.surfaces.add(mesh);
    }
  }

  get hasMoving(): boolean {
    return this.moving.length > 0;
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
  }

  applyTheme(theme: Theme): void {
    this.resting.color.set(theme.obstacle);
    this.mobile.color.set(theme.moving);
    this.plane.color.set(theme.surface);
    this.edges.color.set(theme.grid);
  }

  /** Adds the obstacles where they are now. */
  addTo(near: NearBox): void {
    for (const object of this.obstacles.children) {
      this.shape.setFromObject(object);
      near.add(this.shape.min, this.shape.max);
    }
  }

  update(time: number): void {
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
