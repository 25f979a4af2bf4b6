/** The whole page for one scene: builds the views, and brings them to the time shown. */
import { Box3, Vector3 } from 'three';
import { CameraRig, headingOf, ViewName, VIEWS } from './cameras';
import { ContactTrack } from './contacts';
import { ContactView } from './contact_view';
import { element } from './dom';
import { Help } from './help';
import { listenToKeys } from './keyboard';
import { Kinematics } from './kinematics';
import { Layers } from './layers';
import { Legend } from './legend';
import { legendEntries } from './legend_entries';
import { Panel } from './panel';
import { PathView } from './path_view';
import { Plan } from './plan';
import { Player } from './player';
import { PoseGraphView } from './pose_graph_view';
import { RobotView } from './robot_view';
import { Scene, SceneError } from './scene_format';
import { addSceneLayers } from './scene_layers';
import { Stage } from './stage';
import { preferredTheme, ThemeName, THEMES } from './theme';
import { Timeline } from './timeline';
import { TopBar } from './top_bar';
import { ViolationView } from './violation_view';
import { VoxelView } from './voxel_view';
import { WorldView } from './world_view';

const PANEL_EVERY_MS = 90;

export class App {
  readonly stage: Stage;
  readonly layers: Layers;
  readonly player: Player;
  readonly rig: CameraRig;
  readonly plan: Plan | null = null;
  readonly violations: ViolationView;
  readonly bar: TopBar;
  readonly help: Help;
  gridCell = 0.2;
  themeName: ThemeName = preferredTheme();
  frames = 0;

  private readonly page: HTMLElement;
  private readonly view: HTMLElement;
  private readonly panel: Panel;
  private readonly legend: Legend;

  readonly world: WorldView;
  readonly kinematics: Kinematics | null = null;
  private readonly ghostKinematics: Kinematics | null = null;
  readonly robot: RobotView | null = null;
  readonly track: ContactTrack | null = null;
  readonly contactView: ContactView | null = null;
  readonly path: PathView | null = null;
  readonly voxels: VoxelView | null = null;
  readonly graph: PoseGraphView | null = null;
  private readonly timeline: Timeline | null = null;

  private readonly configuration: Float32Array;
  private readonly velocities: Float32Array;
  private readonly torques: Float32Array | null;
  private readonly base = new Vector3();
  private readonly centre = new Vector3();
  private radius = 1;
  private ghostNumber = 8;
  private width = 1;
  private height = 1;
  private changed = true;
  private panelTime = 0;
  private paintedExecuted: number | null | undefined = undefined;
  private initial: Float32Array | null = null;
  /** The clock follows what a running refinement has executed. */
  followLive = false;

