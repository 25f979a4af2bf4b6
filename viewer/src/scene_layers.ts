/** The switches of a scene: one for each thing in it that can be shown or hidden. */
import { number } from './dom';
import { Layers } from './layers';
import { SceneViews } from './scene_views';

export interface Showable {
  visible: boolean;
}

export function addSceneLayers(
  layers: Layers,
  views: SceneViews,
  ground: Showable,
  pictures: Showable | undefined,
): void {
  const { robot, path, contactView, track, voxels, world, graph, plan, kinematics, tree } = views;
  const { perception } = views;
  const show = (
    id: string,
    label: string,
    key: string,
    object: Showable | null | undefined,
    there: boolean,
    on = true,
  ) => {
    if (!object || !there) return;
    layers.add({ id, label, key, on, apply: (visible) => (object.visible = visible) });
  };
  if (robot?.hasCollision && robot.hasVisual) {
    layers.add({
      id: 'collision',
      label: 'Collision shapes',
      key: 'v',
      on: false,
      apply: (on) => robot.showCollision(on),
    });
  }
  const ghosts = plan?.steps ? 'Ghosts of all stances' : 'Ghosts of key configurations';
  show('ghosts', ghosts, 'g', robot?.ghosts, (plan?.count ?? 0) > 1, false);
  show('planned', 'Ghost where the plan has it', 'h', robot?.planned, plan?.recorded ?? false);
  const contacts = (track?.most ?? 0) > 0;
  show('dots', 'Contact path', 'd', path?.dots, contacts && plan!.count > 1);
  if (contacts && plan!.count > 1) {
    layers.add({
      id: 'by_time',
      label: 'Colour path by the time shown',
      apply: () => {},
      on: plan!.executed === null || plan!.executed >= plan!.count - 1,
    });
  }
  const drives = !!kinematics?.floating && (plan?.count ?? 0) > 1;
  show('base', 'Base path', 'b', path?.lines, drives);
  const tried = `Tree of stances (${number(tree?.tried ?? 0)} moves tried)`;
  show('tree', tried, 'e', tree?.group, (tree?.tried ?? 0) > 0, false);
  show('reference', 'Reference plan', 'r', path?.referenceLine, !!plan?.reference);
  show('contacts', 'Contacts, areas and normals', 'c', contactView?.contacts, contacts);
  show('forces', 'Forces and friction cones', 'f', contactView?.forces, track?.hasForces ?? false);
  const massive = (kinematics?.mass ?? 0) > 0;
  show('com', 'Centre of mass and support', 's', contactView?.balance, massive);
  show('map', 'Map', 'm', voxels?.group, (voxels?.count ?? 0) > 0);
  show('clouds', 'Clouds of the cameras', 'k', perception?.kept, true);
  show('taken', 'What the self-filter took', 'j', perception?.taken, true);
  show('beyond', 'Beyond the range of the map', 'q', perception?.beyond, true, false);
  show('seen', 'Map around the robot', 'w', perception?.voxels, true);
  show('field', 'Slice of the distance field', 'z', perception?.slice, true);
  show('obstacles', 'Obstacles', 'o', world.obstacles, world.obstacles.children.length > 0);
  show('surfaces', 'Surfaces and bars', 'u', world.surfaces, world.surfaces.children.length > 0);
  if (views.violations.group.children.length > 0) {
    layers.add({
      id: 'violations',
      label: 'Violations',
      key: 'x',
      on: true,
      apply: (on) => views.violations.setVisible(on),
    });
  }
  show('after', graph?.hasBefore ? 'After optimisation' : 'Odometry', 'a', graph?.after, !!graph);
  show('before', 'Before optimisation', 'b', graph?.before, graph?.hasBefore ?? false);
  show('loops', 'Loop closures', 'c', graph?.loops, (graph?.loopCount ?? 0) > 0);
  show('landmarks', 'Landmarks', 'm', graph?.landmarks, (graph?.pointCount ?? 0) > 0);
  show('ground', 'Ground grid', 'n', ground, true, !graph);
  show('pictures', 'Pictures of the stances', 'i', pictures, true);
}
