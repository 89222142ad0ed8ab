import { toolchain } from "./client";
import { ROOT, address, countPage, h, isKnown, reason, repeated, route, routeOf } from "./dom";

/** A page fills the place it is given, and says what to do when it is left. */
export type Page = (into: HTMLElement) => Promise<(() => void) | void>;

const PAGES: Record<string, { title: string; open: () => Promise<{ page: Page }> }> = {
    home: { title: "Lamplight", open: () => import("./pages/home") },
    catalogue: { title: "Catalogue", open: () => import("./pages/catalogue") },
    programs: { title: "Programs", open: () => import("./pages/programs") },
    playground: { title: "Playground", open: () => import("./pages/playground") },
    guide: { title: "Guide", open: () => import("./pages/guide") },
    gallery: { title: "Gallery", open: () => import("./pages/gallery") },
    speed: { title: "Speed", open: () => import("./pages/speed") },
};

/** Letters of an address. The page's own links have at most some 60,000. */
const LONGEST = 100_000;

/** What is shown for an address that names no page. */
const missing = (why: string): typeof PAGES[string] => ({
    title: "Not found",
    open: async () => ({
        page: async (into) => into.replaceChildren(h("h1", {}, "Not found"),
            h("p", {}, `${why} `, h("a", { href: address("catalogue") }, "To the catalogue"))),
    }),
});

/** The page of that name. Nothing is below the first one. */
function named(page: string, path: string): typeof PAGES[string] {
    if (location.hash.length > LONGEST) return missing(`The address has more than ${LONGEST.toLocaleString("en")} characters.`);
    if (page === "home" && path) return missing(`The site has no page ${repeated(path)}.`);
    // A plain object has names that are none of its pages, such as `constructor`.
    return Object.hasOwn(PAGES, page) ? PAGES[page] : missing(`The site has no page ${repeated(page)}.`);
}

// The address of the icon is relative to the file that was opened, and the page changes its own address.
for (const icon of document.querySelectorAll<HTMLLinkElement>("link[rel=icon]")) icon.href = icon.href;

let leave: (() => void) | void;
let opened = 0;

/** Shows a page in place of the one before it. What the file of a page has already stays until there is
 * something to replace it with. */
function replaceMain(into: HTMLElement, isFirst: boolean) {
    const before = document.querySelector("main")!;
    if (!isFirst || !before.dataset.page) return before.replaceWith(into);
    into.replaceChildren();
    into.hidden = true;
    before.removeAttribute("id");
    before.after(into);
    const filled = new MutationObserver(() => {
        filled.disconnect();
        before.remove();
        into.hidden = false;
    });
    filled.observe(into, { childList: true });
}

async function open() {
    const now = ++opened;
    countPage();
    const { page, path } = route();
    const known = named(page, path);
    leave?.();
    leave = undefined;
    // The file of a page has a better title than its kind.
    if (now > 1 || location.hash.startsWith("#/")) document.title = page === "home" ? known.title : `${known.title} – Lamplight`;
    for (const link of document.querySelectorAll<HTMLAnchorElement>("nav a")) {
        if (routeOf(new URL(link.href))?.page === page) link.setAttribute("aria-current", "page");
        else link.removeAttribute("aria-current");
    }
    const into = document.createElement("main");
    into.id = "main";
    into.tabIndex = -1;
    into.append("Loading …");
    const isOwn = now === 1 && document.querySelector("main")?.dataset.page === page;
    replaceMain(into, isOwn);
    // Somebody who came by a link reads on at the new page.
    if (now > 1) into.focus({ preventScroll: true });
    try {
        const done = await (await known.open()).page(into);
        if (now === opened) leave = done;
        else done?.();
        document.body.dataset.ready = page;
    } catch (error) {
        const why = h("p", { class: "wrong", role: "alert" }, `This page could not be opened: ${reason(error)}`);
        // What can be read without a toolchain can still be read.
        if (into.hidden) document.querySelector("main")!.prepend(why);
        else into.replaceChildren(why);
    }
}

/** Follows links between pages of the site without loading the document again. */
addEventListener("click", (event: MouseEvent) => {
    const link = (event.target as Element | null)?.closest?.("a");
    // With such a key, the browser opens it elsewhere.
    const isElsewhere = event.button || event.ctrlKey || event.metaKey || event.shiftKey || event.altKey;
    if (!link?.href || isElsewhere || event.defaultPrevented || link.target || link.download) return;
    const url = new URL(link.href);
    const to = routeOf(url);
    if (!to || url.origin !== location.origin || !link.href.startsWith(ROOT)) return;
    event.preventDefault();
    const query = to.query.toString();
    // Where the build wrote no files, the address names the page after `#`.
    const next = new URL(url.hash.startsWith("#/") && query ? url.href : address(to.page, to.path, query));
    next.search ||= location.search;
    if (next.href === location.href) return;
    history.pushState(null, "", next);
    scrollTo(0, 0);
    reopen();
});

const notice = document.querySelector<HTMLElement>("#notice")!;

function showNotice(text: string) {
    notice.textContent = text;
    notice.hidden = !text;
}

/** Milliseconds of loading after which the page says what it waits for. */
const SLOW = 3000;
let loading = 0;
toolchain.onLoading = (isLoading) => {
    clearTimeout(loading);
    if (isLoading) loading = window.setTimeout(() => showNotice("The toolchain is still loading."), SLOW);
    else showNotice("");
};

// Nothing fails in silence.
addEventListener("error", ({ message }) => showNotice(`Something failed: ${message}`));
addEventListener("unhandledrejection", ({ reason: error }) => showNotice(`Something failed: ${reason(error)}`));

document.querySelector(".skip")!.addEventListener("click", (event) => {
    // Its address would be that of a page.
    event.preventDefault();
    document.querySelector<HTMLElement>("main")!.focus();
});

function reopen() {
    delete document.body.dataset.ready;
    open();
}

// A step in the history announces itself by one of the two, or by both.
for (const name of ["hashchange", "popstate"]) {
    addEventListener(name, () => {
        if (!isKnown()) reopen();
    });
}
open();
