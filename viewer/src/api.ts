/**
 * `window.locograph`: what pictures and tests without a person use, and the page's address.
 *
 *     page.html#t=12.3&view=side&ui=0&theme=dark&ghosts=6&slice=0.3&show=collision&hide=map,com
 */
import { App } from './app';
import { VIEWS, ViewName } from './cameras';

declare global {
  interface Window {
    locograph?: Api;
    locographReady?: boolean;
  }
}

export class Api {
  constructor(private readonly app: App) {}

  setTime(seconds: number): void {
    this.app.player.playing = false;
    this.app.setTime(seconds);
    this.app.frame(performance.now(), 0);
  }

  setView(view: ViewName): void {
    this.app.setView(view);
    this.app.frame(performance.now(), 0);
  }

  state() {
    const { app } = this;
    const { plan, violations, basePosition, centreOfMass } = app.views;
    const { marks } = violations;
    return {
      kind: app.scene.kind,
      time: app.player.time,
      index: app.player.index,
      configurations: plan?.count ?? 0,
      base: basePosition.toArray(),
      centreOfMass: centreOfMass?.toArray() ?? null,
      playing: app.player.playing,
      speed: app.player.speed,
      loop: app.player.loop,
      view: app.rig.view,
      theme: app.themeName,
      executed: plan?.executed ?? null,
      window: plan?.window ?? 0,
      violations: marks.filter(({ violation }) => violation.violated).length,
      selectedViolation: marks[violations.selected]?.violation.constraint ?? null,
      seen: app.views.perception?.state() ?? null,
      pictures: app.pictures?.strip.drawn ?? null,
      layers: Object.fromEntries(app.layers.all.map(({ id, on }) => [id, on])),
      frames: app.frames,
      drawCalls: app.stage.renderer.info.render.calls,
      triangles: app.stage.renderer.info.render.triangles,
    };
  }

  /** Plays for a number of frames; milliseconds between frames, and spent in this page's code. */
  async measureFrames(count: number): Promise<{ frame_ms: number[]; script_ms: number[] }> {
    const frame_ms: number[] = [];
    const script_ms: number[] = [];
    const { app } = this;
    app.player.playing = false;
    let last = 0;
    const step = (app.player.end - app.player.start) / count;
    return new Promise((resolve) => {
      const next = (now: number) => {
        if (last > 0) frame_ms.push(now - last);
        last = now;
        const begin = performance.now();
        app.setTime(app.player.start + step * script_ms.length);
        app.frame(now, 0);
        script_ms.push(performance.now() - begin);
        if (frame_ms.length >= count) resolve({ frame_ms, script_ms });
        else requestAnimationFrame(next);
      };
      requestAnimationFrame(next);
    });
  }
}

/** Brings the page to what its address asks for. */
export function applyHash(app: App, hash: string): void {
  const wanted = new URLSearchParams(hash.replace(/^#/, ''));
  const theme = wanted.get('theme');
  if (theme === 'light' || theme === 'dark') app.setTheme(theme);
  if (wanted.get('ui') === '0') app.showInterface(false);
  if (wanted.get('panel') === '0') app.showPanel(false);
  if (wanted.has('t')) app.setTime(Number(wanted.get('t')));
  app.update();
  const view = wanted.get('view') as ViewName | null;
  app.setView(view && VIEWS.includes(view) ? view : app.rig.view);
  if (wanted.has('ghosts')) {
    app.setGhosts(Number(wanted.get('ghosts')));
    app.layers.set('ghosts', true);
  }
  if (wanted.has('slice')) app.setSlice(Number(wanted.get('slice')));
  for (const id of wanted.get('show')?.split(',') ?? []) app.layers.set(id, true);
  for (const id of wanted.get('hide')?.split(',') ?? []) app.layers.set(id, false);
  if (wanted.has('violation')) app.jumpTo(Number(wanted.get('violation')));
}
