import { readFileSync } from 'node:fs';

import { defineConfig } from 'vite';

// What it asks for: its notice goes wherever it goes.
const licence = readFileSync(new URL('./node_modules/three/LICENSE', import.meta.url), 'utf8').trim();

// The page must be one file that asks for nothing: its scripts and styles move into it.
function oneFile() {
  const inScript = (code) => code.replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
  return {
    name: 'one-file',
    enforce: 'post',
    generateBundle(options, bundle) {
      const page = bundle['index.html'];
      let styles = '';
      let scripts = '';
      for (const [name, file] of Object.entries(bundle)) {
        if (name.endsWith('.css')) styles += file.source;
        else if (file.type === 'chunk') scripts += file.code;
        else continue;
        delete bundle[name];
      }
      // Functions as replacements: the code is full of dollar signs.
      page.source = page.source
        .replace(/\s*<(script|link)[^>]*\/assets\/[^>]*>(<\/script>)?/g, () => '')
        .replace('<head>', () => `<!-- Of three.js, which is in this page:\n\n${licence}\n-->\n  <head>`)
        .replace('</head>', () => `  <style>${styles.trim()}</style>\n  </head>`)
        .replace('</body>', () => `  <script type="module">${inScript(scripts)}</script>\n  </body>`);
    },
  };
}

export default defineConfig({
  base: './',
  build: { target: 'es2022', modulePreload: false, assetsInlineLimit: 1 << 20, chunkSizeWarningLimit: 2048 },
  plugins: [oneFile()],
});
