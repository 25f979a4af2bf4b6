/** The legend: what the colours mean, and their units. */
import { element, number } from './dom';
import { HEIGHT_COLOURS, hex } from './theme';

export interface LegendEntry {
  label: string;
  colour: number;
  shape: 'dot' | 'line' | 'dashed' | 'arrow' | 'patch';
  /** Layer it belongs to: gone when the layer is hidden. */
  layer?: string;
}

export class Legend {
  readonly element: HTMLDetailsElement;
  private readonly list: HTMLElement;

  constructor(
    parent: HTMLElement,
    private readonly isOn: (layer: string) => boolean,
  ) {
    this.element = element('details', 'legend', parent);
    this.element.open = innerWidth > 700;
    element('summary', '', this.element).textContent = 'Legend';
    this.list = element('ul', '', this.element);
  }

  show(entries: LegendEntry[], heights: { lowest: number; highest: number } | null): void {
    this.list.replaceChildren();
    for (const entry of entries) {
      if (entry.layer && !this.isOn(entry.layer)) continue;
      const item = element('li', '', this.list);
      const key = element('i', `key ${entry.shape}`, item);
      key.style.setProperty('--key', hex(entry.colour));
      element('span', '', item).textContent = entry.label;
    }
    if (!heights || !this.isOn('map')) return;
    const item = element('li', 'heights', this.list);
    element('span', '', item).textContent = `map: ${number(heights.lowest)} m`;
    const bar = element('i', 'gradient', item);
    bar.style.background = `linear-gradient(90deg, ${HEIGHT_COLOURS.map(hex).join(', ')})`;
    element('span', '', item).textContent = `${number(heights.highest)} m`;
  }
}
