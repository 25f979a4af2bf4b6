/** Colours of the drawing, light and dark; the page's own are in style.css. */

export type ThemeName = 'light' | 'dark';

export interface Theme {
  background: number;
  grid: number;
  ground: number;
  shadow: number;
  sky: number;
  executed: number;
  window: number;
  rest: number;
  base: number;
  reference: number;
  force: number;
  moment: number;
  cone: number;
  centreOfMass: number;
  violation: number;
  before: number;
  after: number;
  loop: number;
  obstacle: number;
  moving: number;
  surface: number;
  seen: number;
  floor: number;
  taken: number;
  beyond: number;
}

const COMMON = {
  executed: 0x2a9d5c,
  window: 0xf08c00,
  force: 0xe8590c,
  moment: 0x9c36b5,
  cone: 0x12b886,
  violation: 0xe03131,
  moving: 0xe8813a,
  seen: 0x0b7285,
  floor: 0x66b2bf,
  taken: 0xe64980,
};

export const THEMES: Record<ThemeName, Theme> = {
  light: {
    ...COMMON,
    // Neither white nor dark: robots are often one of the two.
    background: 0xc3ced9,
    grid: 0x66727f,
    ground: 0xb4c0cb,
    shadow: 0x1b2633,
    sky: 0xffffff,
    rest: 0x3b7ddd,
    base: 0x1864ab,
    reference: 0x868e96,
    centreOfMass: 0xc2255c,
    before: 0xd9822b,
    after: 0x1c66c4,
    loop: 0x9c36b5,
    obstacle: 0x9aa5b1,
    surface: 0x94a9c2,
    beyond: 0x6b7684,
  },
  dark: {
    ...COMMON,
    background: 0x14181e,
    grid: 0x5f6d7e,
    ground: 0x1d232b,
    shadow: 0x000000,
    sky: 0xdfe8f5,
    rest: 0x5c9bf5,
    base: 0x74b3ff,
    reference: 0x8d99a8,
    centreOfMass: 0xff6b9d,
    before: 0xb9762f,
    after: 0x5aa9ff,
    loop: 0xd678ea,
    obstacle: 0x738091,
    surface: 0x5d7391,
    beyond: 0x98a4b3,
  },
};

export function hex(colour: number): string {
  return `#${colour.toString(16).padStart(6, '0')}`;
}

export function preferredTheme(): ThemeName {
  return matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
}

/** Height colours of the map, low to high, as in its legend (sRGB). */
export const HEIGHT_COLOURS = [0x4a5a8f, 0x2f8fa3, 0x4fb37a, 0xd5c34a, 0xe07b39];
/** The same of the voxels that cameras have seen. */
export const SEEN_COLOURS = [0x7a4a12, 0xa8661b, 0xd08a2e, 0xeab54d, 0xf6dc8b];
/** Of the distance to the nearest of them, from none to a metre. */
export const FIELD_COLOURS = [0xc92a2a, 0xf76707, 0xffd43b, 0x69db7c, 0x339af0];
