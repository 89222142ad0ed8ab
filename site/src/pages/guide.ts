import { address, h, repeated, route, routeOf } from "../dom";

type Html = { default: string };

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
    for (const title of contents.querySelectorAll("h1")) {
        title.replaceWith(h("p", { class: "part" }, title.textContent ?? ""));
    }
    into.replaceChildren(h("div", { class: "columns" }, h("aside", {}, contents), article));
    document.title = `${article.querySelector("h1")?.textContent ?? "Guide"} – Lamplight`;
    const target = heading && article.querySelector(`#${CSS.escape(heading)}`);
    if (target) target.scrollIntoView();
    else scrollTo(0, 0);
}
