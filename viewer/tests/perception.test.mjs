// What cameras have seen by a time, and the distances in the map around the robot. No browser.
import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { localMap, perceptionScene } from './scenes.mjs';
import { source } from './sources.mjs';

const { Perception, squaredDistances, unpackStates } = await source('perception');

const SIZE = [9, 7, 5];
const REACH = 4;

/** The same numbers in each run. */
function someObstacles(share) {
  let state = 7;
  return Uint8Array.from({ length: SIZE[0] * SIZE[1] * SIZE[2] }, () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Number(state / 2 ** 32 < share);
  });
}

/** By looking at every voxel within reach. */
function nearest(obstacles, x, y, z, outside) {
  const [nx, ny, nz] = SIZE;
  let least = (REACH + 1) ** 2;
  for (let k = z - REACH; k <= z + REACH; ++k) {
    for (let j = y - REACH; j <= y + REACH; ++j) {
      for (let i = x - REACH; i <= x + REACH; ++i) {
        const inside = i >= 0 && i < nx && j >= 0 && j < ny && k >= 0 && k < nz;
        if (inside ? !obstacles[(k * ny + j) * nx + i] : !outside) continue;
        least = Math.min(least, (i - x) ** 2 + (j - y) ** 2 + (k - z) ** 2);
      }
    }
  }
  return least;
}

describe('perception', () => {
  it('has the exact distances of every layer, whether outside is free or not', () => {
    for (const share of [0, 0.01, 0.1]) {
      const obstacles = someObstacles(share);
      for (const outside of [false, true]) {
        for (let z = 0; z < SIZE[2]; ++z) {
          const squared = squaredDistances(obstacles, SIZE, z, REACH, outside);
          for (let y = 0; y < SIZE[1]; ++y) {
            for (let x = 0; x < SIZE[0]; ++x) {
              const expected = nearest(obstacles, x, y, z, outside);
              assert.equal(squared[y * SIZE[0] + x], expected, `${share} ${outside} ${x} ${y} ${z}`);
            }
          }
        }
      }
    }
  });

  it('unpacks runs of voxels, also long ones, and refuses those that do not fill the map', () => {
    const states = [...Array(300).fill(0), 2, 2, ...Array(80).fill(1), 0, 2];
    const map = localMap(0, [0, 0, 0], [states.length, 1, 1], states);
    assert.deepEqual([...unpackStates(map)], states);
    assert.throws(() => unpackStates({ ...map, size: [states.length + 1, 1, 1] }), /384 voxels/);
  });

  it('knows what was newest at a time, and forgets all of it', () => {
    const { perception } = perceptionScene();
    const seen = new Perception(perception);
    const at = (time) => [seen.newestCloud(0, time)?.stamp, seen.newestMap(time)?.time];
    assert.deepEqual(at(-1), [undefined, undefined]);
    assert.deepEqual(at(0), [-0.1, 0]);
    assert.deepEqual(at(9.95), [9.9, 0]);
    assert.deepEqual(at(1e6), [9.9, 10]);
    assert.equal(seen.newestCloud(1, 5), null);
    seen.clear();
    assert.deepEqual(at(1e6), [undefined, undefined]);
    seen.add({ clouds: perception.clouds.slice(0, 1), maps: [] });
    assert.deepEqual(at(1e6), [-0.1, undefined]);
  });
});
