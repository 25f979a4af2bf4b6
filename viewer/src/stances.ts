/** What changes from one stance of a plan to the next. */
import { Stance } from './scene_format';

export interface StanceChange {
  added: string[];
  removed: string[];
}

/** Nothing for the first stance. */
export function changesOf(stances: Stance[]): StanceChange[] {
  const others = (of: string[], than: string[]) => of.filter((name) => !than.includes(name));
  return stances.map(({ contacts }, i) => {
    const before = stances[i - 1]?.contacts ?? contacts;
    return { added: others(contacts, before), removed: others(before, contacts) };
  });
}

/** "+left_hand, −right_foot" */
export function changeText({ added, removed }: StanceChange): string {
  return [...added.map((name) => `+${name}`), ...removed.map((name) => `−${name}`)].join(', ');
}

/** The stance that a configuration is left in; -1: not known. */
export function stanceAt(stances: Stance[], index: number): number {
  return stances.filter(({ from }) => from <= index).length - 1;
}
