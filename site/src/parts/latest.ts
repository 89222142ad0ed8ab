/** Runs a task; if it is asked for again meanwhile, once more afterwards. The task can ask whether its
 * result is still wanted. */
export function latest(run: (isOld: () => boolean) => Promise<void>): () => Promise<void> {
    let running: Promise<void> | undefined;
    let again = false;
    const begin = async () => {
        do {
            again = false;
            await run(() => again);
        } while (again);
    };
    return () => {
        again = true;
        running ??= begin().finally(() => { running = undefined; });
        return running;
    };
}
