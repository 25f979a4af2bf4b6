/** A strip of small pictures along the bar at the bottom; which of them are in sight and undrawn. */
import { element } from './dom';

const WIDTH = 96;
const HEIGHT = 84;
/** Pixels of a picture for each of the page's. */
const SHARPNESS = 2;

export interface PictureCaption {
  text: string;
  /** Something is violated here. */
  bad: boolean;
}

interface Picture {
  button: HTMLButtonElement;
  canvas: HTMLCanvasElement;
  inSight: boolean;
  drawn: boolean;
}

export class PictureStrip {
  readonly element: HTMLElement;
  readonly aspect = WIDTH / HEIGHT;
  private readonly pictures: Picture[];
  private present = -1;

  /** `go`: a picture was clicked. */
  constructor(parent: HTMLElement, captions: PictureCaption[], go: (index: number) => void) {
    this.element = element('div', 'pictures');
    this.element.setAttribute('role', 'group');
    this.element.setAttribute('aria-label', 'Pictures of the stances');
    this.pictures = captions.map((caption, i) => this.add(caption, i, go));
    parent.prepend(this.element);
    const sight = new IntersectionObserver(
      (entries) => {
        for (const { target, isIntersecting } of entries) {
          const picture = this.pictures.find(({ button }) => button === target);
          if (picture) picture.inSight = isIntersecting;
        }
      },
      { root: this.element, rootMargin: `0px ${WIDTH}px` },
    );
    for (const { button } of this.pictures) sight.observe(button);
    this.element.addEventListener('wheel', (event) => this.roll(event), { passive: false });
  }

  private add({ text, bad }: PictureCaption, i: number, go: (index: number) => void): Picture {
    const button = element('button', bad ? 'picture bad' : 'picture', this.element);
    button.type = 'button';
    button.tabIndex = i === 0 ? 0 : -1;
    const parts = [`Stance ${i}`, text, bad ? 'violates a constraint' : ''];
    button.title = parts.filter((part) => part).join(', ');
    button.setAttribute('aria-label', button.title);
    button.addEventListener('click', () => go(i));
    const canvas = element('canvas', '', button);
    canvas.width = SHARPNESS * WIDTH;
    canvas.height = SHARPNESS * HEIGHT;
    const caption = element('span', '', button);
    element('b', '', caption).textContent = String(i);
    caption.append(` ${text}`);
    return { button, canvas, inSight: false, drawn: false };
  }

  get visible(): boolean {
    return !this.element.hidden;
  }

  set visible(on: boolean) {
    this.element.hidden = !on;
    if (on) this.rollToPresent(true);
  }

  get drawn(): number {
    return this.pictures.filter(({ drawn }) => drawn).length;
  }

  /** The picture to draw next: of those in sight the nearest to the present one; -1: none. */
  next(): number {
    let nearest = -1;
    this.pictures.forEach(({ inSight, drawn }, i) => {
      if (!inSight || drawn) return;
      const closer = Math.abs(i - this.present) < Math.abs(nearest - this.present);
      if (nearest < 0 || closer) nearest = i;
    });
    return nearest;
  }

  paint(index: number, draw: (drawing: CanvasRenderingContext2D) => void): void {
    const picture = this.pictures[index];
    picture.drawn = true;
    const drawing = picture.canvas.getContext('2d');
    if (drawing) draw(drawing);
  }

  /** Pictures that are to be drawn anew; without indices all. */
  forget(indices?: number[]): void {
    const all = indices ? indices.flatMap((i) => this.pictures[i] ?? []) : this.pictures;
    for (const picture of all) picture.drawn = false;
  }

  /** Marks the present picture, and rolls until it is in sight. */
  mark(index: number): void {
    if (index === this.present || !this.pictures[index]) return;
    const jumps = Math.abs(index - this.present) > 1;
    const before = this.pictures[this.present]?.button;
    this.present = index;
    const { button } = this.pictures[index];
    if (before) {
      before.removeAttribute('aria-current');
      before.tabIndex = -1;
      if (document.activeElement === before) button.focus({ preventScroll: true });
    }
    button.setAttribute('aria-current', 'step');
    button.tabIndex = 0;
    this.rollToPresent(jumps);
  }

  /** Nothing where it is in sight with its neighbours. */
  private rollToPresent(toMiddle: boolean): void {
    const button = this.pictures[this.present]?.button;
    if (!button) return;
    const { clientWidth, scrollLeft } = this.element;
    const { offsetLeft, offsetWidth } = button;
    const left = offsetLeft - offsetWidth;
    const right = offsetLeft + 2 * offsetWidth;
    if (left >= scrollLeft && right <= scrollLeft + clientWidth) return;
    if (toMiddle) this.element.scrollLeft = offsetLeft - 0.5 * (clientWidth - offsetWidth);
    else this.element.scrollLeft = left < scrollLeft ? left : right - clientWidth;
  }

  /** A wheel that turns up and down rolls it sideways. */
  private roll(event: WheelEvent): void {
    if (event.ctrlKey || Math.abs(event.deltaX) >= Math.abs(event.deltaY)) return;
    const before = this.element.scrollLeft;
    this.element.scrollLeft += event.deltaY;
    if (this.element.scrollLeft !== before) event.preventDefault();
  }
}
