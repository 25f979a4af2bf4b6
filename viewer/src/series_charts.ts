/** Small charts of figures along the plan (clearance, balance margin), with limit and playhead. */
import { element, quantity, setText } from './dom';
import { Plan, PlanSeries } from './plan';

const WIDTH = 280;
const HEIGHT = 44;
const SVG = 'http://www.w3.org/2000/svg';

interface Chart {
  series: PlanSeries;
  playhead: SVGElement;
  value: HTMLElement;
}

function draw(
  name: string,
  attributes: Record<string, string | number>,
  parent: Element,
): SVGElement {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  parent.append(made);
  return made;
}

export class SeriesCharts {
  private readonly charts: Chart[];

  constructor(
    parent: HTMLElement,
    private readonly plan: Plan,
  ) {
    this.charts = plan.series.map((series) => {
      const figure = element('figure', 'series', parent);
      const caption = element('figcaption', '', figure);
      element('span', '', caption).textContent = series.name.replaceAll('_', ' ');
      const value = element('span', 'value', caption);
      const svg = draw(
        'svg',
        { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: 'none' },
        figure,
      );
      svg.setAttribute('role', 'img');
      svg.setAttribute('aria-label', `${series.name} along the plan`);
      let low = Math.min(...series.values, series.limit ?? Infinity);
      let high = Math.max(...series.values, series.limit ?? -Infinity);
      if (!(high > low)) [low, high] = [low - 1, high + 1];
      const y = (v: number) => 3 + (HEIGHT - 6) * (1 - (v - low) / (high - low));
      const points = Array.from(
        series.values,
        (v, i) => `${this.x(plan.times[i]).toFixed(1)},${y(v).toFixed(1)}`,
      );
      if (series.limit !== null) {
        const line = y(series.limit);
        draw('line', { class: 'limit', x1: 0, x2: WIDTH, y1: line, y2: line }, svg);
      }
      draw('polyline', { class: 'curve', points: points.join(' ') }, svg);
      const playhead = draw('line', { class: 'now', x1: 0, x2: 0, y1: 0, y2: HEIGHT }, svg);
      return { series, playhead, value };
    });
  }

  update(time: number): void {
    const index = this.plan.nearestIndex(time);
    const x = this.x(time).toFixed(1);
    for (const { series, playhead, value } of this.charts) {
      playhead.setAttribute('x1', x);
      playhead.setAttribute('x2', x);
      setText(value, quantity(series.values[index], series.unit));
    }
  }

  private x(time: number): number {
    const length = this.plan.end - this.plan.start;
    return length > 0 ? ((time - this.plan.start) / length) * WIDTH : 0;
  }
}
