/** What is drawn of a scene: robot, plan, contacts, map and world, at the time shown. */
import { Box3, Matrix4, Object3D, Vector3 } from 'three';
import { ContactTrack } from './contacts';
import { ContactView } from './contact_view';
import { Kinematics } from './kinematics';
import { NearBox } from './near';
import { PathView } from './path_view';
import { PerceptionView } from './perception_view';
import { Plan } from './plan';
import { PoseGraphView } from './pose_graph_view';
import { RobotView } from './robot_view';
import { Scene, SceneError } from './scene_format';
import { Theme } from './theme';
import { TreeView } from './tree_view';
import { ViolationView } from './violation_view';
import { VoxelView } from './voxel_view';
import { WorldView } from './world_view';

export class SceneViews {
  readonly plan: Plan | null = null;
  readonly kinematics: Kinematics | null = null;
  readonly robot: RobotView | null = null;
  readonly track: ContactTrack | null = null;
  readonly contactView: ContactView | null = null;
  readonly path: PathView | null = null;
  readonly world: WorldView;
  readonly voxels: VoxelView | null = null;
  readonly graph: PoseGraphView | null = null;
  readonly tree: TreeView | null = null;
  readonly perception: PerceptionView | null = null;
  readonly violations: ViolationView;

  /** At the time shown; velocities and torques after updateRates(). */
  readonly configuration: Float32Array;
  readonly velocities: Float32Array;
  readonly torques: Float32Array | null;

  private readonly ghostKinematics: Kinematics | null = null;
  private readonly planned: Float32Array;
  private readonly base = new Vector3();
  private readonly centre = new Vector3();
  private readonly standing = new Box3();
  private readonly near = new NearBox();

  /** Adds all of it to the drawing, and labels of violations to the overlay. */
  constructor(scene: Scene, drawing: Object3D, overlay: HTMLElement) {
    if (scene.robot) {
      this.kinematics = new Kinematics(scene.robot);
      this.ghostKinematics = new Kinematics(scene.robot);
      this.robot = new RobotView(scene.robot, this.kinematics, this.ghostKinematics);
      drawing.add(this.robot.group, this.robot.ghosts, this.robot.planned);
    }
    if (scene.plan && this.kinematics) {
      this.plan = new Plan(scene.plan, this.kinematics.floating, scene.stances);
      if (this.plan.size < this.kinematics.configurationSize) {
        throw new SceneError(
          `A configuration has ${this.plan.size} numbers; robot "${scene.robot!.name}" needs ` +
            `${this.kinematics.configurationSize}.`,
        );
      }
      this.track = new ContactTrack(this.plan, this.ghostKinematics!);
      this.path = new PathView(this.plan, this.ghostKinematics!);
      drawing.add(this.path.dots, this.path.lines, this.path.referenceLine);
    }
    const size = Math.max(this.plan?.size ?? 0, this.kinematics?.configurationSize ?? 0, 1);
    this.configuration = new Float32Array(size);
    if (this.kinematics?.floating) this.configuration[6] = 1;
    this.planned = new Float32Array(size);
    this.velocities = new Float32Array(size);
    const torques = this.plan?.torques || (this.track?.hasForces && this.kinematics!.mass > 0);
    this.torques = torques ? new Float32Array(size) : null;
    if (this.kinematics) {
      this.plan?.sample(this.plan.start, this.configuration);
      this.kinematics.update(this.configuration);
      const scale = Math.min(Math.max(this.robot!.bounds(this.centre) / 2, 0.3), 1.2);
      this.contactView = new ContactView(this.kinematics, this.track, scale);
      const { contacts, forces, balance } = this.contactView;
      drawing.add(contacts, forces, balance);
    }
    this.world = new WorldView(scene.obstacles ?? [], scene.surfaces ?? [], scene.bars ?? []);
    drawing.add(this.world.obstacles, this.world.surfaces);
    if (scene.map) {
      this.voxels = new VoxelView(scene.map.voxels, scene.map.resolution);
      drawing.add(this.voxels.group);
    }
    if (scene.graph && scene.kind === 'pose_graph') {
      this.graph = new PoseGraphView(scene.graph);
      const { before, after, loops, landmarks } = this.graph;
      drawing.add(before, after, loops, landmarks);
    }
    if (scene.tree) {
      this.tree = new TreeView(scene.tree);
      drawing.add(this.tree.group);
    }
    if (scene.perception) {
      this.perception = new PerceptionView(scene.perception);
      drawing.add(...this.perception.objects);
      this.world.fadeObstacles();
    }
    this.violations = new ViolationView(scene.check?.violations ?? [], this.plan, overlay);
    drawing.add(this.violations.group);
  }

  /** Position of the robot's base at the time shown. */
  get basePosition(): Vector3 {
    return this.base;
  }

