// Stages of a page that `locograph view` wrote, side by side in one picture (.png).
//   node tools/stages.mjs PAGE.html OUT.png --times 2,9,16,26 [--row view=front]… [--size 400x360]
// A row for each --row, which is as in the page's address; --size: of one stage, cut out of the middle
// of a page of 960 × 540.
import { existsSync, statSync } from 'node:fs';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { Browser } from '../tests/browser.mjs';

const PAGE = { width: 960, height: 540 };
const GAP = 6; // pixels, white

function fail(what) {
  console.error(`stages: ${what}`);
  process.exit(2);
}

function optionsOf() {
  try {
    const { values, positionals } = parseArgs({
      allowPositionals: true,
      options: {
        times: { type: 'string', default: '' },
        row: { type: 'string', multiple: true, default: ['view=follow'] },
        size: { type: 'string', default: '400x360' },
      },
    });
    const times = values.times.split(',').map(Number);
    const [width, height] = values.size.split('x').map(Number);
    const [page, out] = positionals;
    if (positionals.length !== 2 || !out.endsWith('.png')) fail('expected PAGE.html and OUT.png');
    if (values.times === '' || !times.every(Number.isFinite)) fail('expected --times 1,2,3');
    if (!(width >= 16 && width <= PAGE.width && height >= 16 && height <= PAGE.height)) {
      fail(`--size ${values.size}, expected 16x16 to ${PAGE.width}x${PAGE.height}`);
    }
    if (!existsSync(page)) fail(`${page} is not there`);
    return { page, out, times, rows: values.row, width, height };
  } catch (error) {
    return fail(error.message);
  }
}

async function takeStages({ page: file, out, times, rows, width, height }) {
  const url = pathToFileURL(resolve(file)).href;
  const clip = { x: (PAGE.width - width) / 2, y: (PAGE.height - height) / 2, width, height };
  const browser = await Browser.start();
  try {
    const images = [];
    for (const row of rows) {
      for (const time of times) {
        const hash = `#ui=0&t=${time}&${row}`;
        const { page, errors, close } = await browser.open(null, { url, hash, ...PAGE });
        if (errors.length > 0) fail(`${file}: ${errors[0]}`);
        images.push((await page.screenshot({ clip })).toString('base64'));
        await close();
      }
    }
    const sheet = await browser.chromium.newPage();
    await sheet.setContent(
      `<body style="margin:0"><main style="display:inline-grid;gap:${GAP}px;background:white;` +
        `grid-template-columns:repeat(${times.length},auto)">` +
        images.map((data) => `<img src="data:image/png;base64,${data}">`).join('') +
        '</main>',
    );
    await sheet.locator('main').screenshot({ path: out });
  } finally {
    await browser.stop();
  }
}

const options = optionsOf();
await takeStages(options);
console.log(`written: ${options.out}, ${Math.round(statSync(options.out).size / 1000)} kB`);
