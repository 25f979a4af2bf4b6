/** Geometry of links and obstacles: primitives along z, as URDF has them, and triangle meshes. */
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  Matrix4,
  SphereGeometry,
} from 'three';
import { mergeGeometries } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import { matrixOf } from './kinematics';
import { RobotDescription, SceneError, ShapeDescription, unpackFloats } from './scene_format';

const DEFAULT_COLOUR = [0.72, 0.75, 0.79, 1];

/** Cylinder along z, as URDF and the scene have it (three.js: along y). */
export function cylinderAlongZ(radius: number, length: number, segments = 28): BufferGeometry {
  return new CylinderGeometry(radius, radius, length, segments).rotateX(Math.PI / 2);
}

export class Meshes {
  private readonly geometries = new Map<number, BufferGeometry>();

  constructor(private readonly robot: RobotDescription) {}

  geometry(index: number): BufferGeometry {
    let geometry = this.geometries.get(index);
    if (!geometry) {
      const mesh = this.robot.meshes?.[index];
      if (!mesh)
        throw new SceneError(`A shape refers to mesh ${index}, which is not in the scene.`);
      geometry = new BufferGeometry();
      const corners = unpackFloats(mesh.triangles, 9, `mesh ${mesh.name}`);
      geometry.setAttribute('position', new BufferAttribute(corners, 3));
      this.geometries.set(index, geometry);
    }
    return geometry.clone();
  }
}

function geometryOf(shape: ShapeDescription, meshes: Meshes): BufferGeometry {
  const [x, y, z] = shape.size ?? [0.1, 0.1, 0.1];
  const radius = shape.radius ?? 0.05;
  const length = shape.length ?? 0.1;
  switch (shape.type) {
    case 'sphere':
      return new SphereGeometry(radius, 28, 18);
    case 'capsule':
      return new CapsuleGeometry(radius, length, 10, 28).rotateX(Math.PI / 2);
    case 'cylinder':
      return cylinderAlongZ(radius, length);
    case 'box':
      return new BoxGeometry(x, y, z);
    case 'mesh': {
      const geometry = meshes.geometry(shape.mesh ?? -1);
      const [sx, sy, sz] = shape.scale ?? [1, 1, 1];
      geometry.applyMatrix4(new Matrix4().makeScale(sx, sy, sz));
      geometry.computeVertexNormals();
      return geometry;
    }
    default:
      throw new SceneError(`Unknown shape "${String(shape.type)}".`);
  }
}

/** All shapes of a link as one geometry with vertex colours; null if there are none. */
export function linkGeometry(
  shapes: ShapeDescription[] | undefined,
  meshes: Meshes,
  colour?: number[],
): BufferGeometry | null {
  if (!shapes?.length) return null;
  const parts = shapes.map((shape) => {
    const geometry = geometryOf(shape, meshes);
    const flat = geometry.index ? geometry.toNonIndexed() : geometry;
    flat.deleteAttribute('uv');
    flat.applyMatrix4(matrixOf(shape.pose));
    const [r, g, b] = colour ?? (shape.color?.length ? shape.color : DEFAULT_COLOUR);
    const linear = new Color().setRGB(r, g, b, 'srgb');
    const count = flat.getAttribute('position').count;
    const colours = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) linear.toArray(colours, 3 * i);
    flat.setAttribute('color', new BufferAttribute(colours, 3));
    return flat;
  });
  return mergeGeometries(parts);
}
