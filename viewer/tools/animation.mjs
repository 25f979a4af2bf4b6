// A looping animation (.gif or .webm) of a page that `locograph view` wrote. Needs ffmpeg.
//   node tools/animation.mjs PAGE.html OUT.gif [--seconds 8] [--width 480] [--hash view=side]
// --seconds: what the whole plan takes in the animation; --hash: as in the page's address.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { Browser } from '../tests/browser.mjs';

const FRAMES_PER_SECOND = 12.5; // a GIF counts in hundredths of a second
const PAUSE_S = 1; // at the end, before it begins again
const SHAPE = 16 / 9;

function fail(what) {
  console.error(`animation: ${what}`);
  process.exit(2);
}

function optionsOf() {
  try {
    const { values, positionals } = parseArgs({
      allowPositionals: true,
      options: {
        seconds: { type: 'string', default: '8' },
        width: { type: 'string', default: '480' },
        hash: { type: 'string', default: 'view=overview' },
      },
    });
    const [seconds, width] = [Number(values.seconds), Number(values.width)];
    const [page, out] = positionals;
    if (positionals.length !== 2 || !/\.(gif|webm)$/.test(out)) {
      fail('expected PAGE.html and OUT.gif or OUT.webm');
    }
    if (!(seconds > 0 && seconds <= 60)) fail(`--seconds ${values.seconds}, expected up to 60`);
    if (!(width >= 16 && width <= 1920)) fail(`--width ${values.width}, expected 16 to 1920`);
    if (!existsSync(page)) fail(`${page} is not there`);
    return { page, out, seconds, width, hash: values.hash };
  } catch (error) {
    return fail(error.message);
  }
}

/** Pictures 0000.png, 0001.png, … of the whole plan. */
async function takeFrames({ page: file, seconds, width, hash }, folder) {
  const browser = await Browser.start();
  try {
    const url = pathToFileURL(resolve(file)).href;
    const size = { width: 2 * width, height: 2 * Math.round((0.5 * 2 * width) / SHAPE) };
    const { page, errors } = await browser.open(null, { url, hash: `#ui=0&${hash}`, ...size });
    if (errors.length > 0) fail(`${file}: ${errors[0]}`);
    const at = (time) =>
      page.evaluate((t) => {
        window.locograph.setTime(t);
        return window.locograph.state().time;
      }, time);
    const [start, end] = [await at(-1e9), await at(1e9)];
    const count = Math.max(2, Math.round(seconds * FRAMES_PER_SECOND));
    for (let i = 0; i < count; ++i) {
      await at(start + ((end - start) * i) / (count - 1));
      await page.screenshot({ path: join(folder, `${String(i).padStart(4, '0')}.png`) });
    }
  } finally {
    await browser.stop();
  }
}

function encode({ out, width }, folder) {
  const filters = [`scale=${width}:-2:flags=lanczos`, `tpad=stop_mode=clone:stop_duration=${PAUSE_S}`];
  const gif = out.endsWith('.gif');
  const coding = gif
    ? [
        '-filter_complex',
        `${filters.join(',')},split[a][b];[a]palettegen=max_colors=96[p];` +
          '[b][p]paletteuse=dither=none:diff_mode=rectangle',
        '-loop',
        '0',
      ]
    : ['-vf', filters.join(','), '-c:v', 'libvpx-vp9', '-crf', '40', '-b:v', '0'];
  const { error, status, stderr } = spawnSync(
    'ffmpeg',
    ['-y', '-loglevel', 'error', '-framerate', String(FRAMES_PER_SECOND)].concat(
      ['-i', join(folder, '%04d.png')],
      coding,
      [out],
    ),
    { encoding: 'utf8' },
  );
  if (error) fail('no ffmpeg on the PATH (the Debian package ffmpeg)');
  if (status !== 0) fail(`ffmpeg: ${stderr.trim()}`);
}

const options = optionsOf();
const folder = mkdtempSync(join(tmpdir(), 'locograph-animation-'));
try {
  await takeFrames(options, folder);
  encode(options, folder);
  console.log(`written: ${options.out}, ${Math.round(statSync(options.out).size / 1000)} kB`);
} finally {
  rmSync(folder, { recursive: true, force: true });
}
