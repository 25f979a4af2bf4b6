/** The whole page for one scene: puts its parts together, and brings them to the time shown. */
import { Vector3 } from 'three';
import { CameraRig, headingOf, ViewName, VIEWS } from './cameras';
import { element, setText } from './dom';
import { Help } from './help';
import { listenToKeys } from './keyboard';
import { Layers } from './layers';
import { Legend } from './legend';
import { legendEntries, legendScales } from './legend_entries';
import { PageActions } from './page_actions';
import { Panel } from './panel';
import { PerceptionView } from './perception_view';
import { PictureStrip } from './picture_strip';
import { Player } from './player';
import { Scene } from './scene_format';
import { addSceneLayers } from './scene_layers';
import { SceneViews } from './scene_views';
import { MOST_GHOSTS } from './robot_view';
import { Stage } from './stage';
import { captionsOf, StancePictures } from './stance_pictures';
import { preferredTheme, ThemeName, THEMES } from './theme';
import { Timeline } from './timeline';
import { TopBar } from './top_bar';

const PANEL_EVERY_MS = 90;

export class App implements PageActions {
  readonly stage: Stage;
  readonly views: SceneViews;
  readonly layers: Layers;
  readonly player: Player;
  readonly rig: CameraRig;
  readonly bar: TopBar;
  readonly pictures: StancePictures | null = null;
  themeName: ThemeName = preferredTheme();
  frames = 0;
  /** The clock follows what a running refinement has executed. */
  followLive = false;

  private readonly page: HTMLElement;
  private readonly view: HTMLElement;
  private readonly panel: Panel;
  private readonly legend: Legend;
  private readonly help: Help;
  private readonly timeline: Timeline | null = null;

  private readonly centre = new Vector3();
  private radius = 1;
  private gridCell = 0.2;
  private ghostNumber = 8;
  private width = 1;
  private height = 1;
  private changed = true;
  private panelTime = 0;
  private paintedExecuted: number | null | undefined = undefined;
  private initial: Float32Array | null = null;
  private sliceInput: HTMLInputElement | null = null;
  private sliceText: HTMLElement | null = null;

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
    this.views = new SceneViews(scene, this.stage.scene, overlay);
    const { plan, kinematics, robot, graph, violations } = this.views;
    this.player = new Player(plan);
    if (plan?.steps) this.ghostNumber = Math.min(plan.count, MOST_GHOSTS);

    this.panel = new Panel(this.page, scene, violations.marks, (i) => this.jumpTo(i));
    this.panel.addMissing(scene.robot?.missing ?? []);
    if (plan && kinematics) this.panel.addPlan(plan, kinematics, this.views.torques !== null);
    if (plan && plan.count > 1) {
      this.timeline = new Timeline(this.page, scene, plan, this.player, violations.marks, () =>
        this.userMoved(),
      );
      if (plan.steps) {
        const captions = captionsOf(scene, plan, violations.marks);
        const strip = new PictureStrip(this.timeline.element, captions, (i) => this.goTo(i));
        this.pictures = new StancePictures(this.views, plan, this.stage, strip);
      }
    }
    if (graph) this.panel.addGraph(graph);
    addSceneLayers(this.layers, this.views, this.stage.ground, this.pictures?.strip);
    const switches = this.panel.addSwitches(this.layers);
    if (plan && plan.count > 1) this.addGhostNumber(switches);
    if (this.views.perception) this.addSliceHeight(switches, this.views.perception);
    this.legend = new Legend(this.view, (layer) => this.layers.isOn(layer));
    this.help = new Help(this.page, this.layers.all);
    this.bar = new TopBar(bar, scene, this.views, this);
    this.page.classList.toggle('no-timeline', !this.timeline);
    if (innerWidth <= 700) this.showPanel(false);

