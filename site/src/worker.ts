// The toolchain, away from the page: whatever it is given, the page stays awake.
import { load, type Toolchain } from "@lamplight/toolchain";

type Call = { id: number; name: keyof Toolchain; inputs: unknown[] };

const loading = load();
loading.then(
    () => postMessage({ ready: true }),
    (error: unknown) => postMessage({ failed: String(error) }),
);

onmessage = async ({ data }: MessageEvent<Call>) => {
    const { id, name, inputs } = data;
    try {
        const call = (await loading)[name] as (...inputs: unknown[]) => unknown;
        const start = performance.now();
        const value = call(...inputs);
        postMessage({ id, value, milliseconds: performance.now() - start });
    } catch (error) {
        postMessage({ id, error: error instanceof Error ? error.message : String(error) });
    }
};
