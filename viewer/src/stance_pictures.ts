/**
 * Pictures for the strip of a plan of stances: the robot as it enters each of them, all from one
 * direction and one distance. They are drawn once, when they come into sight, one in a frame.
 */
import { Box3, PerspectiveCamera, Vector3 } from 'three';
import { headingOf, threeQuarterView } from './cameras';
import { kindColour } from './contacts';
import { PictureCaption, PictureStrip } from './picture_strip';
import { Plan } from './plan';
import { Scene } from './scene_format';
import { Showable } from './scene_layers';
import { SceneViews } from './scene_views';
import { Stage } from './stage';
import { changesOf, changeText } from './stances';
import { hex } from './theme';
import { Mark } from './violation_view';

/** While something moves on the page, pictures wait for each other [ms]. */
const PAUSE_MS = 300;
/** Height of a picture, for that of what it shows. */
const MARGIN = 1.06;

export class StancePictures {
  private readonly camera = new PerspectiveCamera(24, 1);
  /** Axes of the camera in the world. */
  private readonly right = new Vector3();
  private readonly above = new Vector3();
  private readonly towards = new Vector3();
  /** Of the robot and its contacts, along these axes. */
  private readonly seen = new Box3();
  private readonly point = new Vector3();
  private distance = 0;
  private radius = 0;
  private last: number | null = null;

  constructor(
    private readonly views: SceneViews,
    private readonly plan: Plan,
    private readonly stage: Stage,
    readonly strip: PictureStrip,
  ) {
    this.camera.up.set(0, 0, 1);
    this.camera.aspect = strip.aspect;
  }

  /**
   * Draws one more picture if one is wanted; `busy`: the page itself has something to draw. Says
   * whether it did: then the views show another time than the player's, and the canvas the picture.
   */
  draw(now: number, busy: boolean): boolean {
    this.last ??= now;
    if (busy && now - this.last < PAUSE_MS) return false;
    const index = this.strip.next();
    if (index < 0) return false;
    this.last = now;
    if (this.distance === 0) this.stand();
    this.aimAt(index);
    const restore = this.showRobotAndWorld();
    this.strip.paint(index, (drawing) => {
      this.stage.picture(this.camera, drawing);
      this.dotContacts(index, drawing);
    });
    restore();
    return true;
  }

  /** The direction from where the robot looks at first, the distance from all stances. */
  private stand(): void {
    const { views, plan, camera } = this;
    views.update(plan.times[0]);
    threeQuarterView(headingOf(views.worldFromBase!), this.towards);
    this.right.crossVectors(camera.up, this.towards).normalize();
    this.above.crossVectors(this.towards, this.right);
    const slope = Math.tan((0.5 * camera.fov * Math.PI) / 180);
    const size = new Vector3();
    for (let i = 0; i < plan.count; ++i) {
      this.measure(i).getSize(size);
      const half = 0.5 * MARGIN * Math.max(size.x / camera.aspect, size.y);
      this.distance = Math.max(this.distance, half / slope + 0.5 * size.z);
      this.radius = Math.max(this.radius, 0.5 * size.length());
    }
    // What stands between the camera and the robot is cut off.
    camera.near = Math.max(this.distance - 1.2 * this.radius, 0.05 * this.distance);
    camera.far = this.distance + 40 * this.radius;
    camera.updateProjectionMatrix();
  }

  private measure(index: number): Box3 {
    const { views, seen, point } = this;
    views.update(this.plan.times[index]);
    seen.makeEmpty();
    const add = (place: Vector3) => {
      const { right, above, towards } = this;
      seen.expandByPoint(point.set(place.dot(right), place.dot(above), place.dot(towards)));
    };
    views.robot!.corners(add);
    for (const { position } of this.plan.contacts[index] ?? []) add(new Vector3(...position));
    if (seen.isEmpty()) add(views.basePosition);
    return seen;
  }

  private aimAt(index: number): void {
    const { views, camera, point } = this;
    const { x, y, z } = this.measure(index).getCenter(point);
    point.set(0, 0, 0).addScaledVector(this.right, x).addScaledVector(this.above, y);
    point.addScaledVector(this.towards, z);
    camera.position.copy(point).addScaledVector(this.towards, this.distance);
    camera.lookAt(point);
    this.stage.lightAt(views.basePosition, Math.max(1.3 * this.radius, 1.2));
  }

  /** Contacts are small in a small picture: each gets a dot, seen through what is before it. */
  private dotContacts(index: number, drawing: CanvasRenderingContext2D): void {
    const { width, height } = drawing.canvas;
    drawing.lineWidth = 0.016 * height;
    drawing.strokeStyle = '#ffffff';
    for (const { position, kind } of this.plan.contacts[index] ?? []) {
      const { x, y } = this.point.fromArray(position).project(this.camera);
      drawing.fillStyle = hex(kindColour(kind));
      drawing.beginPath();
      drawing.arc((0.5 + 0.5 * x) * width, (0.5 - 0.5 * y) * height, 0.034 * height, 0, 2 * Math.PI);
      drawing.fill();
      drawing.stroke();
    }
  }

  /** The robot, its contacts and the world, whatever the page shows; gives what restores that. */
  private showRobotAndWorld(): () => void {
    const { robot, contactView, world, voxels, path, tree, violations } = this.views;
    const collision = robot!.collisionShown;
    robot!.showCollision(!robot!.hasVisual);
    const shown = [contactView?.contacts, world.obstacles, world.surfaces, voxels?.group];
    const balance = [contactView?.forces, contactView?.balance];
    const lines = [path?.dots, path?.lines, path?.referenceLine, tree?.group];
    const before: [Showable, boolean][] = [];
    const set = (on: boolean, objects: (Showable | undefined)[]) => {
      for (const object of objects) {
        if (!object) continue;
        before.push([object, object.visible]);
        object.visible = on;
      }
    };
    set(true, [...shown, this.stage.ground]);
    set(false, [...balance, ...lines, robot!.ghosts, violations.group]);
    return () => {
      robot!.showCollision(collision);
      for (const [object, visible] of before) object.visible = visible;
    };
  }
}

/** What each stance takes and leaves, and whether something is violated there. */
export function captionsOf(scene: Scene, plan: Plan, marks: Mark[]): PictureCaption[] {
  const captions = Array.from({ length: plan.count }, () => ({ text: '', bad: false }));
  const stances = scene.stances ?? [];
  changesOf(stances).forEach((change, i) => {
    const caption = captions[stances[i].from];
    if (caption) caption.text = changeText(change);
  });
  for (const { violation, time } of marks) {
    if (violation.violated && time !== null) captions[plan.indexAt(time)].bad = true;
  }
  return captions;
}
