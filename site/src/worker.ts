// The toolchain, away from the page: whatever it is given, the page stays awake.
import { load, type Toolchain } from "@lamplight/toolchain";

type Call = { id: number; name: keyof Toolchain; inputs: unknown[] };

const loading = load();
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
