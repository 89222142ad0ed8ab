import type { Drawing, PictureRequest, Pixels, SketchRequest, Step } from "@lamplight/toolchain";
import { type Limit, OWN, toolchain } from "../client";
import { type Device, type Frames } from "./common";

let opening: Promise<Device | undefined> | undefined;

/** Milliseconds that a device may take to open, and to draw. Software is slow on a busy machine. */
const [OPENED, DRAWN] = [20000, 60000];

/** What a promise gives, or an error if it takes too long: some drivers never answer. */
function within<T>(promise: Promise<T>, limit: number, what: string): Promise<T> {
    return new Promise((resolve, reject) => {
        const timer = setTimeout(() => reject(new Error(`${what} within ${limit / 1000} s`)), limit);
        promise.then(resolve, reject).finally(() => clearTimeout(timer));
    });
}

/** The device of the page: WebGPU, or else WebGL2; none where the browser has neither. */
export function device(): Promise<Device | undefined> {
    opening ??= choose().then((found) => {
        document.body.dataset.device = found?.name ?? "none";
        return found;
    }, (error) => {
        opening = undefined;
        throw error;
    });
    return opening;
}

async function choose(): Promise<Device | undefined> {
    // `?device=webgl2` in the address asks for the second choice.
    const requested = new URLSearchParams(location.search).get("device");
    if (requested !== "webgl2" && requested !== "none") {
        const { open } = await import("./webgpu");
        const found = await within(open(), OPENED, "WebGPU did not open").catch(() => undefined);
        if (found) return found;
    }
    return requested === "none" ? undefined : (await import("./webgl2")).open();
}

export const NO_DEVICE = "This browser has neither WebGPU nor WebGL2: pictures cannot be drawn. Everything else works.";

export class Refused extends Error {}

let last: Promise<unknown> = Promise.resolve();

/** Pictures wait for each other. */
function queued<T>(run: () => Promise<T>): Promise<T> {
    const next = last.then(run, run);
    last = next;
    return next;
}

/** A picture, drawn by the page. */
export function picture(request: Omit<PictureRequest, "target">): Promise<Pixels> {
    return queued(() => pictured((target) => toolchain.call(OWN, "pictureStart", { ...request, target })));
}

/** What the toolchain knows of a picture that the page drew. If another one was drawn since, this one is
 * drawn again first. */
export function looked<T extends { lacking: boolean }>(
    request: Omit<PictureRequest, "target">, ask: (request: PictureRequest) => Promise<T>,
): Promise<T> {
    return queued(async () => {
        const target = (await device())?.target ?? "wgsl";
        const found = await ask({ ...request, target });
        if (!found.lacking) return found;
        await pictured((target) => toolchain.call(OWN, "pictureStart", { ...request, target }));
        return ask({ ...request, target });
    });
}

/** Milliseconds after which somebody who switched something should see a picture. */
const SOON = 100;
/** How much smaller a coarse picture is. */
const COARSE = 4;

/** Puts pictures of one kind on a canvas. Where whole ones take long, a coarse one comes first; it is
 * marked. */
export class Screen {
    /** What the last whole picture took. */
    #took = 0;
    #canvas: HTMLCanvasElement;

    constructor(canvas: HTMLCanvasElement) {
        this.#canvas = canvas;
    }

    /** False if the picture became old before it was whole. */
    async show(take: (factor: number) => Promise<Pixels>, isOld: () => boolean): Promise<boolean> {
        if (this.#took > SOON) {
            show(this.#canvas, await take(COARSE));
            this.#canvas.dataset.coarse = "1";
            if (isOld()) return false;
        }
        const start = performance.now();
        const whole = await take(1);
        this.#took = performance.now() - start;
        show(this.#canvas, whole);
        delete this.#canvas.dataset.coarse;
        return true;
    }
}

/** A fragment stage on a model, drawn by the page. `limit` is what the toolchain may take: nobody knows
 * how long a user's text takes. */
export function sketch(request: Omit<SketchRequest, "target">, limit: Limit): Promise<Pixels> {
    return queued(() => pictured((target) => toolchain.call(limit, "sketchStart", { ...request, target })));
}

/** A drawing of the page's own, in the device's language. `undefined` without a device. */
export function drawn(make: (target: string) => Promise<Drawing>): Promise<{ name: string; frames: Frames } | undefined> {
    return queued(() => again(async () => {
        const found = await device();
        return found && { name: found.name, frames: await framed(found, await make(found.target)) };
    }));
}

/** What was lost with a device or with a toolchain that began anew is drawn again. */
class Lost extends Error {}
/** How often something is drawn until it is not lost. */
const TRIES = 3;

async function again<T>(run: () => Promise<T>): Promise<T> {
    for (let tries = 1; ; tries++) {
        try {
            return await run();
        } catch (error) {
            if (!(error instanceof Lost) || tries === TRIES) throw error;
        }
    }
}

async function framed(found: Device, drawing: Drawing): Promise<Frames> {
    const late = `${found.name} did not draw the picture`;
    try {
        return await within(found.draw(drawing), DRAWN, late);
    } catch (error) {
        const reason = error instanceof Error ? error.message : String(error);
        // Such as when a driver is updated. The browser says so a little later. Another device is opened.
        await new Promise((next) => setTimeout(next));
        const isLost = found.isLost();
        if (isLost || reason.startsWith(late)) opening = undefined;
        throw isLost ? new Lost(`${found.name} was lost: ${reason}`) : error;
    }
}

function pictured(start: (target: string) => Promise<Step>): Promise<Pixels> {
    return again(async () => {
        const found = await device();
        if (!found) throw new Refused(NO_DEVICE);
        let step = await start(found.target);
        // The toolchain knows what it has begun until it is begun anew.
        const begun = toolchain.replaced;
        while (step.drawing) {
            const { words, depths } = await framed(found, step.drawing);
            step = await toolchain.call(OWN, "pictureFrames", words, depths);
            if (toolchain.replaced !== begun) throw new Lost("the toolchain was restarted while it made a picture");
        }
        if (!step.picture) throw new Refused(step.diagnostics[0]?.message ?? "there is no picture");
        return step.picture;
    });
}

/** Puts a picture on a canvas. */
export function show(canvas: HTMLCanvasElement, { width, height, rgba }: Pixels) {
    canvas.width = width;
    canvas.height = height;
    const data = new ImageData(new Uint8ClampedArray(rgba), width, height);
    canvas.getContext("2d")?.putImageData(data, 0, 0);
}
