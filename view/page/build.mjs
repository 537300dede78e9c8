// Makes dist/page.html of the sources: npm ci && npm run build. The result is kept with the sources;
// nobody needs npm to build galactic.
import { createHash } from "node:crypto";
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

/// The files that the page is made of, in the order in which their hash is computed.
const sources = ["build.mjs", "index.html", "package.json", "package-lock.json", "style.css",
  ...readdirSync("src").sort().map((name) => `src/${name}`)];

const result = await build({
  entryPoints: ["src/main.js"], bundle: true, minify: true, format: "iife", target: "es2022",
  write: false, legalComments: "none",
});
// What would end the script element early must not stand in it.
const bundle = result.outputFiles[0].text.replaceAll("</script", "<\\/script").trim();
const style = readFileSync("style.css", "utf8").replace(/\s*\n\s*/g, "\n").trim();
const license = readFileSync("node_modules/three/LICENSE", "utf8").trim();
const page = readFileSync("index.html", "utf8")
  .replace("/*style*/", () => style)
  .replace("/*bundle*/", () => `/*\nThis page contains three.js:\n\n${license}\n*/\n${bundle}\n`);

const hash = createHash("sha256");
for (const name of sources) hash.update(name).update("\0").update(readFileSync(name)).update("\0");
mkdirSync("dist", { recursive: true });
writeFileSync("dist/page.html", page);
writeFileSync("dist/LICENSE.three.txt", license + "\n");
const digest = (bytes) => createHash("sha256").update(bytes).digest("hex");
writeFileSync("dist/hashes.txt", `sources ${hash.digest("hex")}\npage ${digest(page)}\n`);
console.log(`dist/page.html: ${page.length} bytes`);
