// What runs for a pixel of a picture: it is clicked or chosen by keys, and a bar goes through the run.
import type { MarksBegun, PixelChoice, PixelRun, RunEvent } from "@lamplight/toolchain";
import { h, reason } from "../dom";
import { Marks } from "./marks";
import { type Moment, counterpart, headline, moment, short } from "./lines";
import { latest } from "./latest";

/** How a page asks about its picture. */
export type Asked = {
    /** Pixels along the edges of the picture. */
    size: [number, number];
    run: (pixel: PixelChoice) => Promise<PixelRun>;
    marks: () => Promise<MarksBegun>;
    /** Called with what stands at the ends of lines; without, when nothing is chosen any more. */
    shown: (moment: Moment | undefined) => void;
};

/** Pixels that a pointer may move between pressing and releasing in a click. */
export const STILL = 4;
/** Milliseconds without another picture after which its values are asked for. */
const SETTLED = 100;
/** Pixels that an arrow key with Shift moves. */
const FAR = 16;

const HINT = "Click on a pixel: the values of its run stand at the lines.";

const MOVES: Record<string, [number, number]> = {
    ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
};

/** Whether a pixel was asked for since the page was loaded: the first time, the browser compiles what runs. */
let isWarm = false;

export class Pixel {
    readonly element: HTMLElement;
    readonly marks: Marks;
    #asked: Asked;
    #canvas: HTMLCanvasElement;
    #marker = h("div", { class: "marker", hidden: true });
    #title = h("h2", {});
    #quad = h("div", { class: "quad", role: "group", "aria-label": "Fragment of the quad" });
    #problems = h("ul", { class: "problems", "aria-label": "Why the run has no end" });
    #step = h("input", { type: "range", min: 0, step: 1, "aria-label": "Step of the run", oninput: () => this.#show() });
    #now = h("div", { class: "now" });
    #found = h("ul", { class: "found", "aria-label": "Marks of the run" });
    #panel: HTMLElement;
    #status = h("p", { class: "note", role: "status" });
    #place?: [number, number];
    #lane?: number;
    #timer = 0;
    #isDrawn = false;
    #run?: PixelRun;
    /** The run of the pixel's own fragment. */
    #own?: PixelRun;

