// Builds `template.html`: the whole viewer in one file, which the C++ side puts a scene into.
import { defineConfig } from 'vite';

/** Puts the script and the style sheet into the page, so that it opens from disk by itself. */
function oneFile() {
  return {
    name: 'one-file',
    enforce: 'post',
    generateBundle(_, bundle) {
      const page = bundle['index.html'];
      let html = page.source;
      for (const [name, file] of Object.entries(bundle)) {
        if (name.endsWith('.css')) {
          html = html.replace(
            /<link rel="stylesheet"[^>]*>/,
            () => `<style>${file.source}</style>`,
          );
        } else if (name.endsWith('.js')) {
          const code = file.code.replaceAll('</script', '<\\/script');
          html = html.replace(
            /<script type="module"[^>]*src=[^>]*><\/script>/,
            () => `<script type="module">${code}</script>`,
          );
        } else {
          continue;
        }
        delete bundle[name];
      }
      if (/<(script|link)[^>]*(src|href)="(?!data:)/.test(html)) {
        this.error('the page still refers to another file');
      }
      page.fileName = 'template.html';
      page.source = html;
    },
  };
}

export default defineConfig({
  base: './',
  plugins: [oneFile()],
  build: {
    target: 'es2022',
    assetsInlineLimit: 1e8,
    cssCodeSplit: false,
    modulePreload: false,
    chunkSizeWarningLimit: 1000,
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
});
