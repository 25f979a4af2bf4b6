/** What can be shown and hidden, with its switch in the panel and its key. */
import { element } from './dom';

export interface Layer {
  id: string;
  label: string;
  key?: string;
  on: boolean;
  apply: (on: boolean) => void;
}

export class Layers {
  readonly all: Layer[] = [];
  private readonly boxes = new Map<string, HTMLInputElement>();

  constructor(private readonly changed: () => void) {}

  add(layer: Layer): void {
    this.all.push(layer);
    layer.apply(layer.on);
  }

  set(id: string, on: boolean): void {
    const layer = this.all.find((candidate) => candidate.id === id);
    if (!layer || layer.on === on) return;
    layer.on = on;
    layer.apply(on);
    const box = this.boxes.get(id);
    if (box) box.checked = on;
    this.changed();
  }

  isOn(id: string): boolean {
    return this.all.some((layer) => layer.id === id && layer.on);
  }

  toggle(id: string): void {
    this.set(id, !this.isOn(id));
  }

  /** The key of a layer was pressed; says whether there is one. */
  press(key: string): boolean {
    const layer = this.all.find((candidate) => candidate.key === key);
    if (layer) this.toggle(layer.id);
    return layer !== undefined;
  }

  addSwitches(parent: HTMLElement): void {
    for (const layer of this.all) {
      const label = element('label', 'switch', parent);
      const box = element('input', '', label);
      box.type = 'checkbox';
      box.checked = layer.on;
      box.addEventListener('change', () => this.set(layer.id, box.checked));
      this.boxes.set(layer.id, box);
      element('span', '', label).textContent = layer.label;
      if (layer.key) element('kbd', '', label).textContent = layer.key;
    }
  }
}