  constructor(
    readonly scene: Scene,
    root: HTMLElement,
  ) {
    document.title = `${scene.title} – locograph`;
    this.page = element('div', 'page', root);
    const bar = element('header', 'topbar', this.page);
    this.view = element('main', 'view', this.page);
    const canvas = element('canvas', 'canvas', this.view);
    canvas.id = 'view';
    canvas.tabIndex = 0;
    canvas.setAttribute('aria-label', `Three-dimensional view of ${scene.title}`);
    const overlay = element('div', 'overlay', this.view);
    this.stage = new Stage(canvas);
    this.rig = new CameraRig(this.stage);
    this.layers = new Layers(() => this.invalidate(true));

    if (scene.robot) {
      this.kinematics = new Kinematics(scene.robot);
      this.ghostKinematics = new Kinematics(scene.robot);
      this.robot = new RobotView(scene.robot, this.kinematics, this.ghostKinematics);
      this.stage.scene.add(this.robot.group, this.robot.ghosts);
    }
    if (scene.plan && this.kinematics) {
      this.plan = new Plan(scene.plan, this.kinematics.floating);
      if (this.plan.size < this.kinematics.configurationSize) {
        throw new SceneError(
          `A configuration has ${this.plan.size} numbers; robot "${scene.robot!.name}" needs ` +
            `${this.kinematics.configurationSize}.`,
        );
      }
      this.track = new ContactTrack(this.plan);
      this.path = new PathView(this.plan, this.ghostKinematics!);
      this.stage.scene.add(this.path.dots, this.path.lines, this.path.referenceLine);
    }
    const size = Math.max(this.plan?.size ?? 0, this.kinematics?.configurationSize ?? 0, 1);
    this.configuration = new Float32Array(size);
    if (this.kinematics?.floating) this.configuration[6] = 1;
    this.velocities = new Float32Array(size);
    const torques = this.plan?.torques || (this.track?.hasForces && this.kinematics!.mass > 0);
    this.torques = torques ? new Float32Array(size) : null;
    if (this.kinematics) {
      this.plan?.sample(this.plan.start, this.configuration);
      this.kinematics.update(this.configuration);
      const scale = Math.min(Math.max(this.robot!.bounds(this.centre) / 2, 0.3), 1.2);
      this.contactView = new ContactView(this.kinematics, this.track, scale);
      const { contacts, forces, balance } = this.contactView;
      this.stage.scene.add(contacts, forces, balance);
    }
    this.world = new WorldView(scene.obstacles ?? [], scene.surfaces ?? []);
    this.stage.scene.add(this.world.obstacles, this.world.surfaces);
    if (scene.map) {
      this.voxels = new VoxelView(scene.map.voxels, scene.map.resolution);
      this.stage.scene.add(this.voxels.group);
    }
    if (scene.graph && scene.kind === 'pose_graph') {
      this.graph = new PoseGraphView(scene.graph);
      const { before, after, loops, landmarks } = this.graph;
      this.stage.scene.add(before, after, loops, landmarks);
    }
    this.violations = new ViolationView(scene.check?.violations ?? [], this.plan, overlay);
    this.stage.scene.add(this.violations.group);
    this.player = new Player(this.plan);

    this.panel = new Panel(this.page, scene, this.violations.marks, (i) => this.jumpTo(i));
    this.panel.addMissing(scene.robot?.missing ?? []);
    if (this.plan && this.kinematics) {
      this.panel.addPlan(this.plan, this.kinematics, this.torques !== null);
    }
    if (this.plan && this.plan.count > 1) {
      this.timeline = new Timeline(
        this.page,
        scene,
        this.plan,
        this.player,
        this.violations.marks,
        () => this.userMoved(),
      );
    }
    if (this.graph) this.panel.addGraph(this.graph);
    addSceneLayers(this);
    const switches = this.panel.addSwitches(this.layers);
    if (this.plan && this.plan.count > 1) this.addGhostNumber(switches);
    this.legend = new Legend(this.view, (layer) => this.layers.isOn(layer));
    this.help = new Help(this.page, this.layers.all);
    this.bar = new TopBar(bar, this);
    this.page.classList.toggle('no-timeline', !this.timeline);
    if (innerWidth <= 700) this.showPanel(false);

    new ResizeObserver(() => this.resize()).observe(this.view);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () =>
      this.setTheme(preferredTheme()),
    );
    listenToKeys(this);
    this.setTheme(this.themeName);
    this.resize();
    this.setExtent();
    this.update();
    this.setView(
      this.graph ? (this.graph.planar ? 'top' : 'overview') : this.robot ? 'follow' : 'overview',
    );
  }

  // Building

  private addGhostNumber(parent: HTMLElement): void {
    const label = element('label', 'switch number', parent);
    element('span', '', label).textContent = 'Number of ghosts';
    const input = element('input', '', label);
    input.type = 'number';
    input.min = '2';
    input.max = '60';
    input.value = String(this.ghostNumber);
    input.addEventListener('change', () => {
      this.setGhosts(Number(input.value));
      this.layers.set('ghosts', true);
    });
  }

  private setExtent(): void {
    const box = this.sceneBox();
    const span = box.getSize(new Vector3()).length();
    if (this.graph) {
      const decade = 10 ** Math.floor(Math.log10(Math.max(span, 1) / 10));
      this.gridCell = decade;
      this.stage.setExtent(Math.max(span, 5), decade, this.graph.planar ? -0.01 * span : box.min.z);
    } else {
      this.stage.setExtent(Math.max(18, 1.2 * span), this.gridCell, 0);
    }
  }

  private sceneBox(): Box3 {
    if (this.graph) return this.graph.box;
    const box = new Box3();
    const point = new Vector3();
    if (this.robot) {
      const size = this.robot.bounds(point);
      box.expandByPoint(point.clone().addScalar(0.3 * size));
      box.expandByPoint(point.subScalar(0.3 * size));
    }
    if (this.plan && this.kinematics?.floating) {
      for (let i = 0; i < this.plan.configurations.length; i += this.plan.size) {
        point.fromArray(this.plan.configurations, i);
        box.expandByPoint(point.addScalar(0.5));
        box.expandByPoint(point.subScalar(1));
      }
    }
    if (!this.robot) box.expandByObject(this.voxels?.group ?? this.world.obstacles);
    if (!this.robot) box.expandByObject(this.world.obstacles).expandByObject(this.world.surfaces);
    if (box.isEmpty()) box.set(new Vector3(-1, -1, 0), new Vector3(1, 1, 1));
    return box;
  }

  // Acting

  invalidate(legend = false): void {
    this.changed = true;
    this.panelTime = 0;
    if (legend) {
      this.paintedExecuted = undefined;
      if (this.layers.isOn('ghosts') && this.plan)
        this.robot?.placeGhosts(this.plan, this.ghostNumber);
      this.legend?.show(legendEntries(this), this.voxels?.count ? this.voxels : null);
    }
    this.stage.invalidate();
  }

  userMoved(): void {
    this.followLive = false;
    this.invalidate();
  }

  setTime(time: number): void {
    this.player.setTime(time);
    this.userMoved();
  }

  setGhosts(number: number): void {
    if (Number.isFinite(number)) this.ghostNumber = Math.min(Math.max(Math.round(number), 2), 60);
    this.invalidate(true);
  }

  setTheme(name: ThemeName): void {
    this.themeName = name;
    document.documentElement.dataset.theme = name;
    const theme = THEMES[name];
    this.stage.applyTheme(theme, name === 'dark');
    this.contactView?.applyTheme(theme);
    this.world.applyTheme(theme);
    this.graph?.applyTheme(theme);
    this.invalidate(true);
  }

  toggleTheme(): void {
    this.setTheme(this.themeName === 'light' ? 'dark' : 'light');
  }

  showPanel(on: boolean): void {
    this.page.classList.toggle('panel-closed', !on);
    document.getElementById('toggle-panel')?.setAttribute('aria-expanded', String(on));
    this.invalidate();
  }

  togglePanel(): void {
    this.showPanel(this.page.classList.contains('panel-closed'));
  }

  showInterface(on: boolean): void {
    this.page.classList.toggle('bare', !on);
    this.resize();
  }

  setView(view: ViewName): void {
    if (!VIEWS.includes(view)) return;
    if (this.graph) {
      this.rig.lookAtBox(this.graph.box, view === 'top');
      this.rig.view = view;
      if (view === 'front' || view === 'side') {
        const radius = 0.5 * this.graph.box.getSize(new Vector3()).length();
        this.rig.look(view, this.graph.box.getCenter(this.centre), radius, 0);
      }
    } else if (view === 'overview' || !this.robot || !this.kinematics) {
      this.rig.lookAtBox(this.sceneBox(), false);
      this.rig.following = false;
    } else {
      const world = this.kinematics.worldFromLink[this.kinematics.root];
      this.radius = 0.56 * this.robot.bounds(this.centre);
      this.rig.look(view, this.centre, Math.max(this.radius, 0.3), headingOf(world));
      if (this.plan) this.rig.startFollowing(world);
    }
    this.bar.showView(view);
    this.stage.invalidate();
    this.changed = true;
  }

  /** Goes to the moment and the place of a violation. */
  jumpTo(index: number): void {
    const mark = this.violations.marks[index];
    if (!mark) return;
    this.player.playing = false;
    this.violations.selected = index;
    this.panel.check?.select(index);
    if (mark.time !== null) this.setTime(mark.time);
    this.update();
    if (mark.point) {
      this.layers.set('violations', true);
      this.rig.aimAt(mark.point);
    }
    this.invalidate();
    if (innerWidth <= 700) this.showPanel(false);
  }

  /** Back to the plan as it was before the run. */
  restartLive(): void {
    const { plan } = this;
    if (!plan) return;
    this.initial ??= plan.configurations.slice();
    const { size, count } = plan;
    const rows: Record<number, ArrayLike<number>> = {};
    for (let i = 0; i < count; ++i) rows[i] = this.initial.subarray(i * size, (i + 1) * size);
    this.applyLive(rows, 0, 0);
  }

  /** Takes over configurations, by their index, that a running refinement has changed. */
  applyLive(
    configurations: Record<string, ArrayLike<number>>,
    executed: number,
    window: number,
  ): void {
    const { plan, track, ghostKinematics } = this;
    if (!plan || !track || !ghostKinematics) return;
    for (const [index, configuration] of Object.entries(configurations ?? {})) {
      track.replace(Number(index), configuration, ghostKinematics);
    }
    plan.executed = executed;
    plan.window = window;
    this.layers.set('by_time', false);
    this.path?.place();
    this.invalidate(true);
  }

  // Drawing

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.view;
    if (width === 0 || height === 0 || (width === this.width && height === this.height)) return;
    this.width = width;
    this.height = height;
    this.stage.resize(this.width, this.height);
    this.paintedExecuted = undefined;
    this.invalidate();
  }

  /** One frame: `seconds` of real time have passed. Says whether anything was drawn. */
  frame(now: number, seconds: number): boolean {
    if (this.followLive && this.plan && this.plan.executed !== null) {
      const target = this.plan.times[Math.min(this.plan.executed, this.plan.count - 1)];
      const gap = target - this.player.time;
      if (Math.abs(gap) > 1e-3) {
        this.player.setTime(this.player.time + gap * Math.min(1, 4 * seconds));
        this.changed = true;
      }
    }
    if (this.player.advance(seconds)) this.changed = true;
    if (this.changed) this.update();
    this.violations.update(this.player.time, this.stage.camera, this.width, this.height);
    const drawn = this.stage.draw();
    if (drawn) ++this.frames;
    if (drawn && now - this.panelTime > PANEL_EVERY_MS) {
      this.panelTime = now;
      this.updatePanel();
    }
    return drawn;
  }

  /** Brings everything in the drawing to the time of the player. */
  update(): void {
    this.changed = false;
    const { time } = this.player;
    if (this.kinematics && this.robot) {
      this.plan?.sample(time, this.configuration);
      this.kinematics.update(this.configuration);
      this.robot.update();
      this.track?.update(time);
      this.contactView?.update();
      const world = this.kinematics.worldFromLink[this.kinematics.root];
      this.base.setFromMatrixPosition(world);
      this.rig.follow(world);
      this.stage.lightAt(this.base, Math.max(2.2 * this.radius, 1.2));
    }
    this.world.update(time);
    const executed = this.shownExecuted();
    if (executed !== this.paintedExecuted) {
      this.paintedExecuted = executed;
      this.path?.paint(THEMES[this.themeName], executed);
      this.timeline?.draw(THEMES[this.themeName], executed);
    }
    this.timeline?.update();
    this.stage.invalidate();
  }

  /** Position of the robot's base at the time shown. */
  get basePosition(): Vector3 {
    return this.base;
  }

  get centreOfMass(): Vector3 | null {
    return this.kinematics && this.kinematics.mass > 0
      ? (this.contactView?.centreOfMass ?? null)
      : null;
  }

  private shownExecuted(): number | null {
    if (!this.plan) return null;
    return this.layers.isOn('by_time') ? this.plan.indexAt(this.player.time) : this.plan.executed;
  }

  private updatePanel(): void {
    const { plan, kinematics } = this;
    if (!plan || !kinematics) return;
    const { time } = this.player;
    const base = kinematics.floating ? this.base : null;
    this.panel.update(time, base, this.centreOfMass, this.track);
    plan.velocities(time, this.velocities);
    if (this.torques) {
      if (plan.torques) {
        const joints = plan.size - (kinematics.floating ? 7 : 0);
        const first = plan.nearestIndex(time) * joints;
        for (let k = 0; k < joints; ++k) this.torques[k] = plan.torques[first + k];
      } else if (this.track) {
        kinematics.staticTorques(this.track.current, this.torques);
      }
    }
    this.panel.updateJoints(
      this.configuration,
      kinematics.floating ? 7 : 0,
      this.velocities,
      this.torques,
    );
  }
}
