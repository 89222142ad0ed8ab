// A fragment stage drawn on a model of choice, with its inputs and uniforms as controls.
import type { SketchControls, SketchRequest } from "@lamplight/toolchain";
import { type Limit, OWN, toolchain, typed } from "../client";
import { choose, h, reason } from "../dom";
import { Screen, device, sketch } from "../draw";
import { RefusedText } from "../draw/common";
import { latest } from "./latest";
import type { Moment } from "./lines";
import { Pixel, STILL } from "./pixel";
import { Textures } from "./textures";
import { Uniforms } from "./uniforms";

/** What somebody chose, to be kept in a link. */
export type Look = {
    model?: string; turn?: [number, number]; lamp?: [number, number, number]; exposure?: number;
    inputs?: Record<string, string>; uniforms?: Record<string, number[]>; textures?: Record<string, string>;
};

type Shader = SketchRequest["shader"];

const LAMP: [number, number, number] = [1.6, 2, 2.4];
const SIZE = 320;

/** Keys that turn the model, by radians. */
const TURNS: Record<string, [number, number]> = {
    ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1],
};

/** What a person has to know of a picture that shows nothing. */
function onlyColour(canvas: HTMLCanvasElement): string | undefined {
    const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
    const words = new Uint32Array(data.buffer);
    const isOne = words.every((word) => word === words[0]);
    if (!isOne) return undefined;
    const [r, g, b] = data;
    return r + g + b === 0 ? "Every pixel is black." : `Every pixel has the colour rgb(${r}, ${g}, ${b}).`;
}

