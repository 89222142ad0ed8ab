// The text where a run is, for files that the page has no editor for.
import { OWN, toolchain } from "../client";
import { h } from "../dom";
import { latest } from "./latest";
import type { Moment } from "./lines";
import { Listing } from "./listing";

/** A file of the library by the path that a run gives it. */
const inLibrary = (file: string) => file.replace(/^lamplight\//, "");

export class Listed {
    readonly element = h("div", {});
    #isEdited: (file: string) => boolean;
    #texts = new Map<string, string>();
    #listing?: Listing;
    #moment?: Moment;

    /** `isEdited` says of which files the page has an editor. */
    constructor(isEdited: (file: string) => boolean = () => false) {
        this.#isEdited = isEdited;
    }

    /** Shows the file where the run is; nothing without a run. */
    show(moment: Moment | undefined) {
        this.#moment = moment;
        this.#update();
    }

    #update = latest(async () => {
        const file = this.#moment?.now?.file ?? (this.#moment && this.#listing?.file);
        if (file === undefined || this.#isEdited(file)) {
            this.#listing = undefined;
            return this.element.replaceChildren();
        }
        if (file !== this.#listing?.file) {
            const text = this.#texts.get(file) ?? await toolchain.call(OWN, "file", inLibrary(file)) ?? "";
            this.#texts.set(file, text);
            this.#listing = new Listing(file, text);
            this.element.replaceChildren(this.#listing.element);
        }
        // The run may be elsewhere by now; then this is called again.
        const lines = this.#moment?.files.get(file);
        if (lines) this.#listing?.show(lines, this.#moment?.now?.line);
    });
}
