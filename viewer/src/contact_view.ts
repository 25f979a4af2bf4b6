/** Contacts now: areas, points and patches coloured by kind, normals, wrenches, friction cones, CoM and support. */
import {
  BufferAttribute,
  BufferGeometry,
  CircleGeometry,
  Color,
  ConeGeometry,
  DoubleSide,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  Quaternion,
  RingGeometry,
  SphereGeometry,
  Vector3,
} from 'three';
import { AreaView } from './area_view';
import { Arrows } from './arrows';
import { ContactTrack, kindColour } from './contacts';
import { Kinematics } from './kinematics';
import { Contact, Vector } from './scene_format';
import { cylinderAlongZ } from './shapes';
import { Theme } from './theme';

const Z = new Vector3(0, 0, 1);
const CONE_HEIGHT_M = 0.24;
const MOST_CORNERS = 24;

export class ContactView {
  readonly contacts = new Group();
  readonly forces = new Group();
  readonly balance = new Group();
  readonly centreOfMass = new Vector3();
  /** Metres of arrow for a newton and for a newton metre. */
  readonly forceScale: number;

  private readonly areas: AreaView;
  private readonly patches: InstancedMesh;
  private readonly points: InstancedMesh;
  private readonly cones: InstancedMesh[];
  private readonly normals: Arrows;
  private readonly forceArrows: Arrows;
  private readonly momentArrows: Arrows;
  private readonly coneMaterials: MeshBasicMaterial[];
  private readonly massMaterial = new MeshLambertMaterial({
    transparent: true,
    depthTest: false,
    depthWrite: false,
  });
  private readonly sphere: Mesh;
  private readonly shadowRing: Mesh;
  private readonly plumb: Mesh;
  private readonly support: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly corners = new Float32Array(3 * MOST_CORNERS);
  private readonly feet: Vector[] = [];
  private readonly hull: number[] = [];

  private readonly matrix = new Matrix4();
  private readonly rotation = new Quaternion();
  private readonly place = new Vector3();
  private readonly normal = new Vector3();
  private readonly scale = new Vector3();
  private readonly colour = new Color();

  /** `scale`: 1 for a robot of human size. */
  constructor(
    private readonly kinematics: Kinematics,
    private readonly track: ContactTrack | null,
    private readonly robotScale: number,
  ) {
    const most = Math.max(track?.most ?? 0, 1);
    const weight = Math.max(kinematics.mass * 9.80665, 1);
    this.forceScale = (1.1 * robotScale) / weight;
    this.patches = new InstancedMesh(
      new CircleGeometry(1, 36),
      new MeshBasicMaterial({
        transparent: true,
        opacity: 0.75,
        side: DoubleSide,
        depthWrite: false,
      }),
      most,
    );
    this.points = new InstancedMesh(
      new SphereGeometry(0.014 * robotScale, 16, 12),
      new MeshBasicMaterial({ transparent: true, depthTest: false, depthWrite: false }),
      most,
    );
    this.areas = new AreaView(most);
    const glass = { transparent: true, side: DoubleSide, depthWrite: false };
    this.coneMaterials = [
      new MeshBasicMaterial({ ...glass, opacity: 0.14 }),
      new MeshBasicMaterial({ ...glass, opacity: 0.4, wireframe: true, depthTest: false }),
    ];
    const cone = new ConeGeometry(1, 1, 18, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5);
    this.cones = this.coneMaterials.map((material) => new InstancedMesh(cone, material, most));
    for (const mesh of [this.patches, this.points, ...this.cones]) {
      mesh.frustumCulled = false;
      mesh.renderOrder = 20;
    }
    // Seen through feet and balls.
    this.cones[1].renderOrder = 37;
    this.points.renderOrder = 39;
    this.normals = new Arrows(0x495057, 0.006 * robotScale, most);
    this.forceArrows = new Arrows(0, 0.011 * robotScale, most, true);
    this.momentArrows = new Arrows(0, 0.008 * robotScale, most, true);
    this.contacts.add(this.areas.group, this.patches, this.points, this.normals.group);
    this.forces.add(...this.cones, this.forceArrows.group, this.momentArrows.group);

    this.sphere = new Mesh(new SphereGeometry(0.045 * robotScale, 24, 16), this.massMaterial);
    const flat = new MeshBasicMaterial({
      side: DoubleSide,
      transparent: true,
      depthTest: false,
      depthWrite: false,
    });
    flat.color = this.massMaterial.color;
    this.shadowRing = new Mesh(new RingGeometry(0.03 * robotScale, 0.045 * robotScale, 40), flat);
    this.plumb = new Mesh(cylinderAlongZ(0.003 * robotScale, 1, 8).translate(0, 0, 0.5), flat);
    const polygon = new BufferGeometry();
    polygon.setAttribute('position', new BufferAttribute(this.corners, 3));
    this.support = new Mesh(
      polygon,
      new MeshBasicMaterial({
        transparent: true,
        opacity: 0.16,
        side: DoubleSide,
        depthWrite: false,
      }),
    );
    this.support.frustumCulled = false;
    for (const mesh of [this.sphere, this.shadowRing, this.plumb]) mesh.renderOrder = 35;
    const index: number[] = [];
    for (let i = 1; i + 1 < MOST_CORNERS; ++i) index.push(0, i, i + 1);
    polygon.setIndex(index);
    this.balance.add(this.sphere, this.shadowRing, this.plumb, this.support);
    this.balance.visible = kinematics.mass > 0;
  }

