// Controls for the numbers of uniforms, made from what the reflection has.
import { h } from "../dom";

/** A scalar or a vector of a uniform buffer, with its path and its type in WGSL. */
export type Uniform = { path: string; type: string; numbers: number[]; program?: string };

const PARTS = ["x", "y", "z", "w"];

const whole = (type: string) => /[iu]32|^vec\d[iu]/.test(type);
const shown = (value: number) => String(Number(value.toPrecision(6)));

/** The controls in a place. Those that are there already only get their new numbers. */
export class Uniforms {
    #place: HTMLElement;
    #change: (path: string, numbers: number[]) => void;
    #known = "";
    #inputs = new Map<string, HTMLInputElement[][]>();

    constructor(place: HTMLElement, change: (path: string, numbers: number[]) => void) {
        this.#place = place;
        this.#change = change;
    }

    show(uniforms: Uniform[]) {
        const known = uniforms.map((one) => `${one.program}/${one.path}:${one.type}`).join();
        if (known !== this.#known) this.#build(uniforms);
        this.#known = known;
        for (const { path, numbers } of uniforms) {
            for (const [index, inputs] of (this.#inputs.get(path) ?? []).entries()) {
                for (const input of inputs) if (input !== document.activeElement) input.value = shown(numbers[index]);
            }
        }
    }

    #build(uniforms: Uniform[]) {
        this.#inputs.clear();
        const groups = new Map<string, Uniform[]>();
        for (const one of uniforms) {
            const name = one.path.slice(0, Math.max(0, one.path.lastIndexOf("."))) || one.path;
            const title = one.program ? `${one.program}: ${name}` : name;
            groups.set(title, [...(groups.get(title) ?? []), one]);
        }
        const open = new Set([...this.#place.querySelectorAll("details[open]")].map((one) => one.getAttribute("data-group")));
        this.#place.replaceChildren(...[...groups].map(([title, members]) =>
            h("details", { "data-group": title, open: open.has(title) || groups.size === 1 }, h("summary", {}, title),
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
        return h("div", { class: "uniform", "data-path": path },
            h("span", { class: "name" }, name, h("small", {}, ` ${type}`)), ...all.flat());
    }
}
