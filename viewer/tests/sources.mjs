// Modules of src/ for tests that need no page.
import { Buffer } from 'node:buffer';
import { fileURLToPath } from 'node:url';
import { build } from 'vite';

export async function source(name) {
  const { output } = await build({
    configFile: false,
    root: fileURLToPath(new URL('..', import.meta.url)),
    logLevel: 'error',
    ssr: { noExternal: true },
    build: { ssr: `src/${name}.ts`, write: false, target: 'es2022' },
  });
  const code = Buffer.from(output[0].code).toString('base64');
  return import(`data:text/javascript;base64,${code}`);
}
