// What the textures of an author's text hold: given images, or files of the user's.
import type { SketchControls } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { h, reason } from "../dom";

type Choice = SketchControls["textures"][number];

/** Pixels along the longer side of an image that is kept. */
const LARGEST = 1024;

/** What names a file of the user's begins with. */
const FILE = "file:";

type Image = { width: number; rgba: Uint8Array };

/** The pixels of an image file, made smaller if it is large. */
async function decoded(file: File): Promise<Image> {
    const bitmap = await createImageBitmap(file);
    const scale = Math.min(1, LARGEST / Math.max(bitmap.width, bitmap.height));
    const [width, height] = [bitmap.width, bitmap.height].map((side) => Math.max(1, Math.round(side * scale)));
    const context = new OffscreenCanvas(width, height).getContext("2d")!;
    context.drawImage(bitmap, 0, 0, width, height);
    bitmap.close();
    return { width, rgba: new Uint8Array(context.getImageData(0, 0, width, height).data.buffer) };
}

export class Textures {
    readonly element = h("div", { class: "textures" });
    #chosen: () => Record<string, string>;
    #change: (chosen: Record<string, string>) => void;
    #images = new Map<string, Image>();
    /** The toolchain that has the images: a new one has none. */
    #sent = -1;
    #known = "";

    constructor(chosen: () => Record<string, string>, change: (chosen: Record<string, string>) => void) {
        [this.#chosen, this.#change] = [chosen, change];
    }

    /** Gives the toolchain the user's images, if it does not have them. */
    async send() {
        if (!this.#images.size || this.#sent === toolchain.replaced) return;
        for (const [name, { width, rgba }] of this.#images) {
            if (!await toolchain.call(OWN, "keepImage", name, width, rgba)) throw new Error(`there is no room for the image ${name}`);
        }
        this.#sent = toolchain.replaced;
    }

    show(choices: Choice[]) {
        const known = JSON.stringify([choices, [...this.#images.keys()]]);
        if (known === this.#known) return;
        this.#known = known;
        this.element.replaceChildren(...choices.map((choice) => this.#row(choice)));
    }

    #row({ name, type, value, choices }: Choice): HTMLElement {
        const own = type === "texture_2d<f32>" ? [...this.#images.keys()].map((file) => FILE + file) : [];
        const chosen = this.#chosen()[name] ?? choices.find((one) => value.startsWith(one)) ?? "";
        const all = [...choices, ...own];
        const select: HTMLSelectElement = h("select", { onchange: () => this.#change({ ...this.#chosen(), [name]: select.value }) },
            ...(all.includes(chosen) ? [] : [h("option", { value: "", selected: true }, value)]),
            ...all.map((one) => h("option", { value: one, selected: one === chosen }, one.startsWith(FILE) ? one.slice(FILE.length) : one)));
        const problem = h("span", { class: "wrong", role: "status" });
        const file: HTMLInputElement = h("input", {
            type: "file", accept: "image/*", "aria-label": `Image file for ${name}`,
            onchange: async () => {
                const [given] = file.files ?? [];
                if (!given) return;
                try {
                    this.#images.set(given.name, await decoded(given));
                    this.#sent = -1;
                    this.#change({ ...this.#chosen(), [name]: FILE + given.name });
                } catch (error) {
                    problem.textContent = `${given.name} is no image that the browser reads: ${reason(error)}`;
                }
            },
        });
        return h("div", { class: "row" }, h("label", {}, h("span", {}, `texture ${name}`), select),
            ...(type === "texture_2d<f32>" ? [h("label", {}, h("span", {}, "own image"), file)] : []), problem);
    }
}
