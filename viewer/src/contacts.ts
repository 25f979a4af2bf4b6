/** Contacts of a plan at any time: positions and wrenches between those of its configurations. */
import { Matrix4, Vector3 } from 'three';
import { Kinematics } from './kinematics';
import { Plan } from './plan';
import { Contact } from './scene_format';

/** Colours of contact kinds; other kinds get the last one. */
export const KIND_COLOURS: Record<string, number> = {
  wheel: 0x0c8599,
  surface: 0x1c7ed6,
  point: 0xd6336c,
  rung: 0x7048e8,
  other: 0x5c6773,
};

export function kindColour(kind: string): number {
  return KIND_COLOURS[kind] ?? KIND_COLOURS.other;
}

function emptyContact(): Contact {
  return { link: 0, kind: '', position: [0, 0, 0], normal: [0, 0, 1] };
}

export class ContactTrack {
  /** In force at the time of the last `update`. */
  readonly current: Contact[] = [];
  readonly most: number;
  readonly hasForces: boolean;
  readonly hasMoments: boolean;
  readonly hasFriction: boolean;

  private readonly pool: Contact[];
  private readonly forces: [number, number, number][];
  private readonly moments: [number, number, number][];
  private readonly point = new Vector3();
  private readonly inverse = new Matrix4();
  /** Of a plan with a curve, for each configuration: where the links of its contacts are. */
  private readonly links: Float64Array[] = [];

  /** Moves the kinematics about, here and in replace(). */
  constructor(
    private readonly plan: Plan,
    kinematics: Kinematics,
  ) {
    this.most = plan.contacts.reduce((most, contacts) => Math.max(most, contacts.length), 0);
    const some = (has: (contact: Contact) => unknown) => plan.contacts.some((c) => c.some(has));
    this.hasForces = some((contact) => contact.force);
    this.hasMoments = some((contact) => contact.moment);
    this.hasFriction = this.hasForces && some((contact) => contact.friction);
    this.pool = Array.from({ length: this.most }, emptyContact);
    this.forces = this.pool.map(() => [0, 0, 0]);
    this.moments = this.pool.map(() => [0, 0, 0]);
    if (!plan.slopes || !some(({ kind }) => kind === 'wheel')) return;
    const configuration = new Float32Array(plan.size);
    plan.contacts.slice(0, plan.count).forEach((contacts, i) => {
      plan.copyConfiguration(i, configuration);
      kinematics.update(configuration);
      this.links.push(new Float64Array(3 * contacts.length));
      this.noteLinks(i, kinematics);
    });
  }

  private noteLinks(index: number, kinematics: Kinematics): void {
    const links = this.links[index];
    if (!links) return;
    this.plan.contacts[index].forEach(({ link }, i) => {
      this.point.setFromMatrixPosition(kinematics.worldFromLink[link]).toArray(links, 3 * i);
    });
  }

  /** Brings the contacts to a time [s] that the kinematics has been brought to. */
  update(time: number, kinematics: Kinematics): void {
    const index = this.plan.indexAt(time);
    const fraction = this.plan.fractionAt(time, index);
    const now = this.plan.contacts[index] ?? [];
    const next = this.plan.contacts[index + 1] ?? now;
    this.current.length = 0;
    for (let i = 0; i < now.length; ++i) {
      const a = now[i];
      const same = next[i]?.link === a.link && next[i].kind === a.kind;
      const b = same ? next[i] : a;
      const contact = this.pool[i];
      contact.link = a.link;
      contact.kind = a.kind;
      contact.radius = a.radius;
      contact.friction = a.friction;
      contact.area = a.area;
      contact.force = a.force && b.force ? this.forces[i] : undefined;
      contact.moment = a.moment && b.moment ? this.moments[i] : undefined;
      for (let k = 0; k < 3; ++k) {
        contact.position[k] = a.position[k] + fraction * (b.position[k] - a.position[k]);
        contact.normal[k] = a.normal[k] + fraction * (b.normal[k] - a.normal[k]);
        if (a.force && b.force) {
          this.forces[i][k] = a.force[k] + fraction * (b.force[k] - a.force[k]);
        }
        if (a.moment && b.moment) {
          this.moments[i][k] = a.moment[k] + fraction * (b.moment[k] - a.moment[k]);
        }
      }
      if (same && a.kind === 'wheel' && fraction > 0) {
        this.rollAlong(contact, index, i, fraction, kinematics);
      }
      this.current.push(contact);
    }
  }

  /** Puts what rolls, and is now on the straight way, where the curve has it. */
  private rollAlong(
    contact: Contact,
    index: number,
    i: number,
    fraction: number,
    kinematics: Kinematics,
  ): void {
    const from = this.links[index];
    const to = this.links[index + 1];
    if (!from || !to) return;
    this.point.setFromMatrixPosition(kinematics.worldFromLink[contact.link]);
    for (let k = 0; k < 3; ++k) {
      const straight = from[3 * i + k] + fraction * (to[3 * i + k] - from[3 * i + k]);
      contact.position[k] += this.point.getComponent(k) - straight;
    }
  }

  /**
   * Puts another configuration into the plan; its contacts move with their links. A wheel touches
   * below its axle however far it has turned.
   */
  replace(index: number, configuration: ArrayLike<number>, kinematics: Kinematics): boolean {
    const contacts = this.plan.contacts[index] ?? [];
    const old = new Float32Array(this.plan.size);
    if (index >= 0 && index < this.plan.count) this.plan.copyConfiguration(index, old);
    if (!this.plan.replace(index, configuration)) return false;
    kinematics.update(old);
    const local = contacts.map((contact) => {
      this.inverse.copy(kinematics.worldFromLink[contact.link]).invert();
      return new Vector3().fromArray(contact.position).applyMatrix4(this.inverse);
    });
    const corners = contacts.map((contact) => {
      this.inverse.copy(kinematics.worldFromLink[contact.link]).invert();
      return contact.area?.map((corner) =>
        new Vector3().fromArray(corner).applyMatrix4(this.inverse),
      );
    });
    kinematics.update(configuration);
    this.noteLinks(index, kinematics);
    contacts.forEach((contact, i) => {
      corners[i]?.forEach((corner, k) => {
        corner.applyMatrix4(kinematics.worldFromLink[contact.link]).toArray(contact.area![k]);
      });
      const world = kinematics.worldFromLink[contact.link];
      if (contact.kind === 'wheel' && contact.radius) {
        this.point.setFromMatrixPosition(world);
        for (let k = 0; k < 3; ++k) {
          contact.position[k] = this.point.getComponent(k) - contact.radius * contact.normal[k];
        }
      } else {
        this.point.copy(local[i]).applyMatrix4(world).toArray(contact.position);
      }
    });
    return true;
  }
}