    new ResizeObserver(() => this.resize()).observe(this.view);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () =>
      this.setTheme(preferredTheme()),
    );
    listenToKeys(this.player, this.layers, this, () => this.userMoved());
    this.setTheme(this.themeName);
    this.resize();
    this.setExtent();
    this.update();
    this.setView(graph ? (graph.planar ? 'top' : 'overview') : robot && !plan?.steps ? 'follow' : 'overview');
  }

  // Building

  private addGhostNumber(parent: HTMLElement): void {
    const label = element('label', 'switch number', parent);
    element('span', '', label).textContent = 'Number of ghosts';
    const input = element('input', '', label);
    input.type = 'number';
    input.min = '2';
    input.max = String(MOST_GHOSTS);
    input.value = String(this.ghostNumber);
    input.addEventListener('change', () => {
      this.setGhosts(Number(input.value));
      this.layers.set('ghosts', true);
    });
  }

  private addSliceHeight(parent: HTMLElement, perception: PerceptionView): void {
    const label = element('label', 'switch slice', parent);
    element('span', '', label).textContent = 'Height of the slice';
    const input = element('input', '', label);
    input.type = 'range';
    input.id = 'slice';
    // Middles of layers.
    input.min = String(perception.middle(perception.lowest));
    input.max = String(perception.highest);
    input.step = String(perception.step);
    this.sliceText = element('output', '', label);
    input.addEventListener('input', () => {
      this.setSlice(Number(input.value));
      this.layers.set('field', true);
    });
    this.sliceInput = input;
    this.setSlice(Number.NaN);
  }

  private setExtent(): void {
    const { graph } = this.views;
    const box = this.views.box();
    const span = box.getSize(new Vector3()).length();
    if (graph) {
      const decade = 10 ** Math.floor(Math.log10(Math.max(span, 1) / 10));
      this.gridCell = decade;
      this.stage.setExtent(Math.max(span, 5), decade, graph.planar ? -0.01 * span : box.min.z);
    } else {
      this.stage.setExtent(Math.max(18, 1.2 * span), this.gridCell, 0);
    }
  }

  // Acting

  invalidate(legend = false): void {
    this.changed = true;
    this.panelTime = 0;
    if (legend) {
      this.paintedExecuted = undefined;
      if (this.layers.isOn('ghosts')) this.views.placeGhosts(this.ghostNumber);
      const entries = legendEntries(this.views, this.layers, THEMES[this.themeName], this.gridCell);
      this.legend?.show(entries, legendScales(this.views));
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
    if (Number.isFinite(number)) this.ghostNumber = Math.min(Math.max(Math.round(number), 2), MOST_GHOSTS);
    this.invalidate(true);
  }

  /** Height of the slice of the distance field [m]; not a number: as it is. */
  setSlice(height: number): void {
    const { perception } = this.views;
    if (!perception || !this.sliceInput || !this.sliceText) return;
    if (Number.isFinite(height)) perception.setHeight(height);
    this.sliceInput.value = String(perception.height);
    setText(this.sliceText, `${perception.height.toFixed(2)} m`);
    this.invalidate();
  }

  setTheme(name: ThemeName): void {
    this.themeName = name;
    document.documentElement.dataset.theme = name;
    const theme = THEMES[name];
    this.stage.applyTheme(theme, name === 'dark');
    this.views.applyTheme(theme);
    this.pictures?.strip.forget();
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

  toggleHelp(): void {
    this.help.toggle();
  }

  showInterface(on: boolean): void {
    this.page.classList.toggle('bare', !on);
    this.resize();
  }

  setView(view: ViewName): void {
    if (!VIEWS.includes(view)) return;
    const { plan, robot, graph, worldFromBase } = this.views;
    if (graph) {
      this.rig.lookAtBox(graph.box, view === 'top');
      this.rig.view = view;
      if (view === 'front' || view === 'side') {
        const radius = 0.5 * graph.box.getSize(new Vector3()).length();
        this.rig.look(view, graph.box.getCenter(this.centre), radius, 0);
      }
    } else if (view === 'overview' || !robot || !worldFromBase) {
      if (plan?.steps) this.rig.fitBox(this.views.box());
      else this.rig.lookAtBox(this.views.box(), false);
      this.rig.following = false;
    } else {
      this.radius = 0.56 * robot.bounds(this.centre);
      this.views.measureRobot();
      this.rig.view = view;
      const radius = this.inSight();
      this.rig.look(view, this.centre, radius, headingOf(worldFromBase));
      this.rig.following = plan !== null;
    }
    this.bar.showView(view);
    this.stage.invalidate();
    this.changed = true;
  }

  /** Middle and radius of what the camera that goes with the robot sees now. */
  private inSight(): number {
    const robotAlone = this.rig.view === 'front' || this.rig.view === 'side';
    const box = robotAlone ? this.views.robotBox() : this.views.nearBox(this.player.time);
    box.getCenter(this.centre);
    return Math.max(0.56 * box.min.distanceTo(box.max), 0.3);
  }

  /** To a configuration, by its index. */
  goTo(index: number): void {
    const { plan } = this.views;
    if (!plan) return;
    this.player.playing = false;
    this.setTime(plan.times[index]);
  }

  /** Goes to the moment and the place of a violation. */
  jumpTo(index: number): void {
    const { violations } = this.views;
    const mark = violations.marks[index];
    if (!mark) return;
    this.player.playing = false;
    violations.selected = index;
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
    const { plan } = this.views;
    if (!plan) return;
    this.initial ??= plan.configurations.slice();
    const { size, count } = plan;
    const rows: Record<string, ArrayLike<number>> = {};
    for (let i = 0; i < count; ++i) rows[i] = this.initial.subarray(i * size, (i + 1) * size);
    this.applyLive(rows, 0, 0);
    plan.restoreSlopes();
    this.views.path?.place();
    this.views.perception?.clear();
  }

  /** Takes over configurations, by their index, that a running refinement has changed. */
  applyLive(
    configurations: Record<string, ArrayLike<number>>,
    executed: number,
    window: number,
  ): void {
    const { plan } = this.views;
    if (!plan) return;
    this.views.replace(configurations ?? {});
    this.pictures?.strip.forget(Object.keys(configurations ?? {}).map(Number));
    plan.executed = executed;
    plan.window = window;
    this.layers.set('by_time', false);
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
    const { plan, violations } = this.views;
    if (this.followLive && plan && plan.executed !== null) {
      const target = plan.times[Math.min(plan.executed, plan.count - 1)];
      const gap = target - this.player.time;
      if (Math.abs(gap) > 1e-3) {
        this.player.setTime(this.player.time + gap * Math.min(1, 4 * seconds));
        this.changed = true;
      }
    }
    if (this.player.advance(seconds)) this.changed = true;
    if (this.changed) this.update();
    if (this.pictures?.draw(now, this.stage.waiting)) this.update();
    const time = plan?.steps ? plan.times[this.player.index] : this.player.time;
    violations.update(time, this.stage.camera, this.width, this.height);
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
    this.views.update(this.player.time);
    const { worldFromBase, basePosition, path } = this.views;
    if (worldFromBase) {
      if (this.rig.following) {
        const radius = this.inSight();
        this.rig.follow(this.centre, radius);
      }
      this.stage.lightAt(basePosition, Math.max(2.2 * this.radius, 1.2));
    }
    const executed = this.shownExecuted();
    if (executed !== this.paintedExecuted) {
      this.paintedExecuted = executed;
      path?.paint(THEMES[this.themeName], executed);
      this.timeline?.draw(THEMES[this.themeName], executed);
    }
    this.timeline?.update();
    this.pictures?.strip.mark(this.player.index);
    this.stage.invalidate();
  }

  private shownExecuted(): number | null {
    const { plan } = this.views;
    if (!plan) return null;
    return this.layers.isOn('by_time') ? plan.indexAt(this.player.time) : plan.executed;
  }

  private updatePanel(): void {
    const { plan, kinematics, track, basePosition, centreOfMass } = this.views;
    if (!plan || !kinematics) return;
    const { time } = this.player;
    this.panel.update(time, kinematics.floating ? basePosition : null, centreOfMass, track);
    this.panel.updateCameras(time, this.views.perception?.counts ?? []);
    this.views.updateRates(time);
    const { configuration, velocities, torques } = this.views;
    this.panel.updateJoints(configuration, kinematics.floating ? 7 : 0, velocities, torques);
  }
}
