// A map over a picture of where a kind of marks is: all pixels with NaN, or all that lose digits.
import type { MarksBegun } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { choose, h, reason } from "../dom";

/** Milliseconds that a step may take, so that the worker soon answers other calls. */
const STEP = 40;

/** A marked pixel, and one without the mark, in red, green, blue and opacity. */
const [MARKED, PLAIN] = [[255, 0, 60, 255], [12, 12, 16, 150]];

const NOTHING = "nothing";

export class Marks {
    readonly element: HTMLElement;
    #begin: () => Promise<MarksBegun>;
    #choice = h("span", {});
    #status = h("p", { class: "note", role: "status" });
    #canvas = h("canvas", { class: "over", "aria-hidden": "true", hidden: true });
    #kinds: { name: string; title: string }[] = [];
    #chosen = NOTHING;
    /** The marks of the pixels that were looked at. */
    #found = new Map<number, number>();
    /** How often it was begun: a run that is not the last one ends. */
    #runs = 0;
    #known = false;

    /** `over` is as large as the picture. */
    constructor(over: HTMLElement, begin: () => Promise<MarksBegun>) {
        this.#begin = begin;
        over.append(this.#canvas);
        this.element = h("div", { class: "marks" }, this.#choice, this.#status);
    }

    /** Offers the choice. */
    async offer() {
        if (this.#kinds.length) return;
        const { kinds } = await toolchain.call(OWN, "markKinds");
        this.#kinds = kinds;
        const titles = kinds.map((kind) => kind.title);
        this.#choice.replaceChildren(choose("show where", [NOTHING, ...titles], NOTHING, (title) => {
            this.#chosen = kinds.find((kind) => kind.title === title)?.name ?? NOTHING;
            this.#show();
        }));
    }

    /** The picture is another one now. */
    renew() {
        this.#forget();
        this.#show();
    }

    #forget() {
        this.#runs++;
        this.#found.clear();
        this.#known = false;
        delete this.#canvas.dataset.looked;
    }

    #show() {
        this.#canvas.hidden = this.#chosen === NOTHING;
        if (this.#chosen === NOTHING) {
            this.#forget();
            this.#status.textContent = "";
        } else if (this.#known) {
            this.#paint([...this.#found.keys()], true);
        } else {
            this.#known = true;
            this.#run(++this.#runs);
        }
    }

    async #run(now: number) {
        this.#status.textContent = "Looking …";
        try {
            const begun = await this.#begin();
            if (now !== this.#runs) return;
            const problem = begun.diagnostics[0]?.message;
            if (problem !== undefined) throw new Error(problem);
            Object.assign(this.#canvas, { width: begun.width, height: begun.height });
            await this.#steps(begun.quads, now);
        } catch (error) {
            if (now !== this.#runs) return;
            this.#known = false;
            this.#status.textContent = reason(error);
        }
    }

    async #steps(quads: number, now: number) {
        let [count, left] = [1, quads];
        const begun = toolchain.replaced;
        while (left > 0 && now === this.#runs && this.#canvas.isConnected) {
            const { pixels, marks, left: rest } = await toolchain.call(OWN, "marksStep", count);
            const took = toolchain.milliseconds;
            if (now !== this.#runs) return;
            if (toolchain.replaced !== begun) throw new Error("The toolchain was restarted: choose again.");
            left = rest;
            pixels.forEach((pixel, index) => this.#found.set(pixel, marks[index]));
            count = Math.max(1, Math.min(4096, Math.round(count * Math.min(4, STEP / Math.max(1, took)))));
            this.#paint(pixels, false, left === 0 ? undefined : 1 - left / quads);
        }
        this.#paint([], false);
        this.#canvas.dataset.looked = String(this.#found.size);
    }

    /** Paints pixels, and says how many have the mark. `share` is how much was looked at so far. */
    #paint(pixels: number[], all: boolean, share?: number) {
        const index = this.#kinds.findIndex((kind) => kind.name === this.#chosen);
        if (index < 0) return;
        const context = this.#canvas.getContext("2d")!;
        const { width, height } = this.#canvas;
        if (!width || !height) return;
        if (pixels.length) {
            const image = all ? context.createImageData(width, height) : context.getImageData(0, 0, width, height);
            for (const pixel of pixels) {
                const isMarked = (this.#found.get(pixel)! >>> index & 1) === 1;
                image.data.set(isMarked ? MARKED : PLAIN, 4 * pixel);
            }
            context.putImageData(image, 0, 0);
        }
        const marked = [...this.#found.values()].filter((marks) => (marks >>> index & 1) === 1).length;
        const of = `${marked.toLocaleString("en")} of ${this.#found.size.toLocaleString("en")} pixels`;
        this.#status.textContent = `${this.#kinds[index].title}: ${of}${share === undefined ? "" : `, ${Math.floor(100 * share)} % looked at`}`;
        this.#canvas.dataset.marked = String(marked);
    }
}
