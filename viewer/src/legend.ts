/** The legend: what the colours mean, and their units. */
import { element, quantity } from './dom';
import { hex } from './theme';

export interface LegendEntry {
  label: string;
  colour: number;
  shape: 'dot' | 'line' | 'dashed' | 'arrow' | 'patch';
  /** Layer it belongs to: gone when the layer is hidden. */
  layer?: string;
}

/** A scale of colours. */
export interface LegendScale {
  label: string;
  lowest: number;
  highest: number;
  colours: number[];
  layer: string;
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

  show(entries: LegendEntry[], scales: LegendScale[]): void {
    this.list.replaceChildren();
    for (const entry of entries) {
      if (entry.layer && !this.isOn(entry.layer)) continue;
      const item = element('li', '', this.list);
      const key = element('i', `key ${entry.shape}`, item);
      key.style.setProperty('--key', hex(entry.colour));
      element('span', '', item).textContent = entry.label;
    }
    for (const { label, lowest, highest, colours, layer } of scales) {
      if (!this.isOn(layer)) continue;
      const item = element('li', 'heights', this.list);
      element('span', '', item).textContent = `${label}: ${quantity(lowest, 'm')}`;
      const bar = element('i', 'gradient', item);
      bar.style.background = `linear-gradient(90deg, ${colours.map(hex).join(', ')})`;
      element('span', '', item).textContent = quantity(highest, 'm');
    }
  }
}
