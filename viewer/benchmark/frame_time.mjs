// Frame times of the page with 40 joints, 50 000 voxels and 500 configurations, as one JSON object:
//   node benchmark/frame_time.mjs [frames]
// `script` is the time in the page's own code and in issuing its draw calls; `frame` is from one
// frame to the next, which in headless Chromium includes drawing in software.
import { Browser } from '../tests/browser.mjs';
import { planScene } from '../tests/scenes.mjs';

const frames = Number(process.argv[2] ?? 200);
const percentile = (values, p) => {
  const sorted = [...values].sort((a, b) => a - b);
  const index = Math.min(Math.ceil(p * sorted.length), sorted.length) - 1;
  return Number(sorted[Math.max(index, 0)].toFixed(2));
};
const summary = (values) => ({
  p50: percentile(values, 0.5),
  p95: percentile(values, 0.95),
  p99: percentile(values, 0.99),
  max: percentile(values, 1),
});

const browser = await Browser.start();
const scene = planScene({ count: 500, step: 0.1, perLeg: 10, voxels: 50000 });
const begin = performance.now();
const { page, state } = await browser.open(scene);
const opened = performance.now() - begin;
const renderer = await page.evaluate(() => {
  const gl = document.createElement('canvas').getContext('webgl2');
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  return gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
});
const times = await page.evaluate((count) => window.locograph.measureFrames(count), frames);
const { drawCalls, triangles } = await state();
await browser.stop();
console.log(
  JSON.stringify(
    {
      joints: scene.robot.joints.length,
      voxels: 50000,
      configurations: 500,
      width: 1280,
      height: 720,
      renderer,
      software_rendering: /swiftshader|llvmpipe/i.test(renderer),
      frames,
      open_ms: Math.round(opened),
      draw_calls: drawCalls,
      triangles,
      script_ms: summary(times.script_ms),
      frame_ms: summary(times.frame_ms),
    },
    null,
    2,
  ),
);
