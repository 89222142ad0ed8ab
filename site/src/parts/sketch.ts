// A fragment stage drawn on a model of choice, with its inputs and uniforms as controls.
import type { SketchControls, SketchRequest } from "@lamplight/toolchain";
import { type Limit, OWN, toolchain, typed } from "../client";
import { choose, h, reason } from "../dom";
import { Screen, device, sketch } from "../draw";
import { latest } from "./latest";
import type { Moment } from "./lines";
import { Pixel, STILL } from "./pixel";
import { Uniforms } from "./uniforms";

/** What somebody chose, to be kept in a link. */
export type Look = {
    model?: string; turn?: [number, number]; lamp?: [number, number, number]; exposure?: number;
    inputs?: Record<string, string>; uniforms?: Record<string, number[]>;
};

type Shader = SketchRequest["shader"];

const LAMP: [number, number, number] = [1.6, 2, 2.4];
const SIZE = 320;

/** Keys that turn the model, by radians. */
const TURNS: Record<string, [number, number]> = {
    ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1],
};

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
    #known = "";
    #sources = "";

    /** `changed` is called when somebody changed the look. A text that somebody types has inputs to
     * choose, and is given up if it takes long. Where there is room for what a pixel's run gives, `shown`
     * gets it. */
    constructor(look: () => Look, changed: () => void, isTyped = true, shown?: (moment: Moment | undefined) => void) {
        this.#keptLook = look;
        this.#inputs.hidden = !isTyped;
        this.#isTyped = isTyped;
        this.#changed = changed;
        this.#uniforms = new Uniforms(this.#numbers, (path, numbers) => {
            this.#look.uniforms = { ...this.#look.uniforms, [path]: numbers };
            this.#again(false);
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
            h("div", { class: "row" }, this.#models, h("label", {}, h("span", {}, "exposure"), exposure),
                ...this.#lights.map((input) => h("label", {}, h("span", {}, input.ariaLabel!), input))),
            this.#inputs, this.#numbers);
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

    /** The text has mistakes, so that there is no picture of it. */
    suspend(why: string) {
        this.#pixel?.suspend(why);
    }

    #request() {
        const { turn = [0, 0.3], lamp = LAMP, ...rest } = this.#look;
        return { ...rest, turn, lamp, shader: this.#shader!, size: SIZE, samples: 4 };
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
            if (withControls) this.#show(await toolchain.call(limit, "sketchControls", { ...request, target: "wgsl" }));
            if (!await this.#screen.show(take, isOld)) return;
            this.#canvas.dataset.drawn = String(Number(this.#canvas.dataset.drawn ?? 0) + 1);
            this.#status.textContent = `${(await device())?.name}: ${Math.round(performance.now() - start)} ms`;
            this.#pixel?.renew();
        } catch (error) {
            this.#status.textContent = reason(error);
            this.#pixel?.suspend("There is no picture.");
            this.#controls ||= withControls;
        }
    });

    #show(controls: SketchControls) {
        if (controls.diagnostics.length) return;
        this.#uniforms.show(controls.uniforms);
        const models = controls.models.join();
        if (models !== this.#known) {
            this.#models.replaceChildren(choose("model", controls.models, this.#look.model ?? controls.models[0],
                (model) => { this.#look.model = model; this.#again(false); }));
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
