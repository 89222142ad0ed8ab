import { ROOT } from "../dom";
import { turntable } from "../parts/turntable";

/** The content of the first page, which is in its file. */
async function content(): Promise<HTMLElement> {
    const own = document.querySelector<HTMLElement>("main[data-page=home]");
    if (own) return own;
    const answer = await fetch(ROOT);
    if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
    const found = new DOMParser().parseFromString(await answer.text(), "text/html").querySelector<HTMLElement>("main[data-page=home]");
    if (!found) throw new Error("the first page has no content");
    // Its addresses are those of the site's folder.
    for (const name of ["href", "src"]) {
        for (const one of found.querySelectorAll(`[${name}]`)) one.setAttribute(name, new URL(one.getAttribute(name)!, ROOT).href);
    }
    return found;
}

/** What Lamplight is, with a picture that can be turned. */
export async function page(into: HTMLElement) {
    into.replaceChildren(...(await content()).childNodes);
    document.title = "Lamplight: lighting and shadows in WGSL and GLSL";
    return turntable(into.querySelector<HTMLElement>(".stage")!);
}
