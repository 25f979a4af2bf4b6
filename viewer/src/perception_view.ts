/**
 * What cameras show: their newest clouds, what of them the self-filter took, the occupied voxels of the
 * map around the robot, and a level slice of the distance to these.
 */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  Group,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Object3D,
  PlaneGeometry,
  Points,
  PointsMaterial,
  Quaternion,
  SRGBColorSpace,
  Vector3,
} from 'three';
import {
  FIELD_REACH_M,
  OCCUPIED,
  Perception,
  squaredDistances,
  UNKNOWN,
  unpackStates,
} from './perception';
import {
  CloudDescription,
  LocalMapDescription,
  PerceptionDescription,
  SeenDescription,
  unpackBytes,
  unpackShorts,
} from './scene_format';
import { FIELD_COLOURS, SEEN_COLOURS, Theme } from './theme';
import { heightMaterial, voxelGeometry } from './voxel_view';

const DEPTH_UNIT_M = 0.002;
/** Pixels of a square that may be shown, along its sides: how their places are numbered. */
const PLACES_ALONG = 15;
const POINT_PIXELS = 3;
/** Points and things that were seen shine through their voxels. */
const VOXEL_OPACITY = 0.45;
/** Of the slice above the floor, at first: where wheels and shins are. */
const FIRST_HEIGHT_M = 0.25;
const MOST_HEIGHT_M = 2;

export interface CloudCount {
  name: string;
  /** Null: nothing was seen yet. */
  stamp: number | null;
  kept: number;
  taken: number;
}

export class PerceptionView {
  readonly kept = new Group();
  readonly taken = new Group();
  readonly beyond = new Group();
  readonly voxels = new Group();
  readonly slice = new Group();
  /** Of the newest clouds of all cameras. */
  readonly counts: CloudCount[];
  /** Heights of what is shown of the map; those that the slice may have. */
  readonly lowest: number;
  readonly highest: number;
  readonly step: number;

  private readonly perception: Perception;
  private readonly seenPoints = new CloudPoints();
  private readonly takenPoints = new CloudPoints();
  private readonly beyondPoints = new CloudPoints();
  private readonly cubes: Mesh;
  private readonly plane: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly colours = { seen: new Color(), floor: new Color() };
  private wanted: number;
  private time = Number.NaN;
  private shownClouds: (CloudDescription | null)[] = [];
  private shownMap: LocalMapDescription | null = null;
  private states: Uint8Array = new Uint8Array();
  private drawnMap: LocalMapDescription | null = null;
  private drawnSlice: { map: LocalMapDescription; layer: number } | null = null;
  private occupied = 0;

  constructor(description: PerceptionDescription) {
    this.perception = new Perception(description);
    const { resolution, floor, cameras } = description;
    this.step = resolution;
    const window = this.perception.maps[0];
    this.lowest = floor ?? (window ? window.first[2] * resolution : 0);
    const top = window ? (window.first[2] + window.size[2]) * resolution : Infinity;
    this.highest = Math.max(Math.min(top, this.lowest + MOST_HEIGHT_M), this.lowest + resolution);
    this.wanted = this.lowest + FIRST_HEIGHT_M;
    this.counts = cameras.map(({ name }) => ({ name, stamp: null, kept: 0, taken: 0 }));
    this.kept.add(this.seenPoints.points);
    this.taken.add(this.takenPoints.points);
    this.beyond.add(this.beyondPoints.points);
    const material = heightMaterial(this.lowest, this.highest, SEEN_COLOURS);
    material.transparent = true;
    material.opacity = VOXEL_OPACITY;
    material.depthWrite = false;
    this.cubes = new Mesh(new BufferGeometry(), material);
    this.cubes.frustumCulled = false;
    this.cubes.renderOrder = 3;
    this.voxels.add(this.cubes);
    this.plane = new Mesh(
      new PlaneGeometry(1, 1),
      new MeshBasicMaterial({ transparent: true, depthWrite: false, side: DoubleSide }),
    );
    this.plane.renderOrder = 2;
    this.plane.visible = false;
    this.slice.add(this.plane);
  }

  get objects(): Object3D[] {
    return [this.kept, this.taken, this.beyond, this.voxels, this.slice];
  }

  get hasFloor(): boolean {
    return this.perception.description.floor !== undefined;
  }

