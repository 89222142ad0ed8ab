// Elements, and the state in the address.
import { type Place, fileOf, placeOf } from "./addresses";
import { type Language, tokens } from "./highlight";

type Child = Node | string | undefined;
type Given = Record<string, unknown>;

/** An element with attributes, listeners (`onclick`) and children. */
export function h<K extends keyof HTMLElementTagNameMap>(
    tag: K, given: Given = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(given)) {
        if (value === undefined || value === false) continue;
        if (name.startsWith("on")) made.addEventListener(name.slice(2), value as EventListener);
        else made.setAttribute(name, value === true ? "" : String(value));
    }
    made.append(...children.filter((child) => child !== undefined));
    return made;
}

/** A sentence, with what is between backticks as code. */
export function sentence(text: string): Child[] {
    return text.split("`").map((part, index, all) =>
        index % 2 && index < all.length - 1 ? h("code", {}, part) : index % 2 ? `\`${part}` : part);
}

/** Letters of a name from an address that an error repeats. */
const REPEATED = 80;

/** A name from an address, as an error repeats it: not at any length, and without characters that change
 * how the rest is read. */
export const repeated = (name: string): string =>
    (name.length > REPEATED ? `${name.slice(0, REPEATED)} …` : name).replace(/\p{C}/gu, "\ufffd");

/** What went wrong, in words. */
export const reason = (error: unknown): string => (error instanceof Error ? error.message : String(error));

/** Tells screen readers something that others see. */
export function say(text: string) {
    const place = document.querySelector("#announcement");
    if (place) place.textContent = text;
}

/** A text that can be scrolled by keyboard. */
export const scrolled = (label: string, ...children: Child[]): HTMLPreElement =>
    h("pre", { tabindex: "0", role: "group", "aria-label": label }, ...children);

/** A text with the classes of its tokens. */
export const coloured = (text: string, language: Language): Child[] =>
    tokens(text, language).map(({ kind, text }) => (kind ? h("span", { class: `tok-${kind}` }, text) : text));

/** A button that copies a text; where the browser refuses that, it selects the place of the text. */
export function copyButton(text: string, label: string, place: HTMLElement): HTMLButtonElement {
    const copied = async () => {
        try {
            await navigator.clipboard.writeText(text);
            return "Copied";
        } catch {
            // Browsers refuse it to pages that did not come over a safe connection.
            getSelection()?.selectAllChildren(place);
            return "Selected: copy it now";
        }
    };
    const button = h("button", {
        class: "copy", type: "button", "aria-label": `Copy ${label}`,
        onclick: async () => say(button.textContent = await copied()),
    }, "Copy");
    return button;
}

/** A text with a button that copies it. */
export function code(text: string, label: string, language: Language = "other"): HTMLElement {
    const pre = scrolled(label, h("code", {}, ...coloured(text, language)));
    return h("div", { class: "code" }, copyButton(text, label, pre), pre);
}

export function choose(
    label: string, values: string[], value: string, change: (value: string) => void, empty = "as published",
): HTMLLabelElement {
    const select = h("select", { onchange: () => change(select.value) },
        ...values.map((one) => h("option", { value: one, selected: one === value }, one || empty)));
    return h("label", {}, h("span", {}, label), select);
}

/** What the address asks for. */
export type Route = Place & { query: URLSearchParams };

/** The site's folder. */
export const ROOT = new URL(document.documentElement.dataset.root ?? "./", document.baseURI).href;

/** Whether the build wrote files for pages. */
const HAS_FILES = import.meta.env.PROD;

/** The address as this page read or wrote it last. */
let known = "";

/** How many times a page was opened since the document was loaded. */
let pages = 0;

/** Whether the page is the one that the document was loaded with. */
export const isFirstPage = (): boolean => pages === 1;

/** Counts a page that is opened. */
export function countPage() {
    pages += 1;
}

/** A part of an address, decoded; as it is where it has no meaning, such as `%E0%A4%A`. */
function decoded(text: string): string {
    try {
        return decodeURIComponent(text);
    } catch {
        return text;
    }
}

/** The page that a hash such as `#/guide/cases` names. A hash of another form is a heading of a page. */
function hashRoute(hash: string): Route | undefined {
    if (!hash.startsWith("#/")) return undefined;
    const [way, query] = hash.slice(2).split("?");
    const [page, ...path] = way.split("/");
    return { page: page || "home", path: decoded(path.join("/")), query: new URLSearchParams(query) };
}

/** The page whose file an address is of. */
function fileRoute(url: URL): Place | undefined {
    const file = `${url.origin}${url.pathname}`;
    return file.startsWith(ROOT) ? placeOf(decoded(file.slice(ROOT.length))) : undefined;
}

/** What an address of the site shows; nothing for other addresses. */
export function routeOf(url: URL): Route | undefined {
    const found = fileRoute(url);
    if (!found) return undefined;
    const path = url.hash && !url.hash.startsWith("#/") && found.page === "guide" ? `${found.path || "README"}/${decoded(url.hash.slice(1))}` : found.path;
    return hashRoute(url.hash) ?? { page: found.page, path, query: new URLSearchParams() };
}

/** What the address of this page asks for. */
export function route(): Route {
    known = location.href;
    return routeOf(new URL(location.href)) ?? { page: "home", path: "", query: new URLSearchParams() };
}

/** The address of a page: of its file, or else its name and path after `#/`. */
export function address(page: string, path = "", query = ""): string {
    const [own, heading] = page === "guide" ? path.split("/") : [path];
    const file = HAS_FILES && !query ? fileOf({ page, path: own }) : undefined;
    if (file === undefined) return `${ROOT}#/${page}${path && `/${path}`}${query && `?${query}`}`;
    return `${ROOT}${file.replace(/(^|\/)index\.html$/, "$1")}${heading ? `#${heading}` : ""}`;
}

/** Puts the state of a page into the address without a step of its own in the history. `into` is the
 * place that the page fills. */
export function remember(
    into: HTMLElement, page: string, path: string, query: Record<string, string | undefined>, present: Record<string, string | undefined> = {},
) {
    // If the user has gone to another page meanwhile, the address stays as it is.
    if (location.href !== known || !into.isConnected) return;
    const given = Object.entries(query).filter((pair): pair is [string, string] => !!pair[1]);
    // What is present counts even where it is empty.
    given.push(...Object.entries(present).filter((pair): pair is [string, string] => pair[1] !== undefined));
    const text = new URLSearchParams(given).toString();
    const own = fileRoute(new URL(location.href));
    const isOwn = own?.page === page && (own.path === path || !own.path);
    // The address of the file says it all.
    const isPlain = !text && own?.page === page && own.path === path;
    const hash = isPlain && isOwn ? "" : `#/${page}${path && `/${path}`}${text && `?${text}`}`;
    if (hash === location.hash) return;
    history.replaceState(null, "", `${location.pathname}${location.search}${hash}`);
    known = location.href;
}

/** Puts another address into the history, for a page that shows it without being opened again. */
export function visit(to: string) {
    const url = new URL(to);
    // Which device draws is said in the query, and stays.
    url.search ||= location.search;
    if (url.href === location.href) return;
    history.pushState(null, "", url);
    known = location.href;
}

/** Whether the page has shown this address already. */
export const isKnown = (): boolean => location.href === known;
