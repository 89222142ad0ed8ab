// The files of the playground as tabs, of which one is open.
import { h } from "../dom";
import { NAME } from "./state";

type Kept = { files: Record<string, string>; open: string };

const STEPS: Record<string, number> = { ArrowLeft: -1, ArrowRight: 1 };
const ENDS: Record<string, number> = { Home: 0, End: -1 };

export class Files {
    readonly element: HTMLElement;
    #kept: Kept;
    #changed: () => void;
    #tabs = h("div", { class: "tabs", role: "tablist", "aria-label": "Files", onkeydown: (event: KeyboardEvent) => this.#key(event) });
    #remove: HTMLButtonElement;

    /** `changed` is called when another file is open, or a file has another name. */
    constructor(kept: Kept, changed: () => void) {
        this.#kept = kept;
        this.#changed = changed;
        const button = (label: string, words: string, onclick: () => void) =>
            h("button", { type: "button", class: "small", "aria-label": label, title: label, onclick }, words);
        this.#remove = button("Remove this file", "Remove", () => this.#removed());
        this.element = h("div", { class: "files" }, this.#tabs, button("Add a file", "Add", () => this.#added()),
            button("Rename this file", "Rename", () => this.#renamed()), this.#remove);
    }

    show() {
        const names = Object.keys(this.#kept.files);
        this.#remove.disabled = names.length < 2;
        this.#tabs.replaceChildren(...names.map((name) => {
            const isOpen = name === this.#kept.open;
            // One stop of the Tab key for all tabs: arrow keys go from one to the next.
            return h("button", {
                type: "button", role: "tab", "aria-selected": String(isOpen), "aria-controls": "text", tabindex: isOpen ? "0" : "-1",
                onclick: () => this.#open(name),
            }, name);
        }));
    }

    #open(name: string) {
        this.#kept.open = name;
        this.show();
        this.#tabs.querySelector<HTMLElement>("[aria-selected=true]")?.focus();
        this.#changed();
    }

    #key(event: KeyboardEvent) {
        const names = Object.keys(this.#kept.files);
        const step = STEPS[event.key];
        const next = step === undefined ? ENDS[event.key] : (names.indexOf(this.#kept.open) + step + names.length) % names.length;
        if (next === undefined) return;
        event.preventDefault();
        this.#open(names.at(next)!);
    }

    /** A name that no file has yet. */
    #askForName(suggested: string): string | undefined {
        const name = prompt("Name of the file", suggested)?.trim();
        if (!name || name === this.#kept.open) return undefined;
        if (Object.hasOwn(this.#kept.files, name)) alert(`There is a file ${name} already.`);
        else if (!NAME.test(name)) alert("A name has letters, digits, dots, hyphens, underscores and slashes.");
        else return name;
        return undefined;
    }

    #added() {
        const name = this.#askForName("more.wesl");
        if (name === undefined) return;
        this.#kept.files[name] = "";
        this.#open(name);
    }

    #renamed() {
        const { files, open } = this.#kept;
        const name = this.#askForName(open);
        if (name === undefined) return;
        this.#kept.files = Object.fromEntries(Object.entries(files).map(([path, text]) => [path === open ? name : path, text]));
        this.#open(name);
    }

    #removed() {
        const { files, open } = this.#kept;
        if (!confirm(`Remove ${open} with its text?`)) return;
        delete files[open];
        this.#open(Object.keys(files)[0]);
    }
}