  /** Of the layer of voxels at a height. */
  middle(height: number): number {
    return (layerAt(height, this.step) + 0.5) * this.step;
  }

  /** Of the slice. */
  get height(): number {
    return this.middle(this.wanted);
  }

  setHeight(height: number): void {
    this.wanted = Math.min(Math.max(height, this.lowest), this.highest);
    this.drawMap();
  }

  applyTheme(theme: Theme): void {
    this.colours.seen.set(theme.seen);
    this.colours.floor.set(theme.floor);
    this.takenPoints.material.color.set(theme.taken);
    this.beyondPoints.material.color.set(theme.beyond);
    this.shownClouds = [];
    this.update(this.time);
  }

  add(seen: SeenDescription): void {
    this.perception.add(seen);
  }

  clear(): void {
    this.perception.clear();
    this.update(this.time);
  }

  update(time: number): void {
    this.time = time;
    const newest = this.counts.map((_, camera) => this.perception.newestCloud(camera, time));
    if (newest.some((cloud, camera) => cloud !== this.shownClouds[camera])) {
      this.shownClouds = newest;
      this.drawClouds();
    }
    const map = this.perception.newestMap(time);
    if (map !== this.shownMap) {
      this.shownMap = map;
      this.states = map ? unpackStates(map) : new Uint8Array();
    }
    this.drawMap();
  }

  /** What is shown, in figures. */
  state() {
    return {
      kept: this.seenPoints.count,
      taken: this.takenPoints.count,
      beyond: this.beyondPoints.count,
      occupied: this.occupied,
      slice: this.height,
      mapTime: this.shownMap?.time ?? null,
      clouds: this.perception.clouds.length,
      maps: this.perception.maps.length,
    };
  }

  private drawClouds(): void {
    const all = [this.seenPoints, this.takenPoints, this.beyondPoints];
    for (const points of all) points.begin();
    this.shownClouds.forEach((cloud, camera) => {
      const [seen, taken] = [this.seenPoints.count, this.takenPoints.count];
      if (cloud) this.addCloud(cloud);
      const count = this.counts[camera];
      count.stamp = cloud?.stamp ?? null;
      count.kept = this.seenPoints.count - seen;
      count.taken = this.takenPoints.count - taken;
    });
    for (const points of all) points.end();
  }

  private addCloud(cloud: CloudDescription): void {
    const { cameras, floor } = this.perception.description;
    const { name, square, between, columns, rows, focal, centre, range } = cameras[cloud.camera];
    const { pose } = cloud;
    const numbers = unpackShorts(cloud.depths, columns * rows, `a cloud of ${name}`);
    const places = unpackBytes(cloud.places, `a cloud of ${name}`);
    const world = new Matrix4().compose(
      new Vector3(pose[0], pose[1], pose[2]),
      new Quaternion(pose[3], pose[4], pose[5], pose[6]),
      new Vector3(1, 1, 1),
    );
    const point = new Vector3();
    numbers.forEach((number, i) => {
      if (number === 0) return;
      const depth = Math.abs(number) * DEPTH_UNIT_M;
      const u = square * (i % columns) + between * (places[i] % PLACES_ALONG);
      const v = square * Math.floor(i / columns) + between * Math.floor(places[i] / PLACES_ALONG);
      point.set(((u - centre[0]) / focal[0]) * depth, ((v - centre[1]) / focal[1]) * depth, depth);
      point.applyMatrix4(world);
      if (number < 0) {
        this.takenPoints.add(point);
      } else if (depth > range) {
        this.beyondPoints.add(point);
      } else {
        const isFloor = floor !== undefined && point.z < floor;
        this.seenPoints.add(point, isFloor ? this.colours.floor : this.colours.seen);
      }
    });
  }

  private drawMap(): void {
    const map = this.shownMap;
    this.cubes.visible = map !== null;
    this.plane.visible = false;
    if (!map) {
      this.occupied = 0;
      return;
    }
    if (this.voxels.visible && this.drawnMap !== map) this.drawVoxels(map);
    const layer = layerAt(this.wanted, this.step) - map.first[2];
    this.plane.visible = layer >= 0 && layer < map.size[2];
    if (!this.slice.visible || !this.plane.visible) return;
    if (this.drawnSlice?.map !== map || this.drawnSlice.layer !== layer) this.drawSlice(map, layer);
  }

