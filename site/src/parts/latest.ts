/** Runs a task; if it is asked for again meanwhile, once more afterwards. */
export function latest(run: () => Promise<void>): () => Promise<void> {
    let running: Promise<void> | undefined;
    let again = false;
    const begin = async () => {
        do {
            again = false;
            await run();
        } while (again);
    };
    return () => {
        again = true;
        running ??= begin().finally(() => { running = undefined; });
        return running;
    };
}
