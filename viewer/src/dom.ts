/** Small helpers for the page. */

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  className = '',
  parent?: HTMLElement,
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  if (className) made.className = className;
  parent?.append(made);
  return made;
}

export function button(
  text: string,
  label: string,
  parent: HTMLElement,
  action: () => void,
): HTMLButtonElement {
  const made = element('button', '', parent);
  made.type = 'button';
  made.textContent = text;
  made.setAttribute('aria-label', label);
  made.title = label;
  made.addEventListener('click', action);
  return made;
}

/** Sets text only if it differs: no layout for what stays. */
export function setText(target: HTMLElement, text: string): void {
  if (target.textContent !== text) target.textContent = text;
}

/** Three significant digits, e.g. 0.0312, -12.4, 2 400 000. */
export function number(value: number): string {
  const size = Math.abs(value);
  if (size >= 1000) return Math.round(value).toLocaleString('en').replaceAll(',', '\u202f');
  if (size === 0) return '0';
  if (size < 1e-3) return value.toExponential(1);
  return String(Number(value.toPrecision(3)));
}

/** Units that are only said, not written. */
const SILENT_UNITS = ['', '1', 'count', 'ratio'];

export function quantity(value: unknown, unit = ''): string {
  if (typeof value !== 'number' || !Number.isFinite(value)) return '–';
  return !SILENT_UNITS.includes(unit) ? `${number(value)} ${unit}` : number(value);
}
