/** What the legend says about a scene. */
import { kindColour } from './contacts';
import { number } from './dom';
import { Layers } from './layers';
import { LegendEntry, LegendScale } from './legend';
import { FIELD_REACH_M } from './perception';
import { Plan } from './plan';
import { FIRST_GHOST, LAST_GHOST, PLANNED } from './robot_view';
import { SceneViews } from './scene_views';
import { FIELD_COLOURS, HEIGHT_COLOURS, SEEN_COLOURS, Theme } from './theme';
import { DEPTH_COLOURS } from './tree_view';

/** `gridCell`: the width of the fine grid [m]. */
export function legendEntries(
  { plan, track, contactView, world, graph, tree, perception }: SceneViews,
  layers: Layers,
  theme: Theme,
  gridCell: number,
): LegendEntry[] {
  const entries: LegendEntry[] = [];
  const add = (label: string, colour: number, shape: LegendEntry['shape'], layer: string) => {
    if (layers.all.some(({ id }) => id === layer))
      entries.push({ label, colour, shape, layer });
  };
  if (plan?.executed !== null || layers.isOn('by_time')) {
    add('executed', theme.executed, 'dot', 'dots');
    if (plan?.window) add('in the window', theme.window, 'dot', 'dots');
  }
  add(plan?.window ? 'not yet in the window' : 'to come', theme.rest, 'dot', 'dots');
  add('base path', theme.base, 'line', 'base');
  if (tree) {
    add('tree: first moves', DEPTH_COLOURS[0], 'line', 'tree');
    const last = DEPTH_COLOURS[DEPTH_COLOURS.length - 1];
    if (tree.deepest > 1) add(`tree: ${tree.deepest} moves deep`, last, 'line', 'tree');
    if (tree.hasFailed) add('tree: failed moves (faint)', theme.grid, 'line', 'tree');
    if (tree.hasWay) add('tree: way to the goal', theme.executed, 'line', 'tree');
  }
  add('reference plan', theme.reference, 'dashed', 'reference');
  for (const kind of contactKinds(plan)) {
    add(`${kind} contact, normal`, kindColour(kind), 'patch', 'contacts');
  }
  if (contactView) {
    const newtons = Number((1 / contactView.forceScale).toPrecision(2));
    add(`contact force (1 m = ${number(newtons)} N)`, theme.force, 'arrow', 'forces');
    if (track?.hasMoments) {
      add(`contact moment (1 m = ${number(newtons / 4)} N m)`, theme.moment, 'arrow', 'forces');
    }
    if (track?.hasFriction) add('friction cone', theme.cone, 'patch', 'forces');
    add('centre of mass, projection', theme.centreOfMass, 'dot', 'com');
  }
  if (world.hasMoving) add('moving obstacle', theme.moving, 'patch', 'obstacles');
  add('seen by cameras', theme.seen, 'dot', 'clouds');
  if (perception?.hasFloor) add('seen of the floor', theme.floor, 'dot', 'clouds');
  add('taken by the self-filter', theme.taken, 'dot', 'taken');
  add('seen beyond the range of the map', theme.beyond, 'dot', 'beyond');
  add('where the plan has it', PLANNED, 'patch', 'planned');
  add('first ghost', FIRST_GHOST, 'patch', 'ghosts');
  add('last ghost', LAST_GHOST, 'patch', 'ghosts');
  add('violation', theme.violation, 'dot', 'violations');
  add(graph?.hasBefore ? 'after optimisation' : 'odometry', theme.after, 'line', 'after');
  add('before', theme.before, 'line', 'before');
  add('loop closure', theme.loop, 'line', 'loops');
  add('landmark', theme.executed, 'dot', 'landmarks');
  add(
    `grid ${number(gridCell)} m, ${number(5 * gridCell)} m`,
    theme.grid,
    'line',
    'ground',
  );
  return entries;
}

/** Scales of its colours. */
export function legendScales({ voxels, perception }: SceneViews): LegendScale[] {
  const scales: LegendScale[] = [];
  if (voxels?.count) {
    const { lowest, highest } = voxels;
    scales.push({ label: 'map', lowest, highest, colours: HEIGHT_COLOURS, layer: 'map' });
  }
  if (perception) {
    const { lowest, highest } = perception;
    scales.push(
      { label: 'seen map', lowest, highest, colours: SEEN_COLOURS, layer: 'seen' },
      { label: 'distance', lowest: 0, highest: FIELD_REACH_M, colours: FIELD_COLOURS, layer: 'field' },
    );
  }
  return scales;
}

function contactKinds(plan: Plan | null): Set<string> {
  const kinds = new Set<string>();
  for (const contacts of plan?.contacts ?? []) for (const { kind } of contacts) kinds.add(kind);
  return kinds;
}
