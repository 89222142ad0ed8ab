import { toolchain } from "./client";
import { countPage, h, reason, repeated, route } from "./dom";

/** A page fills the place it is given, and says what to do when it is left. */
export type Page = (into: HTMLElement) => Promise<(() => void) | void>;

const PAGES: Record<string, { title: string; open: () => Promise<{ page: Page }> }> = {
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
            h("p", {}, `${why} `, h("a", { href: "#/catalogue" }, "To the catalogue"))),
    }),
});

/** The page of that name. */
function named(page: string): typeof PAGES[string] {
    if (location.hash.length > LONGEST) return missing(`The address has more than ${LONGEST.toLocaleString("en")} characters.`);
    // A plain object has names that are none of its pages, such as `constructor`.
    return Object.hasOwn(PAGES, page) ? PAGES[page] : missing(`The site has no page ${repeated(page)}.`);
}

let leave: (() => void) | void;
let opened = 0;

async function open() {
    const now = ++opened;
    countPage();
    const { page } = route();
    const known = named(page);
    leave?.();
    leave = undefined;
    document.title = `${known.title} – Lamplight`;
    for (const link of document.querySelectorAll("nav a")) {
        const here = link.getAttribute("href") === `#/${page}`;
        if (here) link.setAttribute("aria-current", "page");
        else link.removeAttribute("aria-current");
    }
    const into = document.createElement("main");
    into.id = "main";
    into.tabIndex = -1;
    into.append("Loading …");
    document.querySelector("main")!.replaceWith(into);
    // Somebody who came by a link reads on at the new page.
    if (now > 1) into.focus({ preventScroll: true });
    try {
        const done = await (await known.open()).page(into);
        if (now === opened) leave = done;
        else done?.();
        document.body.dataset.ready = page;
    } catch (error) {
        into.replaceChildren(h("p", { class: "wrong", role: "alert" }, `This page could not be opened: ${reason(error)}`));
    }
}

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

addEventListener("hashchange", () => {
    delete document.body.dataset.ready;
    open();
});
open();
