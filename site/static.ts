// Pages that can be read without JavaScript, with titles, descriptions and pictures for search engines
// and links: a file for each function, program and page of the guide. They are written when the site is
// built, by the toolchain that runs in the page.
import { copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import type { Plugin } from "vite";
import { coloured, escaped, page as guidePage } from "./guide";
import { fileOf } from "./src/addresses";
import { GROUPS, titleOf } from "./src/parts/titles";
import { type Language, languageOf } from "./src/highlight";

/** Where the site is published. */
const SITE = "https://lamplight-shaders.github.io/lamplight/";

const below = (path: string) => fileURLToPath(new URL(path, import.meta.url));

/** A page as a file. */
type StaticPage = { page: string; path: string; title: string; description: string; html: string; image?: string };

/** Letters of a description that search engines show. */
const LONGEST = 200;

/** The first sentence or two of a text, without signs of Markdown. */
function described(text: string): string {
    const plain = text.replace(/`/g, "").replace(/\[([^\]]*)\]\([^)]*\)/g, "$1").replace(/\s+/g, " ").trim();
    return plain.length <= LONGEST ? plain : `${plain.slice(0, LONGEST).replace(/\s+\S*$/, "")} …`;
}

/** A text with what is between backticks as code. */
const sentence = (text: string): string => text.split("`").map((part, index, all) =>
    (index % 2 && index < all.length - 1 ? `<code>${escaped(part)}</code>` : escaped(index % 2 ? `\`${part}` : part))).join("");

const listing = (text: string, label: string, language: Language): string =>
    `<pre tabindex="0" role="group" aria-label="${escaped(label)}"><code>${coloured(text, language)}</code></pre>\n`;

/** The way from the file of a page to that of another. */
function link(from: string, page: string, path: string): string {
    const up = "../".repeat(from.split("/").length - 1) || "./";
    return `${up}${fileOf({ page, path })!}`;
}

// The toolchain in Node has the same functions as in the page.
type Toolchain = import("../target/toolchain/index.js").Toolchain;
type Modules = ReturnType<Toolchain["library"]>["modules"];
type Item = Modules[number]["items"][number];

function functionList(from: string, modules: Modules, current?: string): string {
    const one = (item: Item) =>
        `<a href="${link(from, "catalogue", item.path)}"${item.path === current ? " aria-current=\"page\"" : ""} title="${escaped(item.summary)}">${escaped(item.name)}</a>`;
    return modules.filter(({ items }) => items.length).map(({ path, items }) =>
        `<details${items.some((item) => item.path === current) ? " open" : ""}><summary>${path}</summary>${items.map(one).join("")}</details>`).join("\n");
}

function functionPage(item: Item, modules: Modules, toolchain: Toolchain): StaticPage {
    const written = toolchain.written(item.path);
    const section = (title: string, text: string | undefined) => (text ? `<p><strong>${title}: </strong>${sentence(text)}</p>\n` : "");
    const members = item.members.map(({ name, type, doc }) => `<dt><code>${escaped(`${name}: ${type}`)}</code></dt><dd>${sentence(doc)}</dd>`).join("\n");
    const from = fileOf({ page: "catalogue", path: item.path })!;
    const html = `<div class="columns"><aside><nav class="list" aria-label="Functions">${functionList(from, modules, item.path)}</nav></aside>
<article class="entry"><h1 tabindex="-1">${escaped(item.name)}</h1><p class="path">${escaped(item.path)}</p>
${item.doc.map((text) => `<p>${sentence(text)}</p>`).join("\n")}
<h2>Use it</h2>
${listing(item.import, "import in WESL", "wgsl")}${listing(item.include, "include in GLSL", "glsl")}${members ? `<dl>${members}</dl>` : ""}
${section("Source", item.source)}${section("Edges", item.edges)}${section("Error model", item.errorModel)}${section("Used by", written.usedBy.map((path) => path.replace(/\.wesl$/, "").replaceAll("/", "::")).join(", "))}
<h2>WESL</h2>
${listing(written.wesl, "WESL source", "wgsl")}${written.glsl ? `<h2>GLSL</h2>\n${listing(written.glsl, "GLSL source", "glsl")}` : ""}</article></div>`;
    const kind = item.kind === "function" ? "in WGSL and GLSL" : `(${item.kind}) in WGSL and GLSL`;
    return { page: "catalogue", path: item.path, title: `${item.name} ${kind} – Lamplight`, description: described(item.summary), html };
}

function catalogue(toolchain: Toolchain): StaticPage[] {
    const { modules } = toolchain.library();
    const items = modules.flatMap((module) => module.items);
    const from = fileOf({ page: "catalogue", path: "" })!;
    const rows = modules.filter(({ items }) => items.length).map(({ path, items }) =>
        `<h2>${path}</h2>\n<ul>${items.map((item) => `<li><a href="${link(from, "catalogue", item.path)}">${escaped(item.name)}</a>: ${sentence(item.summary)}</li>`).join("\n")}</ul>`);
    const description = `${items.length} functions, structures and constants for lighting and shadows, each in WGSL and GLSL, with its source and its bounds of error.`;
    const first = { page: "catalogue", path: "", title: "Catalogue of functions – Lamplight", description, html: `<h1>Catalogue</h1><p>${description}</p>${rows.join("\n")}` };
    return [first, ...items.map((item) => functionPage(item, modules, toolchain))];
}

function programs(toolchain: Toolchain): StaticPage[] {
    const all = toolchain.programs({}).programs;
    const from = fileOf({ page: "programs", path: "" })!;
    const one = (program: (typeof all)[number]): StaticPage => {
        const axes = program.axes.map((axis) =>
            `<tr><th scope="row"><code>${axis.name}</code></th><td>${axis.values.map((value) => `<code>${escaped(String(value))}</code>`).join(" ")}</td><td>${sentence(axis.doc)}</td></tr>`).join("\n");
        const constraints = program.constraints.map(({ require, doc }) => `<li>${sentence(doc)} <code>${escaped(require)}</code></li>`).join("\n");
        const html = `<h1>${program.name}</h1><p>${sentence(program.doc)}</p>
<p>${program.valid.toLocaleString("en")} permutations are possible, ${program.shipped.toLocaleString("en")} ship, for ${program.targets.join(", ")}.</p>
<div class="scrolled" tabindex="0" role="group" aria-label="Axes"><table><thead><tr><th scope="col">axis</th><th scope="col">values</th><th scope="col"></th></tr></thead><tbody>${axes}</tbody></table></div>
${constraints ? `<h2>Constraints</h2><ul>${constraints}</ul>` : ""}`;
        return { page: "programs", path: program.name, title: `Program ${program.name} – Lamplight`, description: described(program.doc), html };
    };
    const list = all.map(({ name, doc }) => `<li><a href="${link(from, "programs", name)}">${name}</a>: ${sentence(doc)}</li>`).join("\n");
    const description = "Shader programs with axes: choose lights, shadows, materials and fog, see the picture, the code for seven targets, and what it costs.";
    return [{ page: "programs", path: "", title: "Programs – Lamplight", description, html: `<h1>Programs</h1><p>${description}</p><ul>${list}</ul>` }, ...all.map(one)];
}

/** Links of a page of the guide, which lead to files here. */
const relinked = (html: string, from: string): string => html.replace(/href="#\/guide\/([^"/]*)(?:\/([^"]*))?"/g, (_, name: string, heading?: string) =>
    `href="${link(from, "guide", name)}${heading ? `#${heading}` : ""}"`);

function guide(): StaticPage[] {
    const folder = below("../docs/guide");
    const files = readdirSync(folder).filter((name) => /\.(md|sh)$/.test(name) && name !== "SUMMARY.md").map((name) => join(folder, name));
    const summary = guidePage(readFileSync(join(folder, "SUMMARY.md"), "utf8"), "SUMMARY", folder).replace(/<h1[^>]*>Contents<\/h1>/, "")
        .replace(/<h1[^>]*>(.*?)<\/h1>/g, "<p class=\"part\">$1</p>");
    return [...files, below("../docs/costs.md")].map((file) => {
        const [text, name] = [readFileSync(file, "utf8"), basename(file).replace(/\.md$/, "")];
        const from = fileOf({ page: "guide", path: name })!;
        const content = file.endsWith(".sh") ? `<h1>${name}</h1>${listing(text, name, "other")}` : guidePage(text, name, dirname(file));
        const heading = /^# (.*)$/m.exec(text)?.[1] ?? name;
        const paragraph = text.split("\n\n").find((part) => /^[A-Z`[]/.test(part.trim()) && !part.startsWith("#!")) ?? heading;
        const contents = relinked(summary, from).replace(`href="${link(from, "guide", name)}"`, "$& aria-current=\"page\"");
        const html = `<div class="columns"><aside><nav class="list contents" aria-label="Pages of the guide">${contents}</nav></aside><article class="guide">${relinked(content, from)}</article></div>`;
        return { page: "guide", path: name, title: `${heading.replace(/`/g, "")} – Lamplight`, description: described(paragraph), html };
    });
}

function singles(toolchain: Toolchain): StaticPage[] {
    const presets = toolchain.studio().presets;
    const unnamed = presets.filter(({ name }) => !GROUPS.some((group) => group.presets.some(([known]) => known === name)));
    if (unnamed.length) throw new Error(`these presets have no title in site/src/parts/titles.ts: ${unnamed.map(({ name }) => name).join(", ")}`);
    const card = ({ name, doc, source }: (typeof presets)[number]) =>
        `<article class="card"><img src="./pictures/${name}.png" width="160" height="120" loading="lazy" alt=""><h3>${escaped(titleOf(name))}</h3><p>${sentence(doc)}</p><p class="note">${escaped(source)}</p></article>`;
    const cards = GROUPS.map(({ title, presets: own }) =>
        `<h2>${title}</h2><div class="cards">${own.flatMap(([name]) => presets.filter((one) => one.name === name)).map(card).join("\n")}</div>`).join("\n");
    return [{
        page: "playground", path: "", title: "Playground for WGSL and GLSL – Lamplight",
        description: "Write a fragment shader in WGSL, WESL or GLSL, see it on a model, and read the value of every line at a pixel. Everything runs in your browser.",
        html: "<h1>Playground</h1><p>Write a fragment shader in WGSL, WESL or GLSL, and see it on a model. The compiler runs in your browser, so this page needs JavaScript.</p>",
    }, {
        page: "gallery", path: "", title: "Gallery – Lamplight",
        description: `${presets.length} techniques of books, talks and papers as pictures, each drawn by functions of the library.`,
        html: `<h1>Gallery</h1>${cards}`,
    }];
}

const attribute = (text: string) => escaped(text).replace(/>/g, "&gt;");

/** A page in the frame that all pages have. */
function framed(shell: string, made: StaticPage, picture: string): string {
    const file = fileOf(made)!;
    const up = "../".repeat(file.split("/").length - 1);
    const own = made.page === "home";
    const address = SITE + file.replace(/(^|\/)index\.html$/, "$1");
    const head = `<link rel="canonical" href="${address}">
<meta property="og:title" content="${attribute(made.title)}">
<meta property="og:description" content="${attribute(made.description)}">
<meta property="og:type" content="website">
<meta property="og:url" content="${address}">
<meta property="og:image" content="${SITE}${made.image ?? picture}">
<meta name="twitter:card" content="summary_large_image">
</head>`;
    const main = own ? "$&" : `<main id="main" tabindex="-1" data-page="${made.page}">${made.html.replaceAll("$", "$$$$")}</main>`;
    return shell
        .replace(/<main[^]*<\/main>/, main)
        .replace("<html lang=\"en\">", `<html lang="en" data-root="${up || "./"}">`)
        .replace(/(<meta name="description" content=")[^"]*/, (_, before: string) => before + attribute(made.description))
        .replace(/<title>[^<]*/, `<title>${escaped(made.title).replaceAll("$", "$$$$")}`)
        .replace(/ href="#main"/, " href=\"#main\"")
        .replace("</head>", head)
        .replace(/(<(?:a|link|script)[^>]* (?:href|src)=")\.\//g, (whole, before: string, at: number, text: string) =>
            // Addresses of the content are right already; those of the frame are as the first page has them.
            (own || isContent(text, at) ? whole : `${before}${up || "./"}`));
}

const isContent = (text: string, at: number): boolean => at > text.indexOf("<main") && at < text.indexOf("</main>");

/** The small pictures that the tests compare, for devices that draw none. */
function storePictures(folder: string) {
    const stored = below("../tests/render/reviewed");
    mkdirSync(join(folder, "pictures"), { recursive: true });
    for (const name of readdirSync(stored).filter((name) => name.endsWith(".png"))) {
        copyFileSync(join(stored, name), join(folder, "pictures", name));
    }
    const compared = below("../docs/gallery/compared");
    for (const name of readdirSync(compared).filter((name) => name.endsWith(".png"))) {
        copyFileSync(join(compared, name), join(folder, "pictures", `compared-${name}`));
    }
}

/** The toolchain as one file that is packed already, so that it arrives as fast from a server that packs
 * nothing. */
function packToolchain(folder: string) {
    const assets = join(folder, "assets");
    const name = readdirSync(assets).find((name) => /^toolchain_bg.*\.wasm$/.test(name));
    if (!name) throw new Error("the site has no toolchain");
    writeFileSync(join(assets, `${name}.packed`), gzipSync(readFileSync(join(assets, name)), { level: 9 }));
}

/** Writes the files of pages after the bundle, around the first page. */
export const staticPages: Plugin = {
    name: "static-pages",
    apply: "build",
    async closeBundle() {
        const folder = below("../target/site");
        const { load } = await import("../target/toolchain/index.js");
        const toolchain: Toolchain = await load();
        const shell = readFileSync(join(folder, "index.html"), "utf8").replace(/<code data-language="(\w+)">([^<]*)/g, (_, name: string, text: string) =>
            `<code>${coloured(text.replaceAll("&lt;", "<").replaceAll("&gt;", ">").replaceAll("&amp;", "&"), languageOf(name))}`);
        const picture = /assets\/hero-[^"]*\.png/.exec(shell)?.[0] ?? "";
        const title = /<title>([^<]*)/.exec(shell)![1];
        const description = /<meta name="description" content="([^"]*)/.exec(shell)![1];
        const pages = [{ page: "home", path: "", title, description, html: "" }, ...singles(toolchain), ...catalogue(toolchain), ...programs(toolchain), ...guide()];
        for (const made of pages) {
            const file = join(folder, fileOf(made)!);
            mkdirSync(dirname(file), { recursive: true });
            writeFileSync(file, framed(shell, made, picture));
        }
        const addresses = pages.map((made) => `<url><loc>${SITE}${fileOf(made)!.replace(/(^|\/)index\.html$/, "$1")}</loc></url>`);
        writeFileSync(join(folder, "sitemap.xml"), `<?xml version="1.0" encoding="UTF-8"?>\n<urlset xmlns="http://www.sitemaps.org/schemas/sitemap/0.9">\n${addresses.join("\n")}\n</urlset>\n`);
        storePictures(folder);
        packToolchain(folder);
    },
};
