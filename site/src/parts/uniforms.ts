// Controls for the numbers of uniforms, made from what the reflection has.
import { h } from "../dom";

/** A scalar or a vector of a uniform buffer, with its path and its type in WGSL. */
export type Uniform = { path: string; type: string; numbers: number[]; program?: string; role?: string };

const PARTS = ["x", "y", "z", "w"];

const whole = (type: string) => /[iu]32|^vec\d[iu]/.test(type);
/** A part of a colour from 0 to 1 in linear light, encoded for a display; and back (IEC 61966-2-1). */
const encoded = (part: number) => (part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055);
const decoded = (part: number) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);

/** The nearest colour that a picker can show. */
function hex(numbers: number[], isLinear: boolean): string {
    const digits = (part: number) => Math.round(255 * Math.min(1, Math.max(0, isLinear ? encoded(Math.max(0, part)) : part))).toString(16).padStart(2, "0");
    return `#${numbers.slice(0, 3).map(digits).join("")}`;
}

const shown = (value: number) => String(Number(value.toPrecision(6)));

/** The controls in a place. Those that are there already only get their new numbers. */
export class Uniforms {
    #place: HTMLElement;
    #change: (path: string, numbers: number[]) => void;
    #known = "";
    #inputs = new Map<string, HTMLInputElement[][]>();
    #pickers = new Map<string, HTMLInputElement>();
    /** Whether numbers of colours are linear light. */
    #isLinear = true;

    constructor(place: HTMLElement, change: (path: string, numbers: number[]) => void) {
        this.#place = place;
        this.#change = change;
    }

    show(uniforms: Uniform[], isLinear = true) {
        this.#isLinear = isLinear;
        const known = uniforms.map((one) => `${one.program}/${one.path}:${one.type}`).join();
        if (known !== this.#known) this.#build(uniforms);
        this.#known = known;
        for (const { path, numbers } of uniforms) {
            for (const [index, inputs] of (this.#inputs.get(path) ?? []).entries()) {
                for (const input of inputs) if (input !== document.activeElement) input.value = shown(numbers[index]);
            }
            const picker = this.#pickers.get(path);
            if (picker && picker !== document.activeElement) picker.value = hex(numbers, isLinear);
        }
    }

    #build(uniforms: Uniform[]) {
        this.#inputs.clear();
        this.#pickers.clear();
        const groups = new Map<string, Uniform[]>();
        for (const one of uniforms) {
            const name = one.path.slice(0, Math.max(0, one.path.lastIndexOf("."))) || one.path;
            const title = one.program ? `${one.program}: ${name}` : name;
            groups.set(title, [...(groups.get(title) ?? []), one]);
        }
        const open = new Set([...this.#place.querySelectorAll("details[open]")].map((one) => one.getAttribute("data-group")));
        this.#place.replaceChildren(...[...groups].map(([title, members]) =>
            h("details", { "data-group": title, open: open.has(title) || groups.size < 5 && !members[0].program }, h("summary", {}, title),
                ...members.map((one) => this.#row(one)))));
    }

    #row(uniform: Uniform): HTMLElement {
        const { path, type, numbers } = uniform;
        const name = path.slice(path.lastIndexOf(".") + 1);
        const step = whole(type) ? 1 : "any";
        const all: HTMLInputElement[][] = [];
        const last = [...numbers];
        const update = (from: HTMLInputElement, index: number) => {
            const value = Number(from.value);
            if (from.value === "" || !Number.isFinite(value)) return;
            for (const other of all[index]) if (other !== from) other.value = from.value;
            last[index] = value;
            // A field that somebody has just emptied keeps its number.
            all.forEach(([{ value }], at) => { if (value !== "") last[at] = Number(value); });
            this.#change(path, [...last]);
        };
        numbers.forEach((value, index) => {
            const label = numbers.length > 1 ? `${path} ${PARTS[index] ?? index}` : path;
            const number = h("input", {
                type: "number", step, value: shown(value), "aria-label": label, oninput: () => update(number, index),
            });
            all.push([number]);
        });
        if (numbers.length === 1) {
            const [value] = numbers;
            const range = h("input", {
                type: "range", min: Math.min(0, 2 * value), max: Math.abs(value) <= 1 ? 1 : 2 * Math.abs(value),
                step: whole(type) ? 1 : "any", "aria-label": `${path}, slider`, oninput: () => update(range, 0),
            });
            range.value = String(value);
            all[0].push(range);
        }
        this.#inputs.set(path, all);
        const picker = uniform.role === "color" ? [this.#picker(uniform, last, all)] : [];
        return h("div", { class: "uniform", "data-path": path },
            h("span", { class: "name" }, name, h("small", {}, ` ${type}`)), ...picker, ...all.flat());
    }

    /** A control that shows three numbers as a colour. */
    #picker({ path, numbers }: Uniform, last: number[], all: HTMLInputElement[][]): HTMLInputElement {
        const picker = h("input", {
            type: "color", value: hex(numbers, this.#isLinear), "aria-label": `${path}, colour`,
            oninput: () => {
                const parts = [1, 3, 5].map((at) => parseInt(picker.value.slice(at, at + 2), 16) / 255);
                parts.forEach((part, index) => {
                    last[index] = Number((this.#isLinear ? decoded(part) : part).toPrecision(4));
                    for (const input of all[index]) input.value = shown(last[index]);
                });
                this.#change(path, [...last]);
            },
        });
        this.#pickers.set(path, picker);
        return picker;
    }
}