    /** `over` is as large as the picture, and has the canvas in it. */
    constructor(over: HTMLElement, canvas: HTMLCanvasElement, asked: Asked) {
        [this.#canvas, this.#asked] = [canvas, asked];
        this.marks = new Marks(over, asked.marks);
        over.append(this.#marker);
        const close = h("button", { type: "button", onclick: () => this.close() }, "Close");
        this.#panel = h("div", { class: "run", hidden: true, onkeydown: (event: KeyboardEvent) => {
            if (event.key === "Escape") this.close();
        } },
            h("div", { class: "row" }, this.#title, close), this.#quad, this.#problems,
            h("label", {}, h("span", {}, "step of the run"), this.#step), this.#now, this.#found);
        this.element = h("div", { class: "pixel" }, this.#status, this.marks.element, this.#panel);
        this.#listen();
    }

    /** Somebody who points to the picture is likely to click: the first answer shall be as fast as others. */
    #warm() {
        if (isWarm || !this.#isDrawn) return;
        isWarm = true;
        const [x, y] = this.#asked.size.map((side) => side >> 1);
        this.#asked.run({ x, y }).catch(() => { isWarm = false; });
    }

    #listen() {
        for (const event of ["pointerenter", "focus"]) this.#canvas.addEventListener(event, () => this.#warm());
        let start: [number, number] | undefined;
        this.#canvas.addEventListener("pointerdown", ({ clientX, clientY }) => { start = [clientX, clientY]; });
        this.#canvas.addEventListener("click", ({ clientX, clientY }) => {
            if (start && Math.hypot(clientX - start[0], clientY - start[1]) > STILL) return;
            const { left, top, width, height } = this.#canvas.getBoundingClientRect();
            // A click has whole numbers, which mean the pixels of the screen.
            this.#choose([(clientX + 0.5 - left) / width, (clientY + 0.5 - top) / height].map((share, axis) =>
                Math.floor(share * this.#asked.size[axis])) as [number, number]);
        });
        this.#canvas.addEventListener("keydown", (event) => {
            const move = MOVES[event.key];
            const isOpen = this.#place !== undefined;
            if (event.key === "Enter") this.#choose(this.#place ?? [this.#asked.size[0] >> 1, this.#asked.size[1] >> 1]);
            else if (isOpen && event.key === "Escape") this.close();
            else if (isOpen && move) this.#choose(move.map((step, axis) => this.#place![axis] + step * (event.shiftKey ? FAR : 1)) as [number, number]);
            else return;
            event.preventDefault();
            event.stopImmediatePropagation();
        });
    }

    #choose(place: [number, number]) {
        this.#place = place.map((at, axis) => Math.min(this.#asked.size[axis] - 1, Math.max(0, at))) as [number, number];
        this.#lane = undefined;
        this.#mark();
        this.#ask();
    }

    #mark() {
        this.#marker.hidden = !this.#place;
        this.#place?.forEach((at, axis) => {
            this.#marker.style[axis ? "top" : "left"] = `${100 * (at + 0.5) / this.#asked.size[axis]}%`;
        });
    }

    /** Takes the values away. */
    close() {
        if (!this.#place) return;
        this.#place = this.#run = this.#own = undefined;
        this.#mark();
        this.#panel.hidden = true;
        this.#status.textContent = HINT;
        delete this.element.dataset.pixel;
        this.#asked.shown(undefined);
        if (this.element.contains(document.activeElement)) this.#canvas.focus();
    }

    /** The picture is drawn anew: what is chosen in it is asked for again. */
    renew() {
        this.#isDrawn = true;
        if (!this.#place) this.#status.textContent = HINT;
        this.marks.offer().catch((error) => { this.#status.textContent = reason(error); });
        clearTimeout(this.#timer);
        // While a model is turned, pictures go first.
        this.#timer = window.setTimeout(() => {
            this.marks.renew();
            this.#lane = undefined;
            if (this.#place) this.#ask();
        }, SETTLED);
    }

    /** There is no picture for a while. */
    suspend(why: string) {
        clearTimeout(this.#timer);
        this.marks.renew();
        if (!this.#place) return;
        this.#status.textContent = why;
        this.#panel.hidden = true;
        this.#asked.shown(undefined);
    }

    #ask = latest(async (isOld) => {
        if (!this.#place || !this.element.isConnected) return;
        const [[x, y], lane] = [this.#place, this.#lane];
        const start = performance.now();
        isWarm = true;
        try {
            const run = await this.#asked.run({ x, y, lane });
            if (isOld() || !this.#place) return;
            this.#answered(run, x, y);
            Object.assign(this.element.dataset, { pixel: `${x},${y}`, lane: String(run.lane), took: String(Math.round(performance.now() - start)) });
        } catch (error) {
            this.#fail(reason(error));
        }
    });

    #fail(why: string) {
        this.#run = undefined;
        this.#panel.hidden = true;
        this.#status.textContent = why;
        this.#asked.shown(undefined);
    }

    #answered(run: PixelRun, x: number, y: number) {
        const problem = run.diagnostics.map((one) => one.message).join(" ");
        if (!run.events.length) {
            return this.#fail(problem || `Nothing covers the pixel ${x}, ${y}: no fragment runs there. Escape closes.`);
        }
        this.#run = run;
        if (run.lane === run.own) this.#own = run;
        this.#status.textContent = "";
        const more = run.covering > 1 ? `, the nearest of ${run.covering} fragments` : "";
        this.#title.textContent = `Pixel ${x}, ${y}${more}`;
        this.#neighbours(run, x, y);
        this.#problems.replaceChildren(...run.diagnostics.map((one) => {
            const at = one.labels[0];
            return h("li", { class: one.severity }, at ? h("code", {}, `${at.path}:${at.from.line}: `) : "", one.message);
        }));
        this.#problems.hidden = !run.diagnostics.length;
        const marked = run.events.flatMap((event, index) => event.marks.map((mark) => ({ event, index, mark })));
        this.#found.replaceChildren(...marked.map(({ event, index, mark }) => h("li", {},
            h("button", { type: "button", class: "mark", onclick: () => { this.#step.value = String(index); this.#show(); } },
                `▲ ${headline(mark)}`), " ", h("code", {}, this.#where(event)), ` ${mark.text.slice(headline(mark).length + 2)}`)));
        this.#step.max = String(run.events.length - 1);
        this.#step.value = this.#step.max;
        this.#panel.hidden = false;
        this.#show();
    }

    /** The four fragments that are drawn together. */
    #neighbours(run: PixelRun, x: number, y: number) {
        const focused = [...this.#quad.children].indexOf(document.activeElement!);
        this.#quad.replaceChildren(...[0, 1, 2, 3].map((lane) => {
            const at = `${(x & ~1) + (lane & 1)}, ${(y & ~1) + (lane >> 1)}`;
            return h("button", {
                type: "button", "aria-pressed": String(lane === run.lane), title: lane === run.own ? "the pixel" : "its neighbour",
                onclick: () => { this.#lane = lane; this.#ask(); },
            }, lane === run.own ? `${at} •` : at);
        }));
        (this.#quad.children[focused] as HTMLElement | undefined)?.focus();
    }

    #where(event: RunEvent): string {
        const place = event.place === undefined ? undefined : this.#run!.places[event.place];
        return place ? `${place.file}:${place.line}` : "no line of yours";
    }

    /** Shows the moment that the bar is at. */
    #show() {
        const run = this.#run;
        if (!run) return;
        const index = Number(this.#step.value);
        const event = run.events[index];
        const place = event.place === undefined ? undefined : run.places[event.place];
        const turns = event.turns.length ? `, turn ${event.turns.join(".")}` : "";
        const decided = event.decided.map((one) => ` → ${one}`).join("");
        const text = event.kind === "call" ? `call of ${place?.text ?? ""}` : place?.text ?? "";
        this.#step.setAttribute("aria-valuetext", `${index + 1} of ${run.events.length}, ${this.#where(event)}`);
        const cut = run.leftOut ? [h("p", { class: "note" }, `${run.leftOut.toLocaleString("en")} steps before the last ones are left out.`)] : [];
        const ended = run.discarded && index === run.events.length - 1 ? [h("p", {}, "The fragment is discarded.")] : [];
        this.#now.replaceChildren(
            h("p", {}, h("span", { class: "note" }, `${index + 1} of ${run.events.length}${turns} `), h("code", {}, this.#where(event)), " ",
                h("code", { class: "statement" }, text), decided),
            ...this.#table(event, index), ...event.textures.map((line) => h("p", { class: "note texture" }, line)),
            ...event.marks.map((mark) => h("p", { class: "mark" }, `▲ ${mark.text}`)), ...ended, ...cut);
        this.#asked.shown(moment(run, index));
    }

    /** The values of a step, beside those of the pixel's own fragment. */
    #table(event: RunEvent, index: number): HTMLElement[] {
        if (!event.values.length) return [];
        const run = this.#run!;
        const own = run.lane !== run.own && this.#own ? counterpart(run, index, this.#own) : undefined;
        const heads = ["", "f32", "f64", "± what WGSL allows", ...(own ? ["f32 of the pixel"] : [])];
        const row = ({ name, text, exact, bound }: RunEvent["values"][number]) => {
            const other = own?.values.find((one) => one.name === name)?.text;
            return h("tr", {}, h("th", { scope: "row" }, h("code", {}, name)), h("td", {}, text),
                h("td", {}, exact || "the same"), h("td", {}, bound || "0"),
                own ? h("td", { class: other === text ? undefined : "other" }, other === undefined ? "–" : short(other)) : undefined);
        };
        return [h("div", { class: "scrolled", tabindex: "0", role: "group", "aria-label": "Values of the step" }, h("table", {},
            h("thead", {}, h("tr", {}, ...heads.map((head) => h("th", { scope: "col" }, head)))),
            h("tbody", {}, ...event.values.map(row))))];
    }
}
