// The toolchain, away from the page: whatever it is given, the page stays awake.
import { load, type Toolchain } from "@lamplight/toolchain";
import wasm from "../../target/toolchain/toolchain_bg.wasm?url";

type Call = { id: number; name: keyof Toolchain; inputs: unknown[] };

/** The packed toolchain, which is compiled while it arrives. Where the site is served while it is changed,
 * there is none. */
async function compiled(): Promise<WebAssembly.Module | undefined> {
    if (!import.meta.env.PROD) return undefined;
    const answer = await fetch(`${wasm}.packed`);
    if (!answer.ok || !answer.body) return undefined;
    const bytes = answer.body.pipeThrough(new DecompressionStream("gzip"));
    return WebAssembly.compileStreaming(new Response(bytes, { headers: { "Content-Type": "application/wasm" } }));
}

const loading = compiled().catch(() => undefined).then((module) => load(module));
loading.then(
    () => postMessage({ ready: true }),
    (error: unknown) => postMessage({ failed: error instanceof Error ? error.message : String(error) }),
);

onmessage = async ({ data }: MessageEvent<Call>) => {
    const { id, name, inputs } = data;
    // If it cannot be loaded, the page was notified already.
    const toolchain = await loading.catch(() => undefined);
    if (!toolchain) return;
    try {
        const call = toolchain[name] as (...inputs: unknown[]) => unknown;
        const start = performance.now();
        const value = call(...inputs);
        postMessage({ id, value, milliseconds: performance.now() - start });
    } catch (error) {
        const [reason, isReset] = error instanceof Error ? [error.message, error.name === "Stopped"] : [String(error), false];
        postMessage({ id, error: reason, isReset });
    }
};
