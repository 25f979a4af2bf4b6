/** The keys, in a dialog. */
import { button, element } from './dom';
import { Layer } from './layers';

const KEYS: [string, string][] = [
  ['space', 'play or pause'],
  ['← →', 'one configuration back or on'],
  ['home end', 'start or end'],
  ['+ -', 'faster, slower'],
  ['l', 'loop'],
  ['0', 'the whole scene'],
  ['1 2 3', 'from the front, the side, above'],
  ['4', 'follow the robot'],
  ['t', 'light or dark'],
  ['p', 'side panel'],
  ['?', 'this list'],
];

export class Help {
  private readonly dialog: HTMLDialogElement;

  constructor(parent: HTMLElement, layers: Layer[]) {
    this.dialog = element('dialog', 'help', parent);
    this.dialog.setAttribute('aria-label', 'Keyboard');
    element('h2', '', this.dialog).textContent = 'Keyboard';
    const list = element('dl', '', this.dialog);
    const rows = [...KEYS];
    for (const layer of layers) if (layer.key) rows.push([layer.key, layer.label.toLowerCase()]);
    for (const [keys, what] of rows) {
      const term = element('dt', '', list);
      for (const key of keys.split(' ')) element('kbd', '', term).textContent = key;
      element('dd', '', list).textContent = what;
    }
    element('p', 'note', this.dialog).textContent =
      'Mouse: drag to turn, right drag to move, wheel to zoom. Touch: one finger turns, two move and zoom.';
    button('Close', 'Close', this.dialog, () => this.dialog.close());
  }

  toggle(): void {
    if (this.dialog.open) this.dialog.close();
    else this.dialog.showModal();
  }
}
