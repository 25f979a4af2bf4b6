/** What keys do. */
import { Layers } from './layers';
import { PageActions } from './page_actions';
import { Player } from './player';

/** Typing into a field, or pressing what has the focus, is not for us. */
function belongsToField(target: EventTarget | null, key: string): boolean {
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement && target.type === 'number') return true;
  if (target instanceof HTMLInputElement && target.id === 'slice') return /^(Arrow|Home|End)/.test(key);
  const pressable =
    target instanceof HTMLButtonElement ||
    (target instanceof HTMLElement && target.tagName === 'SUMMARY') ||
    (target instanceof HTMLInputElement && target.type === 'checkbox');
  return pressable && key === ' ';
}

/** `moved`: called after a key that acts on the page; a layer's key says for itself what changed. */
export function listenToKeys(
  player: Player,
  layers: Layers,
  page: PageActions,
  moved: () => void,
): void {
  const actions: Record<string, () => void> = {
    ' ': () => player.toggle(),
    ArrowLeft: () => player.step(-1),
    ArrowRight: () => player.step(1),
    Home: () => player.setTime(player.start),
    End: () => player.setTime(player.end),
    '+': () => player.faster(1),
    '=': () => player.faster(1),
    '-': () => player.faster(-1),
    l: () => (player.loop = !player.loop),
    t: () => page.toggleTheme(),
    p: () => page.togglePanel(),
    '?': () => page.toggleHelp(),
    '0': () => page.setView('overview'),
    '1': () => page.setView('front'),
    '2': () => page.setView('side'),
    '3': () => page.setView('top'),
    '4': () => page.setView('follow'),
  };
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (belongsToField(event.target, event.key)) return;
    const action = Object.hasOwn(actions, event.key) ? actions[event.key] : undefined;
    if (action) {
      action();
      moved();
    } else if (!layers.press(event.key)) {
      return;
    }
    event.preventDefault();
  });
}
