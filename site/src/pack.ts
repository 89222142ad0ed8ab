// State as text in a link, and files as a zip.
/** Bytes that are unpacked at a time. Each of them becomes at most 1,032, so the limit is noticed
 * before there is much more than it allows. */
const PIECE = 1024;

/** A text that unpacks to more than it may. */
export class TooLarge extends Error {}

/** Bytes in pieces, each of which is made when somebody wants it. */
function pieces(bytes: Uint8Array<ArrayBuffer>): ReadableStream<BufferSource> {
    let at = 0;
    return new ReadableStream<BufferSource>({
        pull(controller) {
            if (at >= bytes.length) return controller.close();
            controller.enqueue(bytes.slice(at, at + PIECE));
            at += PIECE;
        },
    }, { highWaterMark: 0 });
}

export async function packed(text: string): Promise<string> {
    const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""))
        .replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** The text, or an error if it is damaged or has more than `most` bytes. No more than that is unpacked. */
export async function unpacked(text: string, most: number): Promise<string> {
    const characters = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = new Uint8Array(characters.length);
    for (let at = 0; at < bytes.length; at++) bytes[at] = characters.charCodeAt(at);
    const reader = pieces(bytes).pipeThrough(new DecompressionStream("deflate-raw")).getReader();
    const decoder = new TextDecoder("utf-8", { fatal: true });
    const parts: string[] = [];
    let size = 0;
    for (let read = await reader.read(); !read.done; read = await reader.read()) {
        size += read.value.length;
        if (size > most) {
            // Whoever made it does not wait for the rest.
            reader.cancel().catch(() => {});
            throw new TooLarge(`it unpacks to more than ${most.toLocaleString("en")} bytes`);
        }
        parts.push(decoder.decode(read.value, { stream: true }));
    }
    parts.push(decoder.decode());
    return parts.join("");
}

function crc(bytes: Uint8Array): number {
    let value = ~0;
    for (const byte of bytes) {
        value ^= byte;
        for (let bit = 0; bit < 8; bit++) value = (value >>> 1) ^ (value & 1 ? 0xedb88320 : 0);
    }
    return ~value >>> 0;
}

/** Files as they are, one after another, as APPNOTE.TXT of PKWARE has it. */
export function zip(files: Record<string, string>): Blob {
    const encode = new TextEncoder();
    const parts: Uint8Array<ArrayBuffer>[] = [];
    const list: Uint8Array<ArrayBuffer>[] = [];
    let at = 0;
    for (const [path, text] of Object.entries(files)) {
        const [name, bytes] = [encode.encode(path), encode.encode(text)];
        const common = [20, 0x800, 0, 0, 0x21];
        const numbers = [crc(bytes), bytes.length, bytes.length];
        const head = record(0x04034b50, common, numbers, [name.length, 0]);
        list.push(record(0x02014b50, [20, ...common], numbers, [name.length, 0, 0, 0, 0], [0, at]), name);
        parts.push(head, name, bytes);
        at += head.length + name.length + bytes.length;
    }
    const size = list.reduce((sum, part) => sum + part.length, 0);
    const count = Object.keys(files).length;
    parts.push(...list, record(0x06054b50, [0, 0, count, count], [size, at], [0]));
    return new Blob(parts, { type: "application/zip" });
}

/** A signature, then numbers of 16 bits and of 32 bits in turn. */
function record(signature: number, ...numbers: number[][]): Uint8Array<ArrayBuffer> {
    const sizes = numbers.map((_, index) => (index % 2 ? 4 : 2));
    const length = 4 + numbers.reduce((sum, some, index) => sum + some.length * sizes[index], 0);
    const view = new DataView(new ArrayBuffer(length));
    view.setUint32(0, signature, true);
    let at = 4;
    numbers.forEach((some, index) => some.forEach((number) => {
        if (sizes[index] === 2) view.setUint16(at, number, true);
        else view.setUint32(at, number, true);
        at += sizes[index];
    }));
    return new Uint8Array(view.buffer);
}
