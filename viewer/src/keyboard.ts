/** What keys do. */
import type { App } from './app';

/** Typing into a field, or pressing what has the focus, is not for us. */
function belongsToField(target: EventTarget | null, key: string): boolean {
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement && target.type === 'number') return true;
  const pressable =
    target instanceof HTMLButtonElement ||
    (target instanceof HTMLElement && target.tagName === 'SUMMARY') ||
    (target instanceof HTMLInputElement && target.type === 'checkbox');
  return pressable && key === ' ';
}

export function listenToKeys(app: App): void {
  const { player } = app;
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
    t: () => app.toggleTheme(),
    p: () => app.togglePanel(),
    '?': () => app.help.toggle(),
    '0': () => app.setView('overview'),
    '1': () => app.setView('front'),
    '2': () => app.setView('side'),
    '3': () => app.setView('top'),
    '4': () => app.setView('follow'),
  };
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (belongsToField(event.target, event.key)) return;
    const action = Object.hasOwn(actions, event.key) ? actions[event.key] : undefined;
    if (action) {
      action();
      app.userMoved();
    } else if (!app.layers.press(event.key)) {
      return;
    }
    event.preventDefault();
  });
}
