import type { Drawing, PictureRequest, Pixels, SketchRequest, Step } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { type Device, type Frames } from "./common";

let opening: Promise<Device | undefined> | undefined;

/** The device of the page: WebGPU, or else WebGL2; none where the browser has neither. */
export function device(): Promise<Device | undefined> {
    opening ??= choose().then((found) => {
        document.body.dataset.device = found?.name ?? "none";
        return found;
    });
    return opening;
}

async function choose(): Promise<Device | undefined> {
    // `?device=webgl2` in the address asks for the second choice.
    const asked = new URLSearchParams(location.search).get("device");
    if (asked !== "webgl2" && asked !== "none") {
        const found = await (await import("./webgpu")).open().catch(() => undefined);
        if (found) return found;
    }
    return asked === "none" ? undefined : (await import("./webgl2")).open();
}

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

/** Milliseconds after which somebody who switched something should see a picture. */
const SOON = 100;
/** How much smaller a coarse picture is. */
const COARSE = 4;
/** What the last whole picture took. */
let took = 0;

/** A picture on a canvas. Where whole ones take long, a coarse one comes first; it is marked. */
export async function shown(
    canvas: HTMLCanvasElement, request: Omit<PictureRequest, "target">, isOld: () => boolean,
): Promise<void> {
    if (took > SOON) {
        const [width, height] = [request.width, request.height].map((side) => Math.ceil(side / COARSE));
        show(canvas, await picture({ ...request, width, height }));
        canvas.dataset.coarse = "1";
        if (isOld()) return;
    }
    const start = performance.now();
    const whole = await picture(request);
    took = performance.now() - start;
    show(canvas, whole);
    delete canvas.dataset.coarse;
}

/** A fragment stage on a model, drawn by the page. `limit` is what the toolchain may take: nobody knows
 * how long a user's text takes. */
export function sketch(request: Omit<SketchRequest, "target">, limit: number): Promise<Pixels> {
    return queued(() => pictured((target) => toolchain.call(limit, "sketchStart", { ...request, target })));
}

/** A drawing of the page's own, in the device's language. `undefined` without a device. */
export function drawn(make: (target: string) => Promise<Drawing>): Promise<{ name: string; frames: Frames } | undefined> {
    return queued(async () => {
        const found = await device();
        return found && { name: found.name, frames: await framed(found, await make(found.target)) };
    });
}

async function framed(found: Device, drawing: Drawing): Promise<Frames> {
    return found.draw(drawing).catch((error) => {
        // Such as when a driver is updated. The next picture opens another device.
        if (found.isLost()) opening = undefined;
        throw error;
    });
}

async function pictured(start: (target: string) => Promise<Step>): Promise<Pixels> {
    const found = await device();
    if (!found) throw new Refused("This browser has neither WebGPU nor WebGL2: pictures cannot be drawn. Everything else works.");
    let step = await start(found.target);
    while (step.drawing) {
        const { words, depths } = await framed(found, step.drawing);
        step = await toolchain.call(OWN, "pictureFrames", words, depths);
    }
    if (!step.picture) throw new Refused(step.diagnostics[0]?.message ?? "there is no picture");
    return step.picture;
}

/** Puts a picture on a canvas. */
export function show(canvas: HTMLCanvasElement, { width, height, rgba }: Pixels) {
    canvas.width = width;
    canvas.height = height;
    const data = new ImageData(new Uint8ClampedArray(rgba), width, height);
    canvas.getContext("2d")?.putImageData(data, 0, 0);
}