  applyTheme(theme: Theme): void {
    this.forceArrows.colour = theme.force;
    this.momentArrows.colour = theme.moment;
    for (const material of this.coneMaterials) material.color.set(theme.cone);
    this.massMaterial.color.set(theme.centreOfMass);
    this.support.material.color.set(theme.base);
  }

  update(): void {
    const contacts = this.track?.current ?? [];
    this.areas.begin();
    this.normals.begin();
    this.forceArrows.begin();
    this.momentArrows.begin();
    let patches = 0;
    let points = 0;
    let cones = 0;
    for (let i = 0; i < contacts.length; ++i) {
      const contact = contacts[i];
      const [x, y, z] = contact.position;
      this.normal.fromArray(contact.normal).normalize();
      this.rotation.setFromUnitVectors(Z, this.normal);
      this.colour.set(kindColour(contact.kind));
      this.place.set(x, y, z).addScaledVector(this.normal, 0.004);
      if (contact.area) {
        this.areas.add(contact.area, this.normal, this.colour);
      } else {
        const size = 0.055 * this.robotScale;
        this.matrix.compose(this.place, this.rotation, this.scale.set(size, size, size));
        this.patches.setMatrixAt(patches, this.matrix);
        this.patches.setColorAt(patches++, this.colour);
      }
      if (contact.kind === 'point') {
        this.points.setMatrixAt(points, this.matrix.makeTranslation(x, y, z));
        this.points.setColorAt(points++, this.colour);
      }
      this.normals.add(
        x,
        y,
        z,
        this.normal.x,
        this.normal.y,
        this.normal.z,
        0.17 * this.robotScale,
      );
      if (contact.force) {
        const [fx, fy, fz] = contact.force;
        this.forceArrows.add(x, y, z, fx, fy, fz, this.forceScale);
      }
      if (contact.friction && this.track?.hasForces) {
        const height = CONE_HEIGHT_M * this.robotScale;
        const radius = height * contact.friction;
        this.matrix.compose(this.place, this.rotation, this.scale.set(radius, radius, height));
        for (const mesh of this.cones) mesh.setMatrixAt(cones, this.matrix);
        ++cones;
      }
      if (contact.moment) {
        const [mx, my, mz] = contact.moment;
        this.momentArrows.add(x, y, z, mx, my, mz, 4 * this.forceScale);
      }
    }
    this.patches.count = patches;
    this.points.count = points;
    for (const mesh of this.cones) mesh.count = cones;
    for (const mesh of [this.patches, this.points, ...this.cones]) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    this.areas.end();
    this.normals.end();
    this.forceArrows.end();
    this.momentArrows.end();
    if (this.kinematics.mass > 0) this.updateBalance(contacts);
  }

  private updateBalance(contacts: Contact[]): void {
    const com = this.kinematics.centreOfMass(this.centreOfMass);
    let floor = contacts.length > 0 ? Infinity : 0;
    for (const contact of contacts) floor = Math.min(floor, contact.position[2]);
    this.sphere.position.copy(com);
    this.shadowRing.position.set(com.x, com.y, floor + 0.006);
    this.plumb.position.set(com.x, com.y, floor);
    this.plumb.scale.z = Math.max(com.z - floor, 1e-3);
    const corners = this.supportHull(contacts);
    // Where a contact leans on a wall, what is below the robot says nothing of its balance.
    this.support.visible = corners >= 3 && contacts.every(({ normal }) => normal[2] > 0.95);
    for (let i = 0; i < corners; ++i) {
      const [x, y] = this.feet[this.hull[i]];
      this.corners[3 * i] = x;
      this.corners[3 * i + 1] = y;
      this.corners[3 * i + 2] = floor + 0.003;
    }
    this.support.geometry.setDrawRange(0, 3 * Math.max(corners - 2, 0));
    this.support.geometry.attributes.position.needsUpdate = true;
  }

  /** Convex hull of the contacts seen from above (gift wrapping); how many corners it has. */
  private supportHull(contacts: Contact[]): number {
    const { feet } = this;
    this.hull.length = feet.length = 0;
    for (const { area, position } of contacts) feet.push(...(area ?? [position]));
    if (feet.length < 3) return 0;
    let first = 0;
    for (let i = 1; i < feet.length; ++i) {
      if (feet[i][0] < feet[first][0]) first = i;
    }
    let corner = first;
    do {
      this.hull.push(corner);
      let next = corner === 0 ? 1 : 0;
      const [px, py] = feet[corner];
      for (let i = 0; i < feet.length; ++i) {
        const [ax, ay] = feet[next];
        const [bx, by] = feet[i];
        if ((ax - px) * (by - py) - (ay - py) * (bx - px) < 0) next = i;
      }
      corner = next;
    } while (corner !== first && this.hull.length < Math.min(feet.length, MOST_CORNERS));
    return this.hull.length;
  }
}
