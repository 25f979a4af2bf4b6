/** Starts the page: reads the scene, shows it, or says why it cannot be shown. */
import './style.css';
import { Api, applyHash } from './api';
import { App } from './app';
import { element } from './dom';
import { LiveSession, liveAddress } from './live';
import { readScene, SceneError } from './scene_format';
import { preferredTheme } from './theme';

function explain(root: HTMLElement, title: string, text: string): void {
  document.documentElement.dataset.theme = preferredTheme();
  root.replaceChildren();
  const box = element('section', 'message', root);
  box.setAttribute('role', 'alert');
  element('h1', '', box).textContent = title;
  element('p', '', box).textContent = text;
}

function start(root: HTMLElement): void {
  const scene = readScene(document);
  const app = new App(scene, root);
  applyHash(app, location.hash);
  addEventListener('hashchange', () => applyHash(app, location.hash));
  window.locograph = new Api(app);
  const address = liveAddress(location, scene.live);
  if (address) new LiveSession(app, address);

  let last = performance.now();
  const frame = (now: number) => {
    // After a pause of the page (another tab), time goes on where it was.
    const seconds = Math.min(Math.max(now - last, 0) / 1000, 0.1);
    last = now;
    app.frame(now, seconds);
    window.locographReady = true;
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

const root = document.getElementById('app')!;
try {
  start(root);
} catch (error) {
  const message = (error as Error).message;
  if (error instanceof SceneError) {
    explain(root, 'Nothing to show', message);
  } else if (/webgl/i.test(message)) {
    explain(root, 'This browser cannot draw', `The page needs WebGL 2: ${message}`);
  } else {
    explain(root, 'The scene cannot be shown', message);
  }
}
