/** Many arrows of one colour in two draw calls; no allocation when they are set again. */
import {
  ColorRepresentation,
  ConeGeometry,
  CylinderGeometry,
  Group,
  InstancedMesh,
  Matrix4,
  MeshLambertMaterial,
  Quaternion,
  Vector3,
} from 'three';

const Z = new Vector3(0, 0, 1);

export class Arrows {
  readonly group = new Group();
  private readonly shafts: InstancedMesh;
  private readonly heads: InstancedMesh;
  private readonly material: MeshLambertMaterial;
  private readonly matrix = new Matrix4();
  private readonly direction = new Vector3();
  private readonly place = new Vector3();
  private readonly rotation = new Quaternion();
  private readonly scale = new Vector3();
  private count = 0;

  /** `onTop`: seen through what is in front of them. */
  constructor(
    colour: ColorRepresentation,
    private readonly radius: number,
    most: number,
    onTop = false,
  ) {
    this.material = new MeshLambertMaterial({
      color: colour,
      transparent: onTop,
      depthTest: !onTop,
      depthWrite: !onTop,
    });
    const shaft = new CylinderGeometry(1, 1, 1, 14).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const head = new ConeGeometry(1, 1, 18).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    this.shafts = new InstancedMesh(shaft, this.material, most);
    this.heads = new InstancedMesh(head, this.material, most);
    for (const mesh of [this.shafts, this.heads]) {
      mesh.frustumCulled = false;
      mesh.renderOrder = onTop ? 40 : 0;
      this.group.add(mesh);
    }
    this.begin();
    this.end();
  }

  set colour(colour: ColorRepresentation) {
    this.material.color.set(colour);
  }

  begin(): void {
    this.count = 0;
  }

  /** From a point, along a vector, its length times `scale`. */
  add(x: number, y: number, z: number, vx: number, vy: number, vz: number, scale = 1): void {
    const length = scale * Math.hypot(vx, vy, vz);
    if (this.count >= this.shafts.instanceMatrix.count || !(length > 1e-4)) return;
    this.direction.set(vx, vy, vz).normalize();
    this.rotation.setFromUnitVectors(Z, this.direction);
    const head = Math.min(6 * this.radius, 0.45 * length);
    this.place.set(x, y, z);
    this.matrix.compose(
      this.place,
      this.rotation,
      this.scale.set(this.radius, this.radius, length - 0.9 * head),
    );
    this.shafts.setMatrixAt(this.count, this.matrix);
    this.place.addScaledVector(this.direction, length - head);
    this.matrix.compose(
      this.place,
      this.rotation,
      this.scale.set(2.6 * this.radius, 2.6 * this.radius, head),
    );
    this.heads.setMatrixAt(this.count, this.matrix);
    ++this.count;
  }

  end(): void {
    for (const mesh of [this.shafts, this.heads]) {
      mesh.count = this.count;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }
}
