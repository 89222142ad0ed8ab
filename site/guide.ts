// The pages of the repository's guide as HTML, made when the site is built.
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { Marked, type Tokens } from "marked";
import type { Plugin } from "vite";
import { type Language, languageOf, tokens } from "./src/highlight";

/** The part of an address that leads to a heading, as GitHub makes it. */
function anchor(text: string): string {
    return text.toLowerCase().replace(/[^\p{L}\p{N}\s_-]/gu, "").trim().replace(/\s/g, "-");
}

export const escaped = (text: string) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");

/** A text with the classes of its tokens. */
export const coloured = (text: string, language: Language): string => tokens(text, language).map(({ kind, text }) =>
    (kind ? `<span class="tok-${kind}">${escaped(text)}</span>` : escaped(text))).join("");

/** A link between pages of the guide as one between pages of the site. */
function rewritten(href: string, page: string): string {
    if (/^[a-z]+:/.test(href)) return href;
    const [path, heading] = href.split("#");
    const name = path ? path.replace(/^.*\//, "").replace(/\.md$/, "") : page;
    return `#/guide/${name}${heading ? `/${heading}` : ""}`;
}

/** A picture beside the pages, as a part of the page. */
function picture(path: string): string {
    return `data:image/png;base64,${readFileSync(path).toString("base64")}`;
}

export function page(text: string, name: string, folder: string): string {
    const marked = new Marked({ gfm: true });
    marked.use({
        renderer: {
            heading({ tokens, depth, text }: Tokens.Heading) {
                return `<h${depth} id="${anchor(text)}">${this.parser.parseInline(tokens)}</h${depth}>\n`;
            },
            link({ href, tokens }: Tokens.Link) {
                return `<a href="${escaped(rewritten(href, name))}">${this.parser.parseInline(tokens)}</a>`;
            },
            image({ href, text }: Tokens.Image) {
                return `<img src="${picture(join(folder, href))}" alt="${escaped(text)}">`;
            },
            code({ text, lang }: Tokens.Code) {
                const label = (lang ?? "").split(" ")[0] || "text";
                return `<pre tabindex="0" role="group" aria-label="${escaped(label)}"><code>${coloured(text, languageOf(label))}</code></pre>\n`;
            },
            table(token: Tokens.Table) {
                const row = (cells: Tokens.TableCell[], tag: string) =>
                    `<tr>${cells.map((cell) => `<${tag}>${this.parser.parseInline(cell.tokens)}</${tag}>`).join("")}</tr>`;
                const rows = token.rows.map((cells) => row(cells, "td")).join("");
                return `<div class="scrolled" tabindex="0" role="group" aria-label="table"><table><thead>${row(token.header, "th")}</thead><tbody>${rows}</tbody></table></div>\n`;
            },
        },
    });
    return marked.parse(text, { async: false });
}

/** Modules of Markdown and of shell scripts export their HTML. */
export const guide: Plugin = {
    name: "guide",
    transform(text, id) {
        const found = /([^/]+)\.(md|sh)$/.exec(id);
        if (!found) return undefined;
        const html = found[2] === "md" ? page(text, found[1], dirname(id)) : `<h1>${found[1]}.sh</h1><pre tabindex="0" role="group" aria-label="${found[1]}.sh"><code>${escaped(text)}</code></pre>`;
        return { code: `export default ${JSON.stringify(html)};`, map: null };
    },
};
