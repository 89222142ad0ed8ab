/** Runs a task; if it is asked for again meanwhile, once more afterwards. The task can ask whether its
 * result is still wanted. */
export function latest(run: (isOld: () => boolean) => Promise<void>): () => Promise<void> {
    let running: Promise<void> | undefined;
    let again = false;
    const begin = async () => {
        try {
            do {
                again = false;
                await run(() => again);
            } while (again);
        } finally {
            // At once: somebody may ask before a promise could tell it.
            running = undefined;
        }
    };
    return () => {
        again = true;
        return running ??= begin();
    };
}
