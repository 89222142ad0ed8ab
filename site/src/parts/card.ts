// A picture of the gallery: a stored one at first, then a live one, of which a pixel can be asked about.
import type { PictureRequest, PresetInfo } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { ROOT, address, h, sentence } from "../dom";
import { looked, picture, show } from "../draw";
import { Listed } from "./listed";
import { Pixel } from "./pixel";
import { titleOf } from "./titles";

/** Pixels of a picture. */
const SIZE: [number, number] = [256, 192];

export class Card {
    readonly element: HTMLElement;
    readonly canvas: HTMLCanvasElement;
    /** What the search looks at. */
    readonly words: string;
    #stored: HTMLImageElement;
    #over: HTMLElement;
    #request: Omit<PictureRequest, "target">;
    #pixel?: Pixel;

    constructor({ name, doc, source, program, key }: PresetInfo) {
        const title = titleOf(name);
        this.words = [title, name, doc, source, program, key].join(" ").toLowerCase();
        this.#request = { preset: name, width: SIZE[0], height: SIZE[1], samples: 4 };
        this.#stored = h("img", { src: `${ROOT}pictures/${name}.png`, width: SIZE[0], height: SIZE[1], loading: "lazy", alt: doc });
        this.canvas = h("canvas", {
            width: SIZE[0], height: SIZE[1], role: "img", tabindex: "0", hidden: true, "data-preset": name,
            "aria-label": `${doc} A click or Enter shows the values of a pixel, which arrow keys move until Escape.`,
        });
        this.#over = h("div", { class: "picture" }, this.#stored, this.canvas);
        this.element = h("article", { class: "card" }, this.#over,
            h("h3", {}, h("a", { href: address("programs", program, `preset=${name}`) }, title)),
            h("p", {}, ...sentence(doc)), h("p", { class: "note" }, source));
        // Before a click, so that it is the first one that counts.
        for (const event of ["pointerdown", "focus"]) this.canvas.addEventListener(event, () => this.#ask());
    }

    /** Draws the live picture. */
    async draw() {
        show(this.canvas, await picture(this.#request));
        this.#stored.hidden = true;
        this.canvas.hidden = false;
        this.canvas.dataset.drawn = "1";
    }

    /** Makes room for the values of a pixel. */
    #ask() {
        if (this.#pixel) return;
        const listed = new Listed();
        this.#pixel = new Pixel(this.#over, this.canvas, {
            size: SIZE,
            shown: (moment) => {
                this.element.classList.toggle("open", moment !== undefined);
                listed.show(moment);
            },
            run: (at) => looked(this.#request, (asked) => toolchain.call(OWN, "picturePixel", asked, at)),
            marks: () => looked(this.#request, (asked) => toolchain.call(OWN, "pictureMarks", asked)),
        });
        this.#over.after(this.#pixel.element, listed.element);
        this.#pixel.renew();
    }
}