export class Sketch {
    readonly element: HTMLElement;
    #keptLook: () => Look;
    #shader?: Shader;
    #isTyped: boolean;
    #isOld = () => false;
    #changed: () => void;
    #canvas = h("canvas", {
        width: SIZE, height: SIZE, role: "img", tabindex: "0",
        "aria-label": "The picture. Dragging or the arrow keys turn the model; with Shift they move the light.",
    });
    #screen = new Screen(this.#canvas);
    #status = h("p", { role: "status", class: "status" });
    #inputs = h("div", { class: "row" });
    #numbers = h("div", { class: "uniforms" });
    #uniforms: Uniforms;
    #models = h("span", {});
    /** The light across the picture and upwards, also for fingers, which have no Shift. */
    #lights = ["light across", "light up"].map((label, axis) => {
        const input: HTMLInputElement = h("input", {
            type: "range", min: -4, max: 4, step: 0.1, "aria-label": label,
            oninput: () => {
                const lamp: [number, number, number] = [...this.#look.lamp ?? LAMP];
                lamp[axis] = Number(input.value);
                this.#look.lamp = lamp;
                this.#again(false);
            },
        });
        return input;
    });
    #pixel?: Pixel;
    #textures: Textures;
    #refused: (error: RefusedText) => void;
    #known = "";
    #sources = "";
    /** Seconds, and whether they pass. */
    #time = 1;
    #isPlaying = false;
    /** How often time began to pass. */
    #turns = 0;
    /** Whether somebody wants it to pass; nothing if nobody chose. */
    #isWanted?: boolean;
    #play = h("button", { type: "button", hidden: true, onclick: () => this.#choosePlaying(!this.#isPlaying) });

    /** `changed` is called when somebody changed the look. A text that somebody types has inputs to
     * choose, and is given up if it takes long. Where there is room for what a pixel's run gives, `shown`
     * gets it. `refused` gets what only the browser says of the text. */
    constructor(
        look: () => Look, changed: () => void, isTyped = true, shown?: (moment: Moment | undefined) => void,
        refused: (error: RefusedText) => void = () => {},
    ) {
        this.#refused = refused;
        this.#keptLook = look;
        this.#inputs.hidden = !isTyped;
        this.#isTyped = isTyped;
        this.#changed = changed;
        this.#uniforms = new Uniforms(this.#numbers, (path, numbers) => {
            this.#look.uniforms = { ...this.#look.uniforms, [path]: numbers };
            this.#again(false);
        });
        this.#textures = new Textures(() => this.#look.textures ?? {}, (textures) => {
            this.#look.textures = textures;
            this.#again(true);
        });
        const exposure = h("input", {
            type: "range", min: -4, max: 4, step: 0.25, "aria-label": "Exposure, in powers of two",
            oninput: () => { this.#look.exposure = Number(exposure.value); this.#again(false); },
        });
        exposure.value = String(look().exposure ?? 0);
        const over = h("div", { class: "picture" }, this.#canvas);
        if (shown) this.#pixel = this.#looked(over, shown);
        this.#listen();
        this.element = h("section", { class: "sketch", "aria-label": "Picture" }, over, this.#status, this.#pixel?.element,
            h("div", { class: "row" }, this.#models, this.#play, h("label", {}, h("span", {}, "exposure"), exposure),
                ...this.#lights.map((input) => h("label", {}, h("span", {}, input.ariaLabel!), input))),
            this.#numbers, this.#textures.element, this.#inputs);
    }

    /** Answers what runs for a pixel of the picture. */
    #looked(over: HTMLElement, shown: (moment: Moment | undefined) => void): Pixel {
        this.#canvas.ariaLabel += " A click or Enter shows the values of a pixel, which arrow keys move until Escape.";
        const request = () => ({ ...this.#request(), target: "wgsl" });
        const isOld = () => this.#isOld();
        return new Pixel(over, this.#canvas, {
            size: [SIZE, SIZE], shown,
            run: (pixel) => toolchain.call(typed(isOld), "sketchPixel", request(), pixel),
            marks: () => toolchain.call(typed(isOld), "sketchMarks", request()),
        });
    }

    /** The text has mistakes: the picture is that of an older one, and looks like it. */
    suspend(why: string) {
        this.#setPlaying(false);
        this.element.classList.add("stale");
        this.#pixel?.suspend(why);
    }

    #request() {
        const { turn = [0, 0.3], lamp = LAMP, ...rest } = this.#look;
        // An author's text may have a vertex stage, and its names say what it is given.
        const own = this.#isTyped ? { own: true, time: this.#time } : {};
        return { ...rest, ...own, turn, lamp, shader: this.#shader!, size: SIZE, samples: this.#isPlaying ? 1 : 4 };
    }

    /** Somebody lets time pass, or stops it: so it stays, also after mistakes. */
    #choosePlaying(isPlaying: boolean) {
        this.#isWanted = isPlaying;
        this.#setPlaying(isPlaying);
        // What stands still has smooth edges.
        if (!isPlaying) this.#run();
    }

    #setPlaying(isPlaying: boolean) {
        const isBegun = isPlaying && !this.#isPlaying;
        this.#isPlaying = isPlaying;
        this.#play.textContent = isPlaying ? "Stop the time" : "Let time pass";
        if (!isBegun) return;
        const turn = ++this.#turns;
        let last = performance.now();
        const step = async (now: number) => {
            // It may have been stopped, and begun again, while a picture was drawn.
            if (!this.#isPlaying || turn !== this.#turns || !this.element.isConnected) return;
            this.#time += Math.max(0, now - last) / 1000;
            last = now;
            // Nobody sees a picture that is not in view.
            if (!document.hidden) await this.#run();
            requestAnimationFrame(step);
        };
        requestAnimationFrame(step);
    }

    /** Time passes by itself, unless somebody stopped it or prefers that nothing moves. */
    #offerTime(hasTime: boolean) {
        this.#play.hidden = !hasTime;
        const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
        this.#setPlaying(hasTime && (this.#isWanted ?? !isStill));
    }

    get #look(): Look {
        return this.#keptLook();
    }

    #listen() {
        const turn = (x: number, y: number, light: boolean) => {
            const { turn: [around, up] = [0, 0.3], lamp = LAMP } = this.#look;
            if (light) this.#look.lamp = [lamp[0] - 2 * x, lamp[1] - 2 * y, lamp[2]];
            else this.#look.turn = [around + x, Math.min(1.5, Math.max(-1.5, up + y))];
            this.#again(false);
        };
        let last: [number, number] | undefined;
        let isMoving = false;
        const canvas = this.#canvas;
        canvas.addEventListener("pointerdown", (event) => {
            canvas.setPointerCapture(event.pointerId);
            last = [event.clientX, event.clientY];
            isMoving = false;
        });
        canvas.addEventListener("pointermove", (event) => {
            if (!last) return;
            // A hand that clicks is not quite still.
            isMoving ||= Math.hypot(event.clientX - last[0], event.clientY - last[1]) > STILL;
            if (!isMoving) return;
            turn((last[0] - event.clientX) / 100, (event.clientY - last[1]) / 100, event.shiftKey);
            last = [event.clientX, event.clientY];
        });
        const end = () => { last = undefined; };
        canvas.addEventListener("pointerup", end);
        canvas.addEventListener("pointercancel", end);
        canvas.addEventListener("keydown", (event) => {
            const step = TURNS[event.key];
            if (!step) return;
            event.preventDefault();
            turn(...step, event.shiftKey);
        });
    }

    /** Draws another text, or the same after a change. `isOld` says whether somebody typed on. */
    draw(shader: Shader, isOld = () => false): Promise<void> {
        this.#shader = shader;
        this.#isOld = isOld;
        return this.#again(true);
    }

    #controls = true;

    #again(withControls: boolean): Promise<void> {
        this.#controls ||= withControls;
        if (!withControls) this.#changed();
        return this.#run();
    }

    #run = latest(async (isOld) => {
        // Nobody sees the picture of a page that was left.
        if (!this.element.isConnected) return;
        const withControls = this.#controls;
        this.#controls = false;
        const request = this.#request();
        this.#lights.forEach((input, axis) => { if (input !== document.activeElement) input.value = String(request.lamp[axis]); });
        const isOldText = this.#isOld;
        const limit: Limit = this.#isTyped ? typed(() => isOld() || isOldText()) : OWN;
        // A coarse picture has one sample.
        const take = (factor: number) =>
            sketch({ ...request, size: SIZE / factor, samples: factor === 1 ? request.samples : 1 }, limit);
        const start = performance.now();
        try {
            if (this.#isTyped) await this.#textures.send();
            if (withControls) this.#show(await toolchain.call(limit, "sketchControls", { ...request, target: "wgsl" }));
            if (!await this.#screen.show(take, isOld)) return;
            this.element.classList.remove("stale");
            this.#canvas.dataset.drawn = String(Number(this.#canvas.dataset.drawn ?? 0) + 1);
            const plain = this.#isTyped ? onlyColour(this.#canvas) : undefined;
            this.#status.textContent = `${(await device())?.name}: ${Math.round(performance.now() - start)} ms${plain ? `. ${plain}` : ""}`;
            this.#pixel?.renew();
        } catch (error) {
            this.#setPlaying(false);
            this.element.classList.add("stale");
            this.#status.textContent = reason(error);
            if (error instanceof RefusedText) this.#refused(error);
            this.#pixel?.suspend("There is no picture.");
            this.#controls ||= withControls;
        }
    });

    #show(controls: SketchControls) {
        if (controls.diagnostics.length) return;
        this.#uniforms.show(controls.uniforms, controls.isLinear);
        this.#textures.show(controls.textures);
        this.#offerTime(controls.uniforms.some(({ role }) => role === "time"));
        const models = controls.models.join();
        if (models !== this.#known) {
            const all = this.#isTyped ? ["", ...controls.models] : controls.models;
            this.#models.replaceChildren(choose("model", all, this.#look.model ?? all[0],
                (model) => { this.#look.model = model; this.#again(true); }, "what fits"));
            this.#known = models;
        }
        const sources = controls.inputs.map((one) => `${one.name}:${one.type}`).join();
        if (sources === this.#sources) return;
        this.#sources = sources;
        this.#inputs.replaceChildren(...controls.inputs.map(({ name, source }) =>
            choose(`input ${name}`, controls.sources, source, (chosen) => {
                this.#look.inputs = { ...this.#look.inputs, [name]: chosen };
                this.#again(false);
            })));
    }
}
