/** What the legend says about a scene. */
import type { App } from './app';
import { kindColour } from './contacts';
import { number } from './dom';
import { LegendEntry } from './legend';
import { GHOST_COLOUR } from './robot_view';
import { THEMES } from './theme';

export function legendEntries(app: App): LegendEntry[] {
  const theme = THEMES[app.themeName];
  const entries: LegendEntry[] = [];
  const add = (label: string, colour: number, shape: LegendEntry['shape'], layer: string) => {
    if (app.layers.all.some(({ id }) => id === layer))
      entries.push({ label, colour, shape, layer });
  };
  if (app.plan?.executed !== null || app.layers.isOn('by_time')) {
    add('executed', theme.executed, 'dot', 'dots');
    if (app.plan?.window) add('in the window', theme.window, 'dot', 'dots');
  }
  add(app.plan?.window ? 'not yet in the window' : 'to come', theme.rest, 'dot', 'dots');
  add('base path', theme.base, 'line', 'base');
  add('reference plan', theme.reference, 'dashed', 'reference');
  for (const kind of contactKinds(app)) {
    add(`${kind} contact, normal`, kindColour(kind), 'patch', 'contacts');
  }
  if (app.contactView) {
    const newtons = Number((1 / app.contactView.forceScale).toPrecision(2));
    add(`contact force (1 m = ${number(newtons)} N)`, theme.force, 'arrow', 'forces');
    if (app.track?.hasMoments) {
      add(`contact moment (1 m = ${number(newtons / 4)} N m)`, theme.moment, 'arrow', 'forces');
    }
    if (app.track?.hasFriction) add('friction cone', theme.cone, 'patch', 'forces');
    add('centre of mass, projection', theme.centreOfMass, 'dot', 'com');
  }
  if (app.world.hasMoving) add('moving obstacle', theme.moving, 'patch', 'obstacles');
  add('ghost', GHOST_COLOUR, 'patch', 'ghosts');
  add('violation', theme.violation, 'dot', 'violations');
  add(app.graph?.hasBefore ? 'after optimisation' : 'odometry', theme.after, 'line', 'after');
  add('before', theme.before, 'line', 'before');
  add('loop closure', theme.loop, 'line', 'loops');
  add('landmark', theme.executed, 'dot', 'landmarks');
  add(
    `grid ${number(app.gridCell)} m, ${number(5 * app.gridCell)} m`,
    theme.grid,
    'line',
    'ground',
  );
  return entries;
}

function contactKinds(app: App): Set<string> {
  const kinds = new Set<string>();
  for (const contacts of app.plan?.contacts ?? []) for (const { kind } of contacts) kinds.add(kind);
  return kinds;
}
