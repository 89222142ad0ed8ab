import { countPage, route } from "./dom";

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

let leave: (() => void) | void;
let opened = 0;

async function open() {
    const now = ++opened;
    countPage();
    const { page } = route();
    const known = PAGES[page] ?? PAGES.catalogue;
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
    try {
        const done = await (await known.open()).page(into);
        if (now === opened) leave = done;
        else done?.();
        document.body.dataset.ready = page;
    } catch (error) {
        into.replaceChildren(`This page could not be opened: ${error instanceof Error ? error.message : error}`);
    }
}

addEventListener("hashchange", () => {
    delete document.body.dataset.ready;
    open();
});
open();
