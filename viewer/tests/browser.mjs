// Debian's Chromium for the tests and the benchmark, and pages opened from disk in it.
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';
import { page as pageText } from './scenes.mjs';

const FLAGS = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--use-gl=angle',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
];

export const CHROMIUM =
  ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((path) =>
    existsSync(path),
  ) ?? null;

export class Browser {
  static async start() {
    const browser = new Browser();
    browser.folder = mkdtempSync(join(tmpdir(), 'locograph-viewer-'));
    browser.chromium = await chromium.launch({
      executablePath: CHROMIUM,
      args: FLAGS,
      timeout: 300000,
    });
    browser.count = 0;
    return browser;
  }

  async stop() {
    await this.chromium.close();
    rmSync(this.folder, { recursive: true, force: true });
  }

  /**
   * Opens a page with a scene from disk and waits until it has drawn, or says that it cannot. The
   * result has what went wrong in it: `errors`, and `requests` that left the file.
   */
  async open(scene, { hash = '', width = 1280, height = 720, colorScheme = 'light', url } = {}) {
    const context = await this.chromium.newContext({ viewport: { width, height }, colorScheme });
    const page = await context.newPage();
    page.setDefaultTimeout(300000);
    const errors = [];
    const requests = [];
    page.on('pageerror', (error) => errors.push(error.message));
    page.on('console', (message) => {
      if (message.type() === 'error') errors.push(message.text());
    });
    let address = url;
    if (!address) {
      const file = join(this.folder, `${++this.count}.html`);
      writeFileSync(file, pageText(scene));
      address = pathToFileURL(file).href;
    }
    page.on('request', (request) => {
      if (request.url().split('#')[0] !== address) requests.push(request.url());
    });
    await page.goto(address + hash);
    await page.waitForFunction(
      () => window.locographReady === true || document.querySelector('[role=alert]'),
    );
    const state = () => page.evaluate(() => window.locograph.state());
    return { page, errors, requests, state, close: () => context.close() };
  }

  /** Pixels of a page: {width, height, data} with four bytes each. */
  async pixels(page, clip) {
    await page.evaluate(
      () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
    );
    const png = (await page.screenshot({ clip })).toString('base64');
    const context = await this.chromium.newContext();
    const blank = await context.newPage();
    const [width, height, text] = await blank.evaluate(async (data) => {
      const bytes = Uint8Array.from(atob(data), (c) => c.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
      const drawing = canvas.getContext('2d');
      drawing.drawImage(bitmap, 0, 0);
      const numbers = drawing.getImageData(0, 0, bitmap.width, bitmap.height).data;
      let out = '';
      for (let i = 0; i < numbers.length; i += 8192) {
        out += String.fromCharCode(...numbers.subarray(i, i + 8192));
      }
      return [bitmap.width, bitmap.height, btoa(out)];
    }, png);
    await context.close();
    return { width, height, data: Buffer.from(text, 'base64') };
  }
}

/** Share of the pixels in a part of a picture (fractions of its size) for which `is(r, g, b)`. */
export function share(picture, [x0, y0, x1, y1], is) {
  let hits = 0;
  let all = 0;
  for (let y = Math.floor(y0 * picture.height); y < y1 * picture.height; ++y) {
    for (let x = Math.floor(x0 * picture.width); x < x1 * picture.width; ++x) {
      const i = 4 * (y * picture.width + x);
      ++all;
      if (is(picture.data[i], picture.data[i + 1], picture.data[i + 2])) ++hits;
    }
  }
  return hits / all;
}

/** Share of the pixels that differ clearly between two pictures of the same size. */
export function difference(a, b) {
  let different = 0;
  for (let i = 0; i < a.data.length; i += 4) {
    const change =
      Math.abs(a.data[i] - b.data[i]) +
      Math.abs(a.data[i + 1] - b.data[i + 1]) +
      Math.abs(a.data[i + 2] - b.data[i + 2]);
    if (change > 24) ++different;
  }
  return different / (a.data.length / 4);
}
