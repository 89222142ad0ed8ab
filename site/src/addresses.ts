// Which page has which address. Pages of functions, programs and the guide are files of their own, which
// the build writes; `#/page/path?query` names any page, with its state, on each of them.

/** A page of the site, and what it shows. */
export type Place = { page: string; path: string };

/** Pages that are one file each. */
const SINGLE: Record<string, string> = { home: "index.html", playground: "playground.html", gallery: "gallery.html" };

/** Folders of files, by their pages. A file of the name `index` is the page without a path. */
const FOLDERS: Record<string, string> = { catalogue: "functions", programs: "programs", guide: "guide" };

/** What is in no path that has a file. */
const PLAIN = /^[\w:.-]*$/;

/** The first page of the guide, which is named after its file. */
const FIRST = "README";

/** The file of a page below the site's folder. `undefined` for a page that has none. */
export function fileOf({ page, path }: Place): string | undefined {
    if (Object.hasOwn(SINGLE, page)) return path ? undefined : SINGLE[page];
    if (!Object.hasOwn(FOLDERS, page) || !PLAIN.test(path)) return undefined;
    const name = page === "guide" && path === FIRST ? "" : path;
    return `${FOLDERS[page]}/${name.replaceAll("::", "/") || "index"}.html`;
}

/** The page of a file, as [`fileOf`] names it. */
export function placeOf(file: string): Place | undefined {
    const named = file === "" || file.endsWith("/") ? `${file}index.html` : file;
    const single = Object.entries(SINGLE).find(([, one]) => one === named);
    if (single) return { page: single[0], path: "" };
    const folder = Object.entries(FOLDERS).find(([, one]) => named.startsWith(`${one}/`));
    if (!folder || !named.endsWith(".html")) return undefined;
    const name = named.slice(folder[1].length + 1, -".html".length);
    return { page: folder[0], path: name === "index" ? "" : name.replaceAll("/", "::") };
}
