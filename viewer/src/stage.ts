/** The stage: renderer, camera, lights, ground with its grid; redraws only when told to. */
import {
  Color,
  DirectionalLight,
  DoubleSide,
  HemisphereLight,
  Mesh,
  PCFShadowMap,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  ShaderMaterial,
  ShadowMaterial,
  SRGBColorSpace,
  Vector3,
  Vector4,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Theme } from './theme';

const GRID_VERTEX = `
varying vec3 vWorld;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}`;

const GRID_FRAGMENT = `
varying vec3 vWorld;
uniform vec3 uGrid, uGround, uBackground, uCentre;
uniform float uCell, uRadius;
float lines(vec2 p, float cell) {
  vec2 q = p / cell;
  vec2 w = fwidth(q);
  vec2 d = abs(fract(q - 0.5) - 0.5) / max(w, vec2(1e-6));
  float fade = 1.0 - smoothstep(0.25, 0.9, max(w.x, w.y));
  return (1.0 - min(min(d.x, d.y), 1.0)) * fade;
}
void main() {
  float line = max(0.16 * lines(vWorld.xy, uCell), 0.42 * lines(vWorld.xy, 5.0 * uCell));
  vec3 ground = mix(uGround, uGrid, line);
  float far = smoothstep(0.35, 1.0, distance(vWorld.xy, uCentre.xy) / uRadius);
  gl_FragColor = vec4(mix(ground, uBackground, far), 1.0);
  #include <colorspace_fragment>
}`;

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(42, 1, 0.05, 400);
  readonly renderer: WebGLRenderer;
  readonly controls: OrbitControls;
  readonly ground: Mesh<PlaneGeometry, ShaderMaterial>;

  private readonly shadows: Mesh<PlaneGeometry, ShadowMaterial>;
  private readonly sun = new DirectionalLight(0xffffff, 2.5);
  private readonly sky = new HemisphereLight(0xffffff, 0xb9b4aa, 1.7);
  private readonly fill = new DirectionalLight(0xcfe0ff, 0.55);
  private readonly viewport = new Vector4();
  private dirty = true;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: true,
      powerPreference: 'high-performance',
    });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.maxPolarAngle = 0.97 * Math.PI;
    this.controls.addEventListener('change', () => this.invalidate());

    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 3;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.02;
    this.fill.position.set(-4, -6, 3);
    this.scene.add(this.sun, this.sun.target, this.sky, this.fill);

    this.ground = new Mesh(
      new PlaneGeometry(1, 1),
      new ShaderMaterial({
        vertexShader: GRID_VERTEX,
        fragmentShader: GRID_FRAGMENT,
        side: DoubleSide,
        polygonOffset: true,
        polygonOffsetFactor: 2,
        polygonOffsetUnits: 2,
        uniforms: {
          uGrid: { value: new Color() },
          uGround: { value: new Color() },
          uBackground: { value: new Color() },
          uCentre: { value: new Vector3() },
          uCell: { value: 0.2 },
          uRadius: { value: 25 },
        },
      }),
    );
    this.ground.renderOrder = -2;
    this.shadows = new Mesh(new PlaneGeometry(1, 1), new ShadowMaterial({ opacity: 0.26 }));
    this.shadows.receiveShadow = true;
    this.shadows.position.z = 0.001;
    this.shadows.renderOrder = -1;
    this.scene.add(this.ground, this.shadows);
    this.setExtent(25, 0.2, 0);
    this.lightAt(new Vector3(), 2);
  }

  /** Size of the ground [m], its grid cell and height. */
  setExtent(radius: number, cell: number, height: number): void {
    this.ground.scale.set(4 * radius, 4 * radius, 1);
    this.shadows.scale.copy(this.ground.scale);
    this.ground.position.z = height;
    this.shadows.position.z = height + 0.001;
    this.ground.material.uniforms.uCell.value = cell;
    this.ground.material.uniforms.uRadius.value = 2 * radius;
    this.camera.far = 20 * radius;
    this.camera.near = Math.max(0.02, radius / 1500);
    this.camera.updateProjectionMatrix();
  }

  /** Shadows are sharp around a point, within a radius [m]. */
  lightAt(point: Vector3, radius: number): void {
    const box = this.sun.shadow.camera;
    if (box.right !== radius) {
      box.left = box.bottom = -radius;
      box.right = box.top = radius;
      box.near = 0.1;
      box.far = 10 * radius;
      box.updateProjectionMatrix();
    }
    // In whole texels, so that edges of shadows do not swim while the light follows the robot.
    const texel = (2 * radius) / this.sun.shadow.mapSize.x;
    const x = Math.round(point.x / texel) * texel;
    const y = Math.round(point.y / texel) * texel;
    this.sun.target.position.set(x, y, 0);
    this.sun.position.set(x + 1.4 * radius, y - 1.9 * radius, 3.6 * radius);
    this.ground.material.uniforms.uCentre.value.copy(this.controls.target);
    this.ground.position.x = this.shadows.position.x = x;
    this.ground.position.y = this.shadows.position.y = y;
  }

  applyTheme(theme: Theme, dark: boolean): void {
    this.scene.background = new Color(theme.background);
    const uniforms = this.ground.material.uniforms;
    uniforms.uGrid.value.set(theme.grid);
    uniforms.uGround.value.set(theme.ground);
    uniforms.uBackground.value.set(theme.background);
    this.shadows.material.color.set(theme.shadow);
    this.shadows.material.opacity = dark ? 0.5 : 0.24;
    this.sky.color.set(theme.sky);
    this.sky.intensity = dark ? 1.25 : 1.75;
    this.sky.groundColor.set(dark ? 0x3a4048 : 0xb9b4aa);
    this.sun.intensity = dark ? 2.3 : 2.5;
    this.invalidate();
  }

  resize(width: number, height: number): void {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  invalidate(): void {
    this.dirty = true;
  }

  /** Something has changed since it was drawn. */
  get waiting(): boolean {
    return this.dirty;
  }

  /** A picture from another camera. It is drawn on the canvas, which has to be drawn again after. */
  picture(camera: PerspectiveCamera, into: CanvasRenderingContext2D): void {
    const { canvas, renderer } = this;
    const { width, height } = into.canvas;
    const shrunk = Math.min(1, canvas.width / width, canvas.height / height);
    const across = Math.floor(shrunk * width);
    const up = Math.floor(shrunk * height);
    const ratio = renderer.getPixelRatio();
    renderer.getViewport(this.viewport);
    renderer.setViewport(0, 0, across / ratio, up / ratio);
    renderer.setScissor(0, 0, across / ratio, up / ratio);
    renderer.setScissorTest(true);
    renderer.render(this.scene, camera);
    renderer.setScissorTest(false);
    renderer.setViewport(this.viewport);
    into.drawImage(canvas, 0, canvas.height - up, across, up, 0, 0, width, height);
    this.invalidate();
  }

  /** Draws if something has changed; says whether it did. */
  draw(): boolean {
    if (!this.dirty) return false;
    this.dirty = false;
    this.renderer.render(this.scene, this.camera);
    return true;
  }
}
