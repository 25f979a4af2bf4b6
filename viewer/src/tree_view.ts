/**
 * What the search for stances tried: a line for each move, between the middles of the contacts
 * before and after it, coloured by how many moves lie before; what failed is faint.
 */
import { Color, Group } from 'three';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { fatLine } from './path_view';
import { SceneError, TreeDescription, unpackFloats, unpackIntegers } from './scene_format';
import { Theme } from './theme';

/** From the first moves to the deepest ones. */
export const DEPTH_COLOURS = [0xf59f00, 0xe8590c, 0xd6336c, 0x845ef7];
/** Middles of contacts often lie in the floor. */
const LIFT_M = 0.015;

const FAILED = 0;
const ON_THE_WAY = 2;

export class TreeView {
  readonly group = new Group();
  /** Of moves, without the roots. */
  readonly tried: number = 0;
  readonly deepest: number = 0;
  readonly hasWay: boolean;
  readonly hasFailed: boolean;

  private readonly way = fatLine(4.5);

  constructor(tree: TreeDescription) {
    const centres = unpackFloats(tree.centres, 3, 'the centres of the tree');
    const parents = unpackIntegers(tree.parents, 1, 'the parents of the tree');
    const states = unpackIntegers(tree.states, 1, 'the states of the tree');
    const count = parents.length;
    if (centres.length !== 3 * count || states.length !== count) {
      throw new SceneError(
        `The tree has ${centres.length / 3} centres, ${count} parents and ${states.length} states.`,
      );
    }
    const depths = new Int32Array(count);
    for (let i = 0; i < count; ++i) {
      if (parents[i] >= i) {
        throw new SceneError(`Node ${i} of the tree comes before its parent ${parents[i]}.`);
      }
      if (parents[i] < 0) continue;
      depths[i] = depths[parents[i]] + 1;
      this.deepest = Math.max(this.deepest, depths[i]);
      ++this.tried;
    }
    const moves = (is: (state: number) => boolean) =>
      Array.from(parents.keys()).filter((i) => parents[i] >= 0 && is(states[i]));
    const failed = moves((state) => state === FAILED);
    const way = moves((state) => state === ON_THE_WAY);
    this.hasFailed = failed.length > 0;
    this.hasWay = way.length > 0;

    const positions = (nodes: number[]) =>
      nodes.flatMap((node) =>
        [parents[node], node].flatMap((end) => [
          centres[3 * end],
          centres[3 * end + 1],
          centres[3 * end + 2] + LIFT_M,
        ]),
      );
    const colours = (nodes: number[]) =>
      nodes.flatMap((node) => {
        const colour = depthColour((depths[node] - 1) / Math.max(this.deepest - 1, 1)).toArray();
        return [...colour, ...colour];
      });
    const add = (nodes: number[], material: LineMaterial, order: number) => {
      if (nodes.length === 0) return;
      const geometry = new LineSegmentsGeometry();
      geometry.setPositions(positions(nodes));
      if (material.vertexColors) geometry.setColors(colours(nodes));
      const lines = new LineSegments2(geometry, material);
      lines.renderOrder = order;
      this.group.add(lines);
    };
    const [faint, plain] = [fatLine(1, 0.28), fatLine(2)];
    faint.vertexColors = plain.vertexColors = true;
    faint.depthWrite = false;
    // The way is seen through the robot.
    this.way.transparent = true;
    this.way.depthTest = this.way.depthWrite = false;
    add(failed, faint, 3);
    add(moves((state) => state !== FAILED), plain, 4);
    add(way, this.way, 36);
  }

  applyTheme(theme: Theme): void {
    this.way.color.set(theme.executed);
  }
}

/** `fraction`: 0 for the first moves, 1 for the deepest ones. */
function depthColour(fraction: number): Color {
  const place = fraction * (DEPTH_COLOURS.length - 1);
  const before = Math.min(Math.floor(place), DEPTH_COLOURS.length - 2);
  return new Color(DEPTH_COLOURS[before]).lerp(new Color(DEPTH_COLOURS[before + 1]), place - before);
}
