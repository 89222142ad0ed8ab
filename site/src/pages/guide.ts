import { address, copyButton, h, repeated, route, routeOf } from "../dom";

type Html = { default: string };

/** Puts a button beside a block of code that copies what one types: of a session in a terminal, only the
 * commands. */
function copyable(pre: HTMLPreElement) {
    const isSession = pre.querySelector(".tok-prompt") !== null;
    const lines = (pre.textContent ?? "").split("\n");
    const typed = isSession ? lines.filter((line) => /^[$>] /.test(line)).map((line) => line.slice(2)) : lines;
    const box = h("div", { class: "code" });
    pre.replaceWith(box);
    box.append(copyButton(typed.join("\n").trimEnd(), pre.getAttribute("aria-label") ?? "code", pre), pre);
}

/** Links to the pages before and after the one that is shown. */
function neighbours(contents: HTMLElement): HTMLElement {
    const all = [...contents.querySelectorAll("a")];
    const at = all.findIndex((link) => link.hasAttribute("aria-current"));
    const to = (link: HTMLAnchorElement | undefined, words: string) =>
        (link ? h("a", { href: link.href }, `${words}: ${link.textContent}`) : h("span", {}));
    return h("nav", { class: "row neighbours", "aria-label": "Pages before and after" }, to(at > 0 ? all[at - 1] : undefined, "Before"), to(at < 0 ? undefined : all[at + 1], "Next"));
}

const PAGES = import.meta.glob<Html>(["../../../docs/guide/*.md", "../../../docs/guide/*.sh", "../../../docs/costs.md"]);

/** The repository's guide, page by page. */
export async function page(into: HTMLElement) {
    const pages = new Map(Object.entries(PAGES).map(([path, load]) => [path.replace(/^.*\//, "").replace(/\.md$/, ""), load]));
    const [name, heading] = route().path.split("/");
    const contents = h("nav", { class: "list contents", "aria-label": "Pages of the guide" });
    contents.innerHTML = (await pages.get("SUMMARY")!()).default;
    contents.querySelector("h1")?.remove();
    const article = h("article", { class: "guide" });
    const load = pages.get(name || "README");
    if (load) article.innerHTML = (await load()).default;
    else article.replaceChildren(h("h1", {}, "Not found"), h("p", {}, `The guide has no page ${repeated(name)}.`));
    for (const link of [...contents.querySelectorAll("a"), ...article.querySelectorAll<HTMLAnchorElement>("a[href^='#/']")]) {
        const to = routeOf(new URL(link.href))!;
        link.href = address(to.page, to.path);
        if (contents.contains(link) && to.path === (name || "README")) link.setAttribute("aria-current", "page");
    }
    for (const pre of article.querySelectorAll("pre")) copyable(pre);
    article.append(neighbours(contents));
    for (const title of contents.querySelectorAll("h1")) {
        title.replaceWith(h("p", { class: "part" }, title.textContent ?? ""));
    }
    into.replaceChildren(h("div", { class: "columns" }, h("aside", {}, contents), article));
    document.title = `${article.querySelector("h1")?.textContent ?? "Guide"} – Lamplight`;
    const target = heading && article.querySelector(`#${CSS.escape(heading)}`);
    if (target) target.scrollIntoView();
    else scrollTo(0, 0);
}
