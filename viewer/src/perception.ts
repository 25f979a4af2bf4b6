/**
 * What cameras have seen of the world by a time: the newest cloud of each, and the map around the
 * robot, with the distances to what is occupied in it.
 */
import {
  CloudDescription,
  LocalMapDescription,
  PerceptionDescription,
  SceneError,
  SeenDescription,
  unpackBytes,
} from './scene_format';

/** Distances beyond are not told apart. */
export const FIELD_REACH_M = 1;
/** Times of plans are rounded to a microsecond. */
const SAME_TIME_S = 2e-6;

/** Of a voxel. */
export const UNKNOWN = 0;
export const OCCUPIED = 2;

export class Perception {
  clouds: CloudDescription[] = [];
  maps: LocalMapDescription[] = [];

  constructor(readonly description: PerceptionDescription) {
    this.add(description);
  }

  /** What is later than all that is there. */
  add({ clouds, maps }: SeenDescription): void {
    this.clouds.push(...(clouds ?? []));
    this.maps.push(...(maps ?? []));
  }

  clear(): void {
    this.clouds = [];
    this.maps = [];
  }

  /** Of a camera, by its index. */
  newestCloud(camera: number, time: number): CloudDescription | null {
    return last(this.clouds, (c) => c.camera === camera && c.stamp <= time + SAME_TIME_S);
  }

  newestMap(time: number): LocalMapDescription | null {
    return last(this.maps, (map) => map.time <= time + SAME_TIME_S);
  }
}

function last<T>(all: T[], is: (one: T) => boolean): T | null {
  for (let i = all.length - 1; i >= 0; --i) if (is(all[i])) return all[i];
  return null;
}

/**
 * A state for each voxel, along x, then y, then z. Runs of voxels that are alike are numbers of seven
 * bits a byte, the lowest first, the highest bit set in all bytes but the last: three times the length
 * of the run, and its state.
 */
export function unpackStates({ size, states }: LocalMapDescription): Uint8Array {
  const bytes = unpackBytes(states, 'the map around the robot');
  const voxels = new Uint8Array(size[0] * size[1] * size[2]);
  let at = 0;
  for (let i = 0, run = 0, scale = 1; i < bytes.length; ++i) {
    run += (bytes[i] & 127) * scale;
    scale *= 128;
    if (bytes[i] & 128) continue;
    const length = Math.floor(run / 3);
    voxels.fill(run % 3, at, at + length);
    at += length;
    run = 0;
    scale = 1;
  }
  if (at !== voxels.length) {
    throw new SceneError(`The map around the robot has ${at} voxels instead of ${voxels.length}.`);
  }
  return voxels;
}

/**
 * Squared distances, in voxels, from the centres of a layer to those of the nearest obstacle, exact up
 * to `reach`; `outside`: all that is beyond the voxels is an obstacle.
 */
export function squaredDistances(
  isObstacle: Uint8Array,
  [nx, ny, nz]: number[],
  layer: number,
  reach: number,
  outside: boolean,
): Float32Array {
  const layerSize = nx * ny;
  const far = (reach + 1) ** 2;
  let from = new Float32Array(layerSize).fill(far);
  for (let k = Math.max(layer - reach, -1); k <= Math.min(layer + reach, nz); ++k) {
    const inside = k >= 0 && k < nz;
    if (!inside && !outside) continue;
    const squared = (k - layer) ** 2;
    for (let i = 0; i < layerSize; ++i) {
      if (squared < from[i] && (!inside || isObstacle[k * layerSize + i])) from[i] = squared;
    }
  }
  // Then along y and along x, the distances so far being squared ones to the nearest in a row.
  for (const [step, count] of [
    [nx, ny],
    [1, nx],
  ]) {
    const to = from.slice();
    for (let i = 0; i < layerSize; ++i) {
      const place = Math.floor(i / step) % count;
      for (let away = 1; away <= reach; ++away) {
        const squared = away * away;
        if (squared >= to[i]) break;
        for (const there of [place - away, place + away]) {
          const inside = there >= 0 && there < count;
          if (!inside && !outside) continue;
          const beyond = inside ? from[i + (there - place) * step] : 0;
          if (beyond + squared < to[i]) to[i] = beyond + squared;
        }
      }
    }
    from = to;
  }
  return from;
}
