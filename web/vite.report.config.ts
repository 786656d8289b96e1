import { defineConfig, type Plugin } from "vite";

/** Moves the script and the style into the page, so that it is a single file. */
function inline(): Plugin {
  return {
    name: "inline",
    enforce: "post",
    generateBundle(_options, bundle) {
      let [script, style, page] = ["", "", ""];
      for (const [name, file] of Object.entries(bundle)) {
        if (file.type === "chunk") script += file.code;
        else if (name.endsWith(".css")) style += file.source;
        else if (name.endsWith(".html")) page += file.source;
        else throw new Error(`${name} is not in the page`);
        delete bundle[name];
      }
      // The script runs after the data before it, and so before scripts that a test appends.
      const body = `<script>${script.trim().replaceAll("</script", "<\\/script")}</script>`;
      const source = page
        .replace(/\s*<script type="module"[^>]*><\/script>/, "")
        .replace(/\s*<link rel="stylesheet"[^>]*>/, "")
        .replace(/\s*(@DATA@)\s*/, "$1")
        .replace("</head>", () => `<style>${style.trim()}</style></head>`)
        .replace(/\s*<\/body>\s*<\/html>\s*$/, () => `${body}</body></html>\n`);
      this.emitFile({ type: "asset", fileName: "report.html", source });
    },
  };
}

export default defineConfig({
  base: "./",
  oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
  plugins: [inline()],
  build: {
    outDir: "dist-report",
    emptyOutDir: true,
    assetsInlineLimit: Number.POSITIVE_INFINITY,
    cssCodeSplit: false,
    modulePreload: false,
    rolldownOptions: { input: "report.html", output: { format: "iife" } },
  },
});
