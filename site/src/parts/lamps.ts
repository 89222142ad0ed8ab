// Lamps as handles over a picture: dragged with a pointer, or moved with keys.
import type { LampInfo, PictureControls } from "@lamplight/toolchain";
import { h } from "../dom";

type Vector = [number, number, number];

/** A matrix, column by column, times a point. */
function transform(matrix: number[], [x, y, z]: Vector): [number, number, number, number] {
    const row = (r: number) => matrix[r] * x + matrix[4 + r] * y + matrix[8 + r] * z + matrix[12 + r];
    return [row(0), row(1), row(2), row(3)];
}

function projected(matrix: number[], point: Vector): { at: Vector; behind: boolean } {
    const [x, y, z, w] = transform(matrix, point);
    return { at: [x / w, y / w, z / w], behind: w < 0 };
}

const STEPS: Record<string, Vector> = {
    ArrowLeft: [-0.05, 0, 0], ArrowRight: [0.05, 0, 0], ArrowUp: [0, 0.05, 0], ArrowDown: [0, -0.05, 0],
    PageUp: [0, 0, 0.2], PageDown: [0, 0, -0.2],
};

const within = (share: number) => Math.min(0.97, Math.max(0.03, share));

export class Lamps {
    #over: HTMLElement;
    #move: (index: number, place: Vector, isDone: boolean) => void;
    #handles = new Map<number, HTMLButtonElement>();
    #controls?: PictureControls;

    /** `over` is as large as the picture. */
    constructor(over: HTMLElement, move: (index: number, place: Vector, isDone: boolean) => void) {
        this.#over = over;
        this.#move = move;
    }

    show(controls: PictureControls) {
        this.#controls = controls;
        const wanted = new Set(controls.lamps.map((lamp) => lamp.index));
        for (const [index, handle] of this.#handles) {
            if (wanted.has(index)) continue;
            handle.remove();
            this.#handles.delete(index);
        }
        controls.lamps.forEach((lamp) => this.#place(lamp));
    }

    #place(lamp: LampInfo) {
        const handle = this.#handles.get(lamp.index) ?? this.#handle(lamp.index);
        const { at: [x, y] } = projected(this.#controls!.clipFromWorld, lamp.position as Vector);
        handle.style.left = `${100 * within(0.5 + 0.5 * x)}%`;
        handle.style.top = `${100 * within(0.5 - 0.5 * y)}%`;
        handle.setAttribute("aria-label",
            `Lamp ${lamp.index + 1}, ${lamp.kind}. Arrow keys move it, Page Up and Page Down move it away and nearer.`);
        handle.title = `Lamp ${lamp.index + 1}, ${lamp.kind}: drag it`;
    }

    #handle(index: number): HTMLButtonElement {
        const handle = h("button", { type: "button", class: "lamp", "data-lamp": index }, String(index + 1));
        let last: [number, number] | undefined;
        handle.addEventListener("pointerdown", (event) => {
            handle.setPointerCapture(event.pointerId);
            last = [event.clientX, event.clientY];
        });
        handle.addEventListener("pointermove", (event) => {
            if (!last) return;
            const box = this.#over.getBoundingClientRect();
            const by: Vector = [2 * (event.clientX - last[0]) / box.width, 2 * (last[1] - event.clientY) / box.height, 0];
            last = [event.clientX, event.clientY];
            this.#by(index, by, false);
        });
        const end = () => {
            if (last) this.#by(index, [0, 0, 0], true);
            last = undefined;
        };
        handle.addEventListener("pointerup", end);
        handle.addEventListener("pointercancel", end);
        handle.addEventListener("keydown", (event) => {
            const step = STEPS[event.key];
            if (!step) return;
            event.preventDefault();
            this.#by(index, step, true);
        });
        this.#handles.set(index, handle);
        this.#over.append(handle);
        return handle;
    }

    /** Moves a lamp across the picture at its depth, and then along the line of sight. */
    #by(index: number, [x, y, away]: Vector, isDone: boolean) {
        const { clipFromWorld, worldFromClip, lamps } = this.#controls!;
        const lamp = lamps.find((one) => one.index === index);
        if (!lamp) return;
        const { at, behind } = projected(clipFromWorld, lamp.position as Vector);
        const side = behind ? -1 : 1;
        const there = projected(worldFromClip, [at[0] + side * x, at[1] + side * y, at[2]]).at;
        const [near, far] = [0, 1].map((depth) => projected(worldFromClip, [at[0], at[1], depth]).at);
        const along = far.map((part, axis) => part - near[axis]);
        const length = Math.hypot(...along) || 1;
        lamp.position = there.map((part, axis) => part + (away * along[axis]) / length);
        this.#place(lamp);
        this.#move(index, lamp.position as Vector, isDone);
    }
}
