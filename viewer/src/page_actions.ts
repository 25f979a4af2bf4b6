/** What buttons and keys do to the page. */
import { ViewName } from './cameras';

export interface PageActions {
  setView(view: ViewName): void;
  toggleTheme(): void;
  togglePanel(): void;
  toggleHelp(): void;
}
