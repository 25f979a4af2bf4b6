/** The bar at the top: title, what the live run does, cameras, light or dark, help, panel. */
import { ViewName } from './cameras';
import { button, element, number } from './dom';
import { icon } from './icons';
import { PageActions } from './page_actions';
import { Scene } from './scene_format';
import { SceneViews } from './scene_views';

const CAMERAS: [ViewName, string, string][] = [
  ['overview', 'All', '0'],
  ['front', 'Front', '1'],
  ['side', 'Side', '2'],
  ['top', 'Top', '3'],
  ['follow', 'Follow', '4'],
];

export class TopBar {
  readonly liveChip: HTMLButtonElement;
  private readonly cameras = new Map<ViewName, HTMLButtonElement>();

  constructor(parent: HTMLElement, scene: Scene, views: SceneViews, page: PageActions) {
    const title = element('div', 'title', parent);
    element('h1', '', title).textContent = scene.title;
    const subtitle = element('p', '', title);
    subtitle.textContent = subtitle.title = describe(scene, views);
    this.liveChip = element('button', 'chip live', parent);
    this.liveChip.type = 'button';
    this.liveChip.hidden = true;
    const cameras = element('nav', 'group', parent);
    cameras.setAttribute('aria-label', 'Camera');
    for (const [view, text, key] of CAMERAS) {
      if (view === 'follow' && !views.robot) continue;
      const made = button(text, `Camera: ${view} (${key})`, cameras, () => page.setView(view));
      this.cameras.set(view, made);
    }
    const tools = element('div', 'group', parent);
    button('', 'Light or dark (t)', tools, () => page.toggleTheme()).innerHTML = icon('sun');
    button('?', 'Keyboard (?)', tools, () => page.toggleHelp());
    const panel = button('', 'Side panel (p)', tools, () => page.togglePanel());
    panel.innerHTML = icon('panel');
    panel.id = 'toggle-panel';
    panel.setAttribute('aria-controls', 'panel');
  }

  showView(view: ViewName): void {
    for (const [name, made] of this.cameras)
      made.setAttribute('aria-pressed', String(name === view));
  }
}

function describe(scene: Scene, { graph, plan, voxels }: SceneViews): string {
  if (graph) return `${number(graph.vertexCount)} poses, ${number(graph.edgeCount)} edges`;
  const parts: string[] = [];
  if (scene.robot) parts.push(scene.robot.name);
  if (plan && plan.count > 1) {
    if (plan.steps) parts.push(`${plan.count} stances`);
    else parts.push(`${plan.count} configurations`, `${number(plan.end - plan.start)} s`);
  }
  if (voxels) {
    const left = scene.map?.left_out ?? 0;
    const far = left > 0 ? ` (${number(left)} far away left out)` : '';
    parts.push(`${number(voxels.count)} voxels${far}`);
  }
  return parts.join(' · ');
}
