import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";
import { guide } from "./guide";
import { staticPages } from "./static";

const below = (path: string) => fileURLToPath(new URL(path, import.meta.url));

// Addresses are relative: the site works from any folder.
export default defineConfig({
    base: "./",
    publicDir: false,
    plugins: [guide, staticPages],
    resolve: { alias: {
        "@lamplight/toolchain": below("../target/toolchain/index.js"),
    } },
    worker: { format: "es" },
    server: { fs: { allow: [below("..")] } },
    build: {
        outDir: below("../target/site"),
        emptyOutDir: true,
        target: "es2022",
        assetsInlineLimit: 0,
        rollupOptions: { external: ["node:fs/promises"] },
    },
});
