// What a person sees and does in the page, in headless Chromium. No network.
import assert from 'node:assert/strict';
import { statSync } from 'node:fs';
import { after, before, describe, it } from 'node:test';
import { Browser, CHROMIUM, difference, share } from './browser.mjs';
import { serveLive } from './live_server.mjs';
import {
  BASE_HEIGHT,
  farScene,
  mimicScene,
  pack,
  page as pageText,
  perceptionScene,
  planScene,
  rollingScene,
  SPEED,
  sphereGraph,
  squareGraph,
  stancesScene,
  stancesTree,
} from './scenes.mjs';

if (!CHROMIUM) {
  console.log('skipped: Chromium is missing (Debian package chromium)');
  process.exit(0);
}

const blue = (r, g, b) => b > 90 && b > r + 45 && b > g + 20;
const deepBlue = (r, g, b) => b > 150 && r < 70 && g < 110;
const orange = (r, g, b) => r > 120 && r > g + 40 && g > b + 20;
const red = (r, g, b) => r > 170 && g < 110 && b < 110;

describe('viewer', () => {
  let browser;
  before(async () => (browser = await Browser.start()));
  after(async () => browser.stop());

  /** Opens a scene, runs the body, and requires that the page had no error and asked for nothing. */
  async function shown(scene, options, body) {
    const opened = await browser.open(scene, options);
    try {
      await body(opened);
      assert.deepEqual(opened.errors, []);
      if (!options.url) assert.deepEqual(opened.requests, []);
    } finally {
      await opened.close();
    }
  }

  it('is one file of at most 1 MB without a scene', () => {
    const file = new URL('../dist/template.html', import.meta.url);
    assert.ok(statSync(file).size < 1e6);
  });

  it('opens from disk with no request and no error, and shows title and robot', () =>
    shown(planScene(), {}, async ({ page, state }) => {
      assert.equal(await page.textContent('h1'), 'test <plan>.g2o');
      assert.equal((await state()).configurations, 41);
      assert.equal((await state()).violations, 1);
      assert.match(
        await page.textContent('.legend'),
        /in the window.*contact force \(1 m = .* N\)/s,
      );
    }));

  it('draws the robot in the middle of the picture and nothing of it in the corners', () =>
    shown(
      planScene(),
      { hash: '#t=5&view=side&ui=0&hide=contacts,forces,com,base,dots,map,reference' },
      async ({ page, state }) => {
        const picture = await browser.pixels(page);
        assert.equal((await state()).view, 'side');
        assert.ok(share(picture, [0.35, 0.3, 0.65, 0.7], blue) > 0.12);
        for (const corner of [
          [0, 0, 0.15, 0.3],
          [0.85, 0, 1, 0.3],
          [0, 0.8, 0.15, 1],
        ]) {
          assert.ok(share(picture, corner, blue) < 0.01);
        }
      },
    ));

  it('shows where the plan had a robot that was recorded, as a ghost', () => {
    const scene = planScene();
    // Half a metre above where it was.
    const bytes = Buffer.from(scene.plan.reference, 'base64');
    const planned = new Float32Array(new Uint8Array(bytes).buffer);
    for (let i = 2; i < planned.length; i += scene.plan.configuration_size) planned[i] += 0.5;
    Object.assign(scene.plan, { reference: pack(planned), recorded: true });
    const hash = '#t=5&view=side&ui=0&hide=contacts,forces,com,base,dots,map,reference';
    const teal = (r, g) => g > r + 30;
    return shown(scene, { hash }, async ({ page, state }) => {
      assert.ok((await state()).layers.planned);
      const seen = () => browser.pixels(page).then((p) => share(p, [0.2, 0, 0.8, 0.8], teal));
      const there = await seen();
      await page.keyboard.press('h');
      assert.ok((await state()).layers.planned === false);
      assert.ok(there > (await seen()) + 0.02, `${there}`);
    });
  });

  it('keeps what is near the robot in the picture, and narrows when it has passed', () =>
    shown(
      farScene(),
      { hash: '#t=0&ui=0&hide=contacts,forces,com,base,dots,reference' },
      async ({ page }) => {
        const alone = share(await browser.pixels(page), [0, 0, 1, 1], blue);
        await page.evaluate(() => window.locograph.setTime(20));
        const picture = await browser.pixels(page);
        // The whole box: some of it inside, nothing of it on the rim.
        assert.ok(share(picture, [0, 0, 1, 1], orange) > 0.002);
        for (const rim of [
          [0, 0, 0.01, 1],
          [0.99, 0, 1, 1],
          [0, 0, 1, 0.01],
          [0, 0.99, 1, 1],
        ]) {
          assert.equal(share(picture, rim, orange), 0);
        }
        assert.ok(share(picture, [0, 0, 1, 1], blue) < 0.9 * alone);
        await page.evaluate(() => window.locograph.setTime(40));
        const after = share(await browser.pixels(page), [0, 0, 1, 1], blue);
        assert.ok(Math.abs(after - alone) < 0.1 * alone);
      },
    ));

  it('shows a white robot and a black one before a background that is neither', () =>
    shown(planScene(), { hash: '#t=5&view=side&ui=0&theme=light' }, async ({ page }) => {
      const picture = await browser.pixels(page);
      const grey = (r, g, b) => Math.min(r, g, b) > 110 && Math.max(r, g, b) < 225;
      assert.ok(share(picture, [0, 0, 0.2, 1], grey) > 0.95);
    }));

  it('puts the base where the plan has it, also between configurations', () =>
    shown(planScene(), {}, async ({ page }) => {
      for (const time of [0, 1.3, 7.77, 20]) {
        const { base, centreOfMass } = await page.evaluate((t) => {
          window.locograph.setTime(t);
          return window.locograph.state();
        }, time);
        assert.ok(Math.abs(base[0] - SPEED * time) < 1e-5);
        assert.ok(Math.abs(base[2] - BASE_HEIGHT) < 1e-5);
        // Legs hang symmetrically: the centre of mass is below the middle of the base.
        assert.ok(Math.abs(centreOfMass[0] - SPEED * time) < 1e-5);
        assert.ok(Math.abs(centreOfMass[1]) < 1e-6);
        assert.ok(centreOfMass[2] < BASE_HEIGHT - 0.05);
      }
    }));

  it('puts the base on the curve of the plan, and says how fast the joints are there', () => {
    const { scene, distance } = rollingScene();
    return shown(scene, {}, async ({ page }) => {
      for (const time of [0.5, 2, 3.1]) {
        const { base } = await page.evaluate((t) => {
          window.locograph.setTime(t);
          return window.locograph.state();
        }, time);
        assert.ok(Math.abs(base[0] - distance(time)) < 1e-5);
      }
      // At 3 s, of a wheel with a radius of 0.1 m: 0.3 m/s.
      await page.evaluate(() => window.locograph.setTime(3));
      const title = await page.getAttribute('.joint:has-text("axle_1")', 'title');
      assert.match(title, /axle_1: 4\.5\d* rad, 3(\.0*)? rad\/s/);
    });
  });

  it('moves mimic joints with the joint that leads them', () =>
    shown(mimicScene([0, 0.4, 0.8]), {}, async ({ page }) => {
      const at = (t) =>
        page.evaluate((time) => {
          window.locograph.setTime(time);
          return window.locograph.state().centreOfMass;
        }, t);
      for (const [time, q] of [
        [0, 0],
        [1, 0.4],
        [1.5, 0.6],
      ]) {
        const [x, y] = await at(time);
        // The second arm turns by 0.2 - 2 q; the third one follows a joint that stands at 0.3.
        const arms = [q, 0.2 - 2 * q, 0.6];
        assert.ok(Math.abs(x - arms.reduce((sum, a) => sum + Math.cos(a), 0) / 3) < 1e-5);
        assert.ok(Math.abs(y - arms.reduce((sum, a) => sum + Math.sin(a), 0) / 3) < 1e-5);
      }
    }));

  it('moves the robot with the scrubber', () =>
    shown(planScene(), { hash: '#view=overview' }, async ({ page, state }) => {
      const clip = await page.locator('#view').boundingBox();
      const first = await browser.pixels(page, clip);
      const track = await page.locator('#scrubber').boundingBox();
      await page.mouse.click(track.x + 0.75 * track.width, track.y + 8);
      assert.ok(Math.abs((await state()).time - 15) < 0.5);
      assert.ok(difference(first, await browser.pixels(page, clip)) > 0.01);
    }));

  it('plays by itself until it is paused', () =>
    shown(planScene(), {}, async ({ page, state }) => {
      await page.click('#play');
      await page.waitForFunction(() => window.locograph.state().time > 0.2);
      await page.click('#play');
      const { time, playing } = await state();
      assert.equal(playing, false);
      await page.waitForTimeout(200);
      assert.equal((await state()).time, time);
    }));

  it('lists violations first, and a click goes to moment and place', () =>
    shown(planScene(), { hash: '#hide=dots,contacts,forces' }, async ({ page, state }) => {
      const rows = page.locator('#violations button');
      assert.match(await rows.first().textContent(), /^obstacle_distance-0.03 m.*base and pillar/);
      assert.match(await page.textContent('.verdict'), /Infeasible: 1 of 2.*, 1 not judged/);
      const unjudged = page.locator('#violations .unjudged');
      assert.match(await unjudged.textContent(), /^torque_limitsnot judged.*no stance is known/);
      assert.equal(await unjudged.isDisabled(), true);
      assert.match(await page.textContent('.trusted'), /On trust: wheel_1: what it can bear/);
      assert.equal(await page.locator('.mark-label:visible').count(), 0);
      await rows.first().click();
      const { time, index, selectedViolation } = await state();
      assert.equal(time, 15);
      assert.equal(index, 30);
      assert.equal(selectedViolation, 'obstacle_distance');
      const label = page.locator('.mark-label:visible');
      await label.waitFor();
      assert.equal(await label.textContent(), 'obstacle_distance-0.03 m');
      const at = await label.boundingBox();
      const below = { x: at.x + at.width / 2 - 20, y: at.y + at.height + 2, width: 40, height: 34 };
      assert.ok(share(await browser.pixels(page, below), [0, 0, 1, 1], red) > 0.05);
    }));

  it('shows the sphere of a pose graph, with its figures', () =>
    shown(sphereGraph(), {}, async ({ page }) => {
      const clip = await page.locator('#view').boundingBox();
      const picture = await browser.pixels(page, clip);
      assert.ok(share(picture, [0.3, 0.2, 0.7, 0.8], blue) > 0.03);
      assert.ok(share(picture, [0, 0, 0.12, 0.3], blue) < 0.001);
      const text = await page.textContent('#panel');
      assert.match(text, /poses1.250/);
      assert.match(text, /loop closures1.200/);
      assert.match(text, /χ² before2.500.000χ² after727/);
      await page.keyboard.press('a');
      await page.keyboard.press('c');
      const without = await browser.pixels(page, clip);
      assert.ok(share(without, [0.3, 0.2, 0.7, 0.8], blue) < 0.005);
    }));

  it('looks at a planar pose graph from above', () =>
    shown(squareGraph(), {}, async ({ page, state }) => {
      assert.equal((await state()).view, 'top');
      const picture = await browser.pixels(page, await page.locator('#view').boundingBox());
      assert.ok(share(picture, [0, 0, 1, 1], blue) > 0.001);
      assert.match(await page.textContent('#panel'), /landmarks1/);
    }));

  it('fits a phone: panel closed, nothing wider than the screen, panel opens', () =>
    shown(planScene(), { width: 390, height: 844 }, async ({ page }) => {
      assert.equal(await page.locator('#panel').isVisible(), false);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
      const view = await page.locator('#view').boundingBox();
      assert.equal(view.width, 390);
      assert.ok(view.height > 400);
      const picture = await browser.pixels(page, view);
      assert.ok(share(picture, [0.1, 0.2, 0.9, 0.8], blue) > 0.01);
      await page.click('#toggle-panel');
      await page.locator('#violations button').first().click();
      assert.equal(await page.locator('#panel').isVisible(), false);
    }));

  it('obeys the keyboard', () =>
    shown(planScene(), {}, async ({ page, state }) => {
      const press = async (key) => {
        await page.keyboard.press(key);
        return state();
      };
      assert.equal((await press('ArrowRight')).index, 1);
      assert.equal((await press('ArrowRight')).time, 1);
      assert.equal((await press('ArrowLeft')).index, 1);
      assert.equal((await press('End')).time, 20);
      assert.equal((await press('Home')).time, 0);
      assert.equal((await press('+')).speed, 2);
      assert.equal((await press('-')).speed, 1);
      assert.equal((await press('Space')).playing, true);
      assert.equal((await press('Space')).playing, false);
      for (const [key, view] of [
        ['1', 'front'],
        ['2', 'side'],
        ['3', 'top'],
        ['4', 'follow'],
      ]) {
        assert.equal((await press(key)).view, view);
      }
      assert.equal((await press('g')).layers.ghosts, true);
      assert.equal((await press('v')).layers.collision, true);
      assert.equal((await press('m')).layers.map, false);
      assert.equal((await press('l')).loop, false);
      assert.equal((await press('t')).theme, 'dark');
      await press('?');
      assert.ok(await page.locator('dialog').isVisible());
      await page.keyboard.press('Escape');
      assert.equal(await page.locator('dialog').isVisible(), false);
    }));

  it('shows ghosts and collision shapes', () =>
    shown(planScene(), { hash: '#view=overview&ui=0' }, async ({ page }) => {
      const first = await browser.pixels(page);
      await page.keyboard.press('g');
      const ghosts = await browser.pixels(page);
      assert.ok(difference(first, ghosts) > 0.01);
      await page.keyboard.press('v');
      assert.ok(difference(ghosts, await browser.pixels(page)) > 0.003);
    }));

  it('steps through a plan of stances, and says what each takes and leaves', () =>
    shown(stancesScene(), {}, async ({ page, state }) => {
      assert.equal((await state()).view, 'overview');
      assert.match(await page.textContent('.topbar'), /5 stances/);
      for (const [time, index, text] of [
        [0, 0, '4 contacts'],
        [1.9, 1, '−wheel_1 · 3 contacts'],
        [2.2, 2, '+wheel_1 · 4 contacts'],
        [5, 4, '+wheel_2 · 4 contacts'],
      ]) {
        const { base, ...now } = await page.evaluate((t) => {
          window.locograph.setTime(t);
          return window.locograph.state();
        }, time);
        assert.equal(now.index, index);
        assert.ok(Math.abs(base[0] - 0.125 * index) < 1e-6, 'nothing lies between stances');
        await page.waitForFunction(
          (wanted) => document.querySelector('.where').textContent === wanted,
          text,
        );
      }
      await page.keyboard.press('Home');
      await page.keyboard.press('ArrowRight');
      assert.equal((await state()).time, 1);
      await page.keyboard.press('g');
      assert.equal((await state()).layers.ghosts, true);
      const track = await page.locator('#scrubber').boundingBox();
      await page.mouse.click(track.x + 0.7 * track.width, track.y + 8);
      assert.equal((await state()).index, 3);
    }));

  it('marks where a motion changes its stance, and says what that takes and leaves', async () => {
    const { plan, ...scene } = stancesScene();
    const { stances_only: _, ...motion } = plan;
    /** Opacity of the strip between two rows, where configuration 2 of 0…4 is, and beside it. */
    const strip = (page) =>
      page.evaluate(() => {
        const canvas = document.querySelector('.track canvas');
        const ratio = canvas.height / canvas.clientHeight;
        const row = canvas.getContext('2d').getImageData(0, Math.round(29.5 * ratio), canvas.width, 1);
        const around = (x) =>
          Math.max(...[-1, 0, 1].map((i) => row.data[4 * (Math.round(x * canvas.width) + i) + 3]));
        return [around(0.5), around(0.6)];
      });
    await shown({ ...scene, plan: motion }, {}, async ({ page, state }) => {
      assert.equal((await state()).configurations, 5);
      const [at, beside] = await strip(page);
      assert.ok(at > 100, 'a line');
      assert.equal(beside, 0);
      for (const [index, text] of [
        [1, /^−wheel_1 · configuration 1 .*of 5 · 3 contacts$/],
        [2, /^\+wheel_1 · configuration 2 .*of 5 · 4 contacts$/],
      ]) {
        await page.evaluate((time) => window.locograph.setTime(time), motion.times[index]);
        await page.waitForFunction(
          (wanted) => new RegExp(wanted).test(document.querySelector('.where').textContent),
          text.source,
        );
      }
    });
    await shown({ ...scene, plan: motion, stances: undefined }, {}, async ({ page }) => {
      assert.deepEqual(await strip(page), [0, 0]);
    });
  });

  /** Waits until all pictures in sight are drawn. */
  const pictured = (page, least = 1) =>
    page.waitForFunction((wanted) => {
      const strip = document.querySelector('.pictures').getBoundingClientRect();
      const missing = [...document.querySelectorAll('.picture')].filter((picture) => {
        const { left, right } = picture.getBoundingClientRect();
        if (right <= strip.left || left >= strip.right) return false;
        const canvas = picture.querySelector('canvas');
        return canvas.getContext('2d').getImageData(4, 4, 1, 1).data[3] === 0;
      });
      return missing.length === 0 && window.locograph.state().pictures >= wanted;
    }, least);

  /** Pixels of one picture of the strip. */
  const pictureOf = async (page, index) => {
    const { width, height, data } = await page.evaluate((i) => {
      const canvas = document.querySelectorAll('.picture canvas')[i];
      const { width, height } = canvas;
      return {
        width,
        height,
        data: [...canvas.getContext('2d').getImageData(0, 0, width, height).data],
      };
    }, index);
    return { width, height, data: Buffer.from(data) };
  };

  it('pictures each stance: the robot upright and whole, whatever the page shows', () =>
    shown(
      stancesScene(),
      { hash: '#view=top&show=ghosts,collision&hide=surfaces,contacts,ground' },
      async ({ page }) => {
        await pictured(page, 5);
        const captions = await page.locator('.picture').allTextContents();
        assert.deepEqual(captions.map((text) => text.trim()), [
          '0',
          '1 −wheel_1',
          '2 +wheel_1',
          '3 −wheel_2',
          '4 +wheel_2',
        ]);
        const [first, second] = [await pictureOf(page, 0), await pictureOf(page, 1)];
        for (const picture of [first, second]) {
          // The body is above, legs below it; nothing is cut off, and no collision shape is seen.
          const above = share(picture, [0.2, 0.2, 0.8, 0.55], deepBlue);
          const below = share(picture, [0.2, 0.65, 0.8, 1], deepBlue);
          assert.ok(above > 0.15 && above > 2 * below, `${above} above, ${below} below`);
          for (const rim of [
            [0, 0, 0.01, 1],
            [0.99, 0, 1, 1],
            [0, 0, 1, 0.01],
          ]) {
            assert.equal(share(picture, rim, deepBlue), 0);
          }
          assert.ok(share(picture, [0, 0, 1, 1], orange) < 0.01);
        }
        // Contacts are dots with a white rim: one less in the second stance.
        assert.ok(difference(first, second) > 0.001);
        // The view itself shows what it showed.
        const clip = await page.locator('#view').boundingBox();
        const view = await browser.pixels(page, clip);
        await page.evaluate(() => window.locograph.setTime(0));
        assert.equal(difference(view, await browser.pixels(page, clip)), 0);
      },
    ));

  it('goes to the stance whose picture is clicked, and marks the present one', () =>
    shown(stancesScene(), {}, async ({ page, state }) => {
      await pictured(page, 5);
      const present = async () => {
        const marked = page.locator('.picture[aria-current=step]');
        assert.equal(await marked.count(), 1);
        return Number((await marked.textContent()).trim().split(' ')[0]);
      };
      assert.equal(await present(), 0);
      await page.locator('.picture').nth(3).click();
      assert.equal((await state()).index, 3);
      assert.equal((await state()).time, 3);
      await page.waitForFunction(() => document.querySelectorAll('.picture')[3].ariaCurrent);
      assert.equal(await present(), 3);
      await page.keyboard.press('ArrowRight');
      await page.waitForFunction(() => document.querySelectorAll('.picture')[4].ariaCurrent);
      // The keyboard's focus goes along, and is on one picture only.
      assert.match(await page.evaluate(() => document.activeElement.title), /^Stance 4/);
      assert.equal(await page.locator('.picture[tabindex="0"]').count(), 1);
    }));

  it('draws of 60 stances the pictures in sight, and rolls to the present one', () =>
    shown({ ...stancesScene(60), check: planScene().check }, {}, async ({ page, state }) => {
      await pictured(page, 5);
      await page.waitForTimeout(500);
      assert.ok((await state()).pictures < 20);
      assert.equal(await page.locator('.picture').count(), 60);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 1280);
      await page.evaluate(() => window.locograph.setTime(59));
      await page.waitForFunction(() => {
        const strip = document.querySelector('.pictures').getBoundingClientRect();
        const { left, right } = document.querySelectorAll('.picture')[59].getBoundingClientRect();
        return left >= strip.left && right <= strip.right;
      });
      await pictured(page, 20);
      assert.ok(share(await pictureOf(page, 59), [0, 0, 1, 1], blue) > 0.05);
      assert.ok((await state()).pictures < 40);
      await page.locator('.pictures').hover();
      await page.mouse.wheel(0, -400);
      await page.waitForFunction(() => {
        const { scrollLeft, scrollWidth, clientWidth } = document.querySelector('.pictures');
        return scrollLeft < scrollWidth - clientWidth - 300;
      });
      assert.equal((await state()).index, 59);
      assert.match(await page.locator('.picture.bad').textContent(), /^30/);
    }));

  it('draws pictures in the colours of the page, and none when they are switched off', async () => {
    const lightness = ({ data }) => data.reduce((sum, value) => sum + value, 0) / data.length;
    await shown(stancesScene(), { hash: '#theme=light' }, async ({ page, state }) => {
      await pictured(page, 5);
      const light = lightness(await pictureOf(page, 1));
      await page.keyboard.press('t');
      await page.waitForFunction(() => window.locograph.state().pictures === 5);
      assert.ok(lightness(await pictureOf(page, 1)) < 0.8 * light);
      const before = await page.locator('#view').boundingBox();
      await page.keyboard.press('i');
      assert.equal((await state()).layers.pictures, false);
      assert.equal(await page.locator('.pictures').isVisible(), false);
      assert.ok((await page.locator('#view').boundingBox()).height > before.height + 80);
    });
    await shown(stancesScene(), { hash: '#hide=pictures' }, async ({ page, state }) => {
      await page.waitForTimeout(500);
      assert.equal((await state()).pictures, 0);
    });
    await shown(planScene(), {}, async ({ page, state }) => {
      assert.equal((await state()).pictures, null);
      assert.equal(await page.locator('.pictures').count(), 0);
    });
  });

  it('shows the tree that was searched when it is asked for, the way to the goal in green', () =>
    shown({ ...stancesScene(), tree: stancesTree() }, { hash: '#view=top' }, async ({ page, state }) => {
      const green = (r, g, b) => g > r + 50 && g > b + 25;
      const fiery = (r, g, b) => r > 150 && r > b + 60 && g < r - 40;
      await page.keyboard.press('d'); // Without dots and forces, green is the way alone.
      await page.keyboard.press('f');
      await pictured(page, 5);
      const clip = await page.locator('#view').boundingBox();
      assert.equal((await state()).layers.tree, false);
      const before = await browser.pixels(page, clip);
      assert.equal(share(before, [0, 0, 1, 1], green), 0);
      assert.doesNotMatch(await page.textContent('.legend'), /tree/);
      const picture = await pictureOf(page, 2);
      await page.keyboard.press('e');
      const after = await browser.pixels(page, clip);
      assert.ok(share(after, [0, 0, 1, 1], green) > 0.0005);
      assert.ok(share(after, [0, 0, 1, 1], fiery) > share(before, [0, 0, 1, 1], fiery) + 0.001);
      assert.match(await page.textContent('.legend'), /first moves.*5 moves deep.*failed.*way to/s);
      assert.match(await page.textContent('#panel'), /Tree of stances \(14 moves tried\)/);
      // Pictures of stances are drawn without it.
      await page.keyboard.press('t');
      await page.keyboard.press('t');
      await page.waitForFunction(() => window.locograph.state().pictures === 5);
      assert.equal(difference(picture, await pictureOf(page, 2)), 0);
    }));

  it('shows surfaces from the side of their normal, bars, and what of a sole bears', () =>
    shown(stancesScene(), { hash: '#t=0&view=top&ui=0' }, async ({ page, state }) => {
      const { layers } = await state();
      assert.equal(layers.surfaces, true);
      const before = await browser.pixels(page);
      await page.keyboard.press('u');
      assert.ok(difference(before, await browser.pixels(page)) > 0.01);
      await page.keyboard.press('u');
      await page.keyboard.press('c');
      assert.ok(difference(before, await browser.pixels(page)) > 0.0005);
    }));

  it('follows the colour scheme of the system', () =>
    shown(squareGraph(), { colorScheme: 'dark' }, async ({ page, state }) => {
      assert.equal((await state()).theme, 'dark');
      const picture = await browser.pixels(page);
      assert.ok(share(picture, [0, 0, 1, 1], (r, g, b) => r + g + b < 180) > 0.8);
    }));

  it('takes time, camera and bare picture from the address', () =>
    shown(planScene(), { hash: '#t=12.3&view=front&ui=0&theme=dark' }, async ({ page, state }) => {
      const { time, view, theme } = await state();
      assert.deepEqual({ time, view, theme }, { time: 12.3, view: 'front', theme: 'dark' });
      for (const part of ['.topbar', '.timeline', '.panel', '.legend']) {
        assert.equal(await page.locator(part).isVisible(), false);
      }
      assert.deepEqual(await page.locator('#view').boundingBox(), {
        x: 0,
        y: 0,
        width: 1280,
        height: 720,
      });
    }));

  it('shows a robot without a plan, and a map without a robot', async () => {
    const { version, kind, title, robot, map } = planScene();
    await shown({ version, kind, title, robot }, { hash: '#ui=0' }, async ({ page }) => {
      assert.ok(share(await browser.pixels(page), [0.3, 0.2, 0.7, 0.8], blue) > 0.02);
    });
    await shown({ version, kind, title, map }, {}, async ({ page }) => {
      assert.equal(await page.locator('#scrubber').count(), 0);
    });
  });

  it('shows what the cameras saw last, and the map around the robot as it was then', () =>
    shown(perceptionScene(), {}, async ({ page, state }) => {
      const seenAt = (time) =>
        page.evaluate((t) => {
          window.locograph.setTime(t);
          return window.locograph.state().seen;
        }, time);
      const { slice, ...first } = await seenAt(0);
      assert.ok(Math.abs(slice - 0.35) < 1e-9);
      assert.deepEqual(first, {
        kept: 5,
        taken: 2,
        beyond: 1,
        occupied: 20,
        mapTime: 0,
        clouds: 2,
        maps: 2,
      });
      await page.waitForFunction(() =>
        /above5 points, 2 the robot's, 0.10 s ago/.test(document.body.textContent),
      );
      assert.match(await page.textContent('#panel'), /coverednothing yet/);
      assert.match(await page.textContent('.legend'), /taken by the self-filter.*distance: 0 m.*1 m/s);
      const later = await seenAt(12);
      assert.deepEqual([later.kept, later.taken, later.beyond], [8, 0, 0]);
      assert.deepEqual([later.occupied, later.mapTime], [0, 10]);
      for (const [key, layer, on] of [
        ['k', 'clouds', false],
        ['j', 'taken', false],
        ['q', 'beyond', true],
        ['w', 'seen', false],
        ['z', 'field', false],
      ]) {
        await page.keyboard.press(key);
        assert.equal((await state()).layers[layer], on);
      }
    }));

  it('cuts the distance field at the height that is chosen, red at what is occupied', () =>
    shown(
      perceptionScene(),
      { hash: '#t=0&view=top&slice=0.72&hide=contacts,com,forces,dots,base,reference,seen,clouds,taken,violations' },
      async ({ page, state }) => {
        assert.ok(Math.abs((await state()).seen.slice - 0.75) < 1e-9);
        const clip = await page.locator('#view').boundingBox();
        const warm = (r, g, b) => r > 150 && r > b + 80;
        const shares = async () => share(await browser.pixels(page, clip), [0, 0, 1, 1], warm);
        const there = await shares();
        assert.ok(there > 0.002, `${there}`);
        await page.evaluate(() => window.locograph.setTime(12));
        const later = await shares();
        assert.ok(later < 0.1 * there, `nothing is near any more: ${later} after ${there}`);
        await page.evaluate(() => window.locograph.setTime(0));
        await page.locator('#slice').fill('1.25');
        assert.ok(Math.abs((await state()).seen.slice - 1.25) < 1e-9);
        assert.match(await page.textContent('.switch.slice'), /1.25 m/);
      },
    ));

  it('adds what the cameras of a running refinement see', async () => {
    const { perception, ...plan } = perceptionScene();
    const [{ clouds, maps }, live] = [perception, '/live'];
    const server = await serveLive(pageText({ ...plan, perception, live }));
    try {
      await shown(null, { url: server.address }, async ({ page }) => {
        await server.connection;
        const seen = () => window.locograph.state().seen;
        server.send({ type: 'start', count: 41 });
        await page.waitForFunction(() => window.locograph.state().seen.clouds === 0);
        assert.deepEqual((await page.evaluate(seen)).kept, 0);
        const news = { clouds: clouds.slice(0, 1), maps: maps.slice(0, 1) };
        server.send({ type: 'cycle', configurations: {}, executed: 1, window: 1, perception: news });
        await page.waitForFunction(() => window.locograph.state().seen.occupied === 20);
        const { kept, taken, maps: count } = await page.evaluate(seen);
        assert.deepEqual([kept, taken, count], [5, 2, 1]);
      });
    } finally {
      await server.close();
    }
  });

  it('takes over what a running refinement sends', async () => {
    const scene = { ...planScene(), live: '/live' };
    const server = await serveLive(pageText(scene));
    try {
      await shown(scene, { url: server.address }, async ({ page, state }) => {
        assert.equal(await server.connection, '/live');
        const moved = [9, 3, BASE_HEIGHT, 0, 0, 0, 1, ...Array(12).fill(0)];
        server.send({ type: 'start', count: 41 });
        server.send({
          type: 'cycle',
          configurations: { 40: moved, 99: moved, 1: [1] },
          executed: 40,
          window: 0,
          feasible: true,
          cycle_time: 0.0051,
          violation: null,
        });
        await page.waitForFunction(() => window.locograph.state().executed === 40);
        // The page follows what has been executed.
        await page.waitForFunction(() => window.locograph.state().index === 40);
        await page.evaluate(() => window.locograph.setTime(20));
        assert.deepEqual((await state()).base.slice(0, 2), [9, 3]);
        assert.equal(await page.textContent('.live'), 'live · 5.1 ms');
        server.send({ type: 'end', success: false, reason: 'no way' });
        await page.waitForFunction(
          () => document.querySelector('.live').textContent === 'stopped: no way',
        );
      });
    } finally {
      await server.close();
    }
  });

  it('bends the curve to what a run replaces, and has it back when the run begins anew', async () => {
    const { scene, distance } = rollingScene();
    scene.live = '/live';
    const server = await serveLive(pageText(scene));
    const baseAt = (page, time) =>
      page.evaluate((t) => {
        window.locograph.setTime(t);
        return window.locograph.state().base[0];
      }, time);
    try {
      await shown(scene, { url: server.address }, async ({ page }) => {
        await server.connection;
        const last = [1, 0, BASE_HEIGHT, 0, 0, 0, 1, ...Array(12).fill(0)];
        server.send({ type: 'start', count: 3 });
        server.send({ type: 'cycle', configurations: { 2: last }, executed: 1, window: 1 });
        await page.waitForFunction(() => window.locograph.state().executed === 1);
        // From 0.2 m at 0.2 m/s to 1 m, where it comes to rest.
        assert.ok(Math.abs((await baseAt(page, 3)) - (0.6 + 0.25 * 0.2)) < 1e-5);
        server.send({ type: 'start', count: 3 });
        await page.waitForFunction(() => window.locograph.state().executed === 0);
        assert.ok(Math.abs((await baseAt(page, 3)) - distance(3)) < 1e-5);
      });
    } finally {
      await server.close();
    }
  });

  it('says what is wrong with a scene that cannot be shown', async () => {
    const with_ = (change) => {
      const scene = planScene({ voxels: 10 });
      change(scene);
      return scene;
    };
    const cases = [
      ['{}', /no scene/],
      ['{"version": 1,', /not valid JSON/],
      [{ version: 7, kind: 'plan', title: '' }, /version 7.*shows version 1/],
      [{ version: 1, kind: 'film', title: '' }, /kind "film"/],
      [{ version: 1, kind: 'plan', title: '' }, /neither a robot nor a world/],
      [{ version: 1, kind: 'pose_graph', title: '', graph: { vertices: '' } }, /no vertices/],
      [with_((scene) => (scene.plan.configurations = '')), /plan is empty/],
      [
        with_((scene) => (scene.plan.configurations = 'AAAAAAAAAAA=')),
        /2 numbers .* whole rows of 19/,
      ],
      [with_((scene) => (scene.plan.configurations = 'AAAAAAAA')), /cut off: 6 bytes/],
      [with_((scene) => (scene.plan.configurations = '*')), /not base64/],
      [with_((scene) => scene.plan.times.pop()), /41 configurations but 40 times/],
      [with_((scene) => (scene.robot.joints[0].child = 99)), /refers to link 99/],
      [with_((scene) => (scene.robot.joints[1].child = 1)), /two parents/],
      [
        with_((scene) => (scene.tree = { ...stancesTree(), states: pack([1], Int32Array) })),
        /15 centres, 15 parents and 1 states/,
      ],
      [
        with_((scene) => {
          const numbers = { centres: pack([0, 0, 0]), states: pack([1], Int32Array) };
          scene.tree = { ...numbers, parents: pack([4], Int32Array) };
        }),
        /Node 0 of the tree comes before its parent 4/,
      ],
    ];
    for (const [scene, message] of cases) {
      await shown(scene, {}, async ({ page }) => {
        assert.match(await page.textContent('[role=alert]'), message);
      });
    }
  });
});
