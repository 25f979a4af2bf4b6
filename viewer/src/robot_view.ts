/** The robot on the screen, and its ghosts: translucent copies, coloured from first to last. */
import {
  Box3,
  Color,
  EqualDepth,
  Group,
  InstancedMesh,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  MeshPhongMaterial,
  Vector3,
} from 'three';
import { Kinematics } from './kinematics';
import { Plan } from './plan';
import { RobotDescription } from './scene_format';
import { linkGeometry, Meshes } from './shapes';

const COLLISION_COLOUR = [0.93, 0.6, 0.2];
export const MOST_GHOSTS = 60;
export const FIRST_GHOST = 0x8ab6ea;
export const LAST_GHOST = 0xd08ae0;
export const PLANNED = 0x3fb8a0;

interface LinkMesh {
  link: number;
  mesh: Mesh;
}

export class RobotView {
  readonly group = new Group();
  readonly ghosts = new Group();
  /** One more ghost: where the plan had a robot that was recorded. */
  readonly planned = new Group();
  readonly hasVisual: boolean;
  readonly hasCollision: boolean;

  private readonly visual = new Group();
  private readonly collision = new Group();
  private readonly links: LinkMesh[] = [];
  private readonly ghostLinks: { link: number; meshes: InstancedMesh[] }[] = [];
  private readonly plannedLinks: LinkMesh[] = [];
  private readonly shape = new Box3();

  constructor(
    robot: RobotDescription,
    private readonly kinematics: Kinematics,
    private readonly ghostKinematics: Kinematics,
  ) {
    this.hasVisual = robot.links.some((link) => link.visual?.length);
    this.hasCollision = robot.links.some((link) => link.collision?.length);
    const meshes = new Meshes(robot);
    const material = new MeshPhongMaterial({
      vertexColors: true,
      specular: 0x30343a,
      shininess: 42,
    });
    const ghostDepth = new MeshBasicMaterial({ colorWrite: false });
    const ghost = new MeshLambertMaterial({
      transparent: true,
      opacity: 0.36,
      depthWrite: false,
      depthFunc: EqualDepth,
    });
    const planned = ghost.clone();
    planned.color.set(PLANNED);
    robot.links.forEach((link, i) => {
      const visual = linkGeometry(link.visual, meshes);
      const collision = linkGeometry(link.collision, meshes, COLLISION_COLOUR);
      if (visual) this.addLink(this.visual, i, new Mesh(visual, material));
      if (collision) this.addLink(this.collision, i, new Mesh(collision, material));
      const ghostGeometry = this.hasVisual ? visual : collision;
      if (!ghostGeometry) return;
      // Depth first, then colour where it is nearest: no inner faces shine through.
      const pair = [ghostDepth, ghost].map((m, pass) => {
        const instances = new InstancedMesh(ghostGeometry, m, MOST_GHOSTS);
        instances.count = 0;
        instances.frustumCulled = false;
        instances.renderOrder = 10 + pass;
        this.ghosts.add(instances);
        return instances;
      });
      this.ghostLinks.push({ link: i, meshes: pair });
      [ghostDepth, planned].forEach((m, pass) => {
        const mesh = new Mesh(ghostGeometry, m);
        mesh.matrixAutoUpdate = false;
        mesh.frustumCulled = false;
        mesh.renderOrder = 20 + pass;
        this.planned.add(mesh);
        this.plannedLinks.push({ link: i, mesh });
      });
    });
    this.group.add(this.visual, this.collision);
    this.showCollision(!this.hasVisual);
    this.ghosts.visible = false;
    this.planned.visible = false;
  }

  private addLink(group: Group, link: number, mesh: Mesh): void {
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    mesh.matrixAutoUpdate = false;
    mesh.frustumCulled = false;
    group.add(mesh);
    this.links.push({ link, mesh });
  }

  showCollision(on: boolean): void {
    this.collision.visible = on;
    this.visual.visible = !on;
  }

  get collisionShown(): boolean {
    return this.collision.visible;
  }

  /** Moves the links to where the kinematics has them now. */
  update(): void {
    for (const { link, mesh } of this.links) {
      mesh.matrix.copy(this.kinematics.worldFromLink[link]);
      mesh.matrixWorldNeedsUpdate = true;
    }
  }

  placePlanned(configuration: Float32Array): void {
    this.ghostKinematics.update(configuration);
    for (const { link, mesh } of this.plannedLinks) {
      mesh.matrix.copy(this.ghostKinematics.worldFromLink[link]);
      mesh.matrixWorldNeedsUpdate = true;
    }
  }

  /** Ghosts at `number` configurations, evenly spaced from the first to the last. */
  placeGhosts(plan: Plan, number: number): void {
    const count = Math.max(1, Math.min(number, plan.count, MOST_GHOSTS));
    const configuration = new Float32Array(plan.size);
    const colour = new Color();
    for (let ghost = 0; ghost < count; ++ghost) {
      const index = count === 1 ? 0 : Math.round((ghost * (plan.count - 1)) / (count - 1));
      plan.copyConfiguration(index, configuration);
      this.ghostKinematics.update(configuration);
      colour.set(FIRST_GHOST).lerp(new Color(LAST_GHOST), ghost / Math.max(count - 1, 1));
      for (const { link, meshes } of this.ghostLinks) {
        for (const mesh of meshes) {
          mesh.setMatrixAt(ghost, this.ghostKinematics.worldFromLink[link]);
          mesh.setColorAt(ghost, colour);
        }
      }
    }
    for (const { meshes } of this.ghostLinks) {
      for (const mesh of meshes) {
        mesh.count = count;
        mesh.instanceMatrix.needsUpdate = true;
        if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
      }
    }
  }

  /** Of the robot as it stands; a metre where it has no shape. */
  box(): Box3 {
    this.shape.makeEmpty();
    this.corners((corner) => this.shape.expandByPoint(corner));
    if (this.shape.isEmpty()) {
      const metre = new Vector3().setScalar(Math.sqrt(1 / 3));
      this.shape.setFromCenterAndSize(new Vector3(0, 0, 0.5), metre);
    }
    return this.shape;
  }

  /** Corners of the boxes around its links. */
  corners(visit: (corner: Vector3) => void): void {
    const corner = new Vector3();
    for (const { link, mesh } of this.links) {
      if (!mesh.geometry.boundingBox) mesh.geometry.computeBoundingBox();
      const { min, max } = mesh.geometry.boundingBox!;
      for (let i = 0; i < 8; ++i) {
        corner.set(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
        visit(corner.applyMatrix4(this.kinematics.worldFromLink[link]));
      }
    }
  }

  /** Middle and size of the robot as it stands. */
  bounds(centre: Vector3): number {
    const box = this.box();
    box.getCenter(centre);
    return box.min.distanceTo(box.max);
  }
}
