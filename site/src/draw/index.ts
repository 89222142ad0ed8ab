import type { PictureRequest, Pixels } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { type Device } from "./common";

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

/** A picture, drawn by the page. Pictures wait for each other. */
export function picture(request: Omit<PictureRequest, "target">): Promise<Pixels> {
    const next = last.then(() => drawn(request), () => drawn(request));
    last = next;
    return next;
}

async function drawn(request: Omit<PictureRequest, "target">): Promise<Pixels> {
    const found = await device();
    if (!found) throw new Refused("This browser has neither WebGPU nor WebGL2: pictures cannot be drawn. Everything else works.");
    let step = await toolchain.call(OWN, "pictureStart", { ...request, target: found.target });
    while (step.drawing) {
        const { words, depths } = await found.draw(step.drawing);
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