  private drawVoxels(map: LocalMapDescription): void {
    this.drawnMap = map;
    const { first, size } = map;
    const numbers: number[] = [];
    for (let i = this.states.indexOf(OCCUPIED); i >= 0; i = this.states.indexOf(OCCUPIED, i + 1)) {
      const place = [i % size[0], Math.floor(i / size[0]) % size[1], Math.floor(i / size[0] / size[1])];
      for (let axis = 0; axis < 3; ++axis) {
        numbers.push((first[axis] + place[axis] + 0.5) * this.step);
      }
      numbers.push(this.step);
    }
    this.occupied = numbers.length / 4;
    this.cubes.geometry.dispose();
    this.cubes.geometry = voxelGeometry(Float32Array.from(numbers), this.step);
  }

  private drawSlice(map: LocalMapDescription, layer: number): void {
    this.drawnSlice = { map, layer };
    const { first, size } = map;
    const [nx, ny] = size;
    const unknownIsOccupied = this.perception.description.unknown === 'occupied';
    const obstacles = this.states.map((state) =>
      Number(state === OCCUPIED || (unknownIsOccupied && state === UNKNOWN)),
    );
    const reach = Math.ceil(FIELD_REACH_M / this.step);
    const squared = squaredDistances(obstacles, size, layer, reach, unknownIsOccupied);
    const pixels = new Uint8Array(4 * nx * ny);
    const ramp = FIELD_COLOURS.map((colour) => [colour >> 16, (colour >> 8) & 255, colour & 255]);
    for (let i = 0; i < nx * ny; ++i) {
      const state = this.states[layer * nx * ny + i];
      const fraction = Math.min((Math.sqrt(squared[i]) * this.step) / FIELD_REACH_M, 1);
      const place = fraction * (ramp.length - 1);
      const below = Math.min(Math.floor(place), ramp.length - 2);
      for (let k = 0; k < 3; ++k) {
        const value = ramp[below][k] + (place - below) * (ramp[below + 1][k] - ramp[below][k]);
        pixels[4 * i + k] = state === OCCUPIED ? 0.5 * value : value;
      }
      pixels[4 * i + 3] = 255 * opacity(state, fraction);
    }
    const { material } = this.plane;
    material.map?.dispose();
    material.map = new DataTexture(pixels, nx, ny);
    material.map.colorSpace = SRGBColorSpace;
    material.map.needsUpdate = true;
    material.needsUpdate = true;
    this.plane.scale.set(nx * this.step, ny * this.step, 1);
    this.plane.position.set(
      (first[0] + 0.5 * nx) * this.step,
      (first[1] + 0.5 * ny) * this.step,
      this.height,
    );
  }
}

/** Heights between two layers are those of the upper one, whatever was rounded. */
function layerAt(height: number, step: number): number {
  return Math.floor(height / step + 1e-6);
}

/** What is known is plain, what is far from everything faint. */
function opacity(state: number, fraction: number): number {
  if (state === OCCUPIED) return 1;
  return (fraction < 1 ? 0.8 : 0.25) * (state === UNKNOWN ? 0.35 : 1);
}

/** Points that are replaced now and then. */
class CloudPoints {
  readonly material = new PointsMaterial({ size: POINT_PIXELS, sizeAttenuation: false });
  readonly points = new Points(new BufferGeometry(), this.material);
  private positions: number[] = [];
  private colours: number[] = [];

  constructor() {
    this.points.frustumCulled = false;
    // After the voxels, which they lie in.
    this.material.transparent = true;
    this.points.renderOrder = 4;
  }

  get count(): number {
    return this.positions.length / 3;
  }

  begin(): void {
    this.positions = [];
    this.colours = [];
  }

  /** Either all points have a colour or none. */
  add(point: Vector3, colour?: Color): void {
    this.positions.push(point.x, point.y, point.z);
    if (colour) this.colours.push(colour.r, colour.g, colour.b);
  }

  end(): void {
    this.points.geometry.dispose();
    const geometry = new BufferGeometry();
    const attribute = (numbers: number[]) => new BufferAttribute(Float32Array.from(numbers), 3);
    geometry.setAttribute('position', attribute(this.positions));
    const coloured = this.colours.length > 0;
    if (coloured) geometry.setAttribute('color', attribute(this.colours));
    if (this.material.vertexColors !== coloured) {
      this.material.vertexColors = coloured;
      this.material.needsUpdate = true;
    }
    this.points.geometry = geometry;
  }
}
