// A file that nobody edits, with the values of a run at the ends of its lines.
import { coloured, h, scrolled } from "../dom";
import { languageOfFile } from "../highlight";
import { type Line, headline, parts } from "./lines";

/** What stands at the end of a line, with its marks in red. */
export function ending(line: Line): HTMLElement {
    const marks = line.marks.map((mark) => h("span", { class: "mark", title: mark.text }, `▲ ${headline(mark)}`));
    const all = [...parts(line).map((part) => h("span", { class: "value" }, part)), ...marks];
    return h("span", { class: "ending" }, ...all.flatMap((one, index) => (index ? [" ", one] : [one])));
}

/** The lines of a text. Only their ends change. */
export class Listing {
    readonly element: HTMLElement;
    #text: HTMLPreElement;
    #lines: HTMLElement[];

    constructor(readonly file: string, text: string) {
        const language = languageOfFile(file);
        this.#lines = text.replace(/\n$/, "").split("\n").map((line, index) =>
            h("span", { class: "line", "data-line": index + 1 }, ...coloured(line, language)));
        this.#text = scrolled(`Text of ${file}`, ...this.#lines);
        this.element = h("figure", { class: "listing" }, h("figcaption", {}, h("code", {}, file)), this.#text);
    }

    show(lines: Map<number, Line>, now?: number) {
        this.#lines.forEach((element, index) => {
            const line = lines.get(index + 1);
            element.querySelector(".ending")?.remove();
            if (line) element.append(ending(line));
            element.classList.toggle("now", index + 1 === now);
        });
        const at = now === undefined ? undefined : this.#lines[now - 1];
        // Only the listing scrolls, and not the page.
        if (at) this.#text.scrollTop = Math.max(0, at.offsetTop - (this.#text.clientHeight - at.offsetHeight) / 2);
    }
}
