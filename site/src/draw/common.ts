import type { Drawing } from "@lamplight/toolchain";

/** What a device drew: the words of each view's targets, and each view's depths. */
export type Frames = { words: Uint32Array; depths: Float32Array };

/** A device that draws what the toolchain asks for. */
export interface Device {
    name: string;
    /** The language of its shaders. */
    target: "wgsl" | "essl300";
    draw(drawing: Drawing): Promise<Frames>;
    isLost(): boolean;
}

/** Milliseconds since the page was opened: while drivers compiled shaders, and while they drew and
 * were read. Some compile only when they draw for the first time. */
export const spent = { compiling: 0, drawing: 0 };

/** A text that the browser refuses, with the line of it that the browser names. */
export class RefusedText extends Error {
    constructor(message: string, readonly line: string) {
        super(`the browser refuses the shader: ${message}`);
    }
}

/** What pixels hold that nothing covers. */
export const SENTINEL = 0xdeadbeef;

/** The buffer of a binding: the view's, the mesh's, or that of all. */
export function buffers(drawing: Drawing, view: number, mesh: number): Map<string, Uint8Array> {
    const all = [...drawing.buffers, ...drawing.meshes[mesh].buffers, ...drawing.views[view]];
    return new Map(all.map((one) => [`${one.group},${one.binding}`, one.bytes]));
}

export const floats = (bytes: Uint8Array) => new Float32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 4);

const number = new Float32Array(1);
const word = new Uint32Array(number.buffer);

/** A number as a half float: what is too large for one becomes infinite. */
export function half(value: number): number {
    number[0] = value;
    const bits = word[0];
    const sign = (bits >>> 16) & 0x8000;
    const exponent = ((bits >>> 23) & 0xff) - 112;
    const fraction = bits & 0x7fffff;
    if (exponent >= 31) return sign | 0x7c00;
    if (exponent <= 0) {
        if (exponent < -10) return sign;
        return sign | (((fraction | 0x800000) >>> (14 - exponent)) + 0);
    }
    return (sign | (exponent << 10) | (fraction >>> 13)) + ((fraction >>> 12) & 1);
}

/** Whether two arrays have the same bytes. */
export function same(one: Uint8Array, other: Uint8Array): boolean {
    if (one.length !== other.length) return false;
    const [a, b] = [one, other].map((bytes) => new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.length >> 2));
    return a.every((word, index) => word === b[index]);
}