  /** Frame of the robot's base at the time shown. */
  get worldFromBase(): Matrix4 | null {
    return this.kinematics ? this.kinematics.worldFromLink[this.kinematics.root] : null;
  }

  get centreOfMass(): Vector3 | null {
    return this.kinematics && this.kinematics.mass > 0
      ? (this.contactView?.centreOfMass ?? null)
      : null;
  }

  /** What a camera that shows all of it has to see. */
  box(): Box3 {
    if (this.graph) return this.graph.box;
    const box = new Box3();
    const point = new Vector3();
    if (this.robot && !this.plan?.steps) {
      const size = this.robot.bounds(point);
      box.expandByPoint(point.clone().addScalar(0.3 * size));
      box.expandByPoint(point.subScalar(0.3 * size));
    }
    if (this.plan?.steps) {
      box.union(this.wayBox(this.plan));
    } else if (this.plan && this.kinematics?.floating) {
      for (let i = 0; i < this.plan.configurations.length; i += this.plan.size) {
        point.fromArray(this.plan.configurations, i);
        box.expandByPoint(point.addScalar(0.5));
        box.expandByPoint(point.subScalar(1));
      }
    }
    if (this.robot) {
      this.near.begin(box);
      this.world.addTo(this.near);
      return box.copy(this.near.box);
    }
    box.expandByObject(this.voxels?.group ?? this.world.obstacles);
    box.expandByObject(this.world.obstacles).expandByObject(this.world.surfaces);
    if (box.isEmpty()) box.set(new Vector3(-1, -1, 0), new Vector3(1, 1, 1));
    return box;
  }

  /** The robot in all configurations of a plan, and what it touches in them. */
  private wayBox(plan: Plan): Box3 {
    const box = new Box3();
    for (let i = 0; i < plan.count; ++i) {
      plan.copyConfiguration(i, this.configuration);
      this.kinematics!.update(this.configuration);
      box.union(this.robot!.box());
      for (const { position } of plan.contacts[i] ?? []) {
        box.expandByPoint(this.centre.fromArray(position));
      }
    }
    return box;
  }

  /** From now on nearBox() takes the robot to be as large as it is now. */
  measureRobot(): void {
    if (!this.robot) return;
    this.standing.copy(this.robot.box()).translate(this.centre.copy(this.base).negate());
  }

  /** The robot at the time shown. */
  robotBox(): Box3 {
    if (this.plan?.steps) return this.near.box.copy(this.robot!.box());
    return this.near.box.copy(this.standing).translate(this.base);
  }

  /** The same with what is near it; in a plan of stances also with what it touches next. */
  nearBox(time: number): Box3 {
    this.near.begin(this.robotBox());
    if (this.plan?.steps) {
      for (const { position } of this.plan.contacts[this.plan.indexAt(time) + 1] ?? []) {
        this.centre.fromArray(position);
        this.near.add(this.centre, this.centre);
      }
    }
    this.world.addTo(this.near);
    this.voxels?.addTo(this.near, this.near.box.min.z + 0.02);
    return this.near.box;
  }

  applyTheme(theme: Theme): void {
    this.contactView?.applyTheme(theme);
    this.world.applyTheme(theme);
    this.graph?.applyTheme(theme);
    this.tree?.applyTheme(theme);
    this.perception?.applyTheme(theme);
  }

  placeGhosts(number: number): void {
    if (this.plan) this.robot?.placeGhosts(this.plan, number);
  }

  /** Brings everything to a time [s]. */
  update(time: number): void {
    if (this.kinematics && this.robot) {
      this.plan?.sample(time, this.configuration);
      this.kinematics.update(this.configuration);
      this.robot.update();
      if (this.plan?.recorded && this.robot.planned.visible) {
        this.plan.planned(time, this.planned);
        this.robot.placePlanned(this.planned);
      }
      this.track?.update(time, this.kinematics);
      this.contactView?.update();
      this.base.setFromMatrixPosition(this.worldFromBase!);
    }
    this.world.update(time);
    this.perception?.update(time);
  }

  /** Velocities and torques of the joints at a time [s] that everything has been brought to. */
  updateRates(time: number): void {
    const { plan, kinematics, track, torques } = this;
    if (!plan || !kinematics) return;
    plan.velocities(time, this.velocities);
    if (!torques) return;
    if (plan.torques) {
      const joints = plan.size - (kinematics.floating ? 7 : 0);
      const first = plan.nearestIndex(time) * joints;
      for (let k = 0; k < joints; ++k) torques[k] = plan.torques[first + k];
    } else if (track) {
      kinematics.staticTorques(track.current, torques);
    }
  }

  /** Takes over configurations, by their index in the plan. */
  replace(configurations: Record<string, ArrayLike<number>>): void {
    if (!this.track || !this.ghostKinematics) return;
    for (const [index, configuration] of Object.entries(configurations)) {
      this.track.replace(Number(index), configuration, this.ghostKinematics);
    }
    this.path?.place();
  }
}
