// Calls of the toolchain: each has a limit, after which the worker is replaced. Once the toolchain is
// loaded, every call ends: with an answer, or with an error that says why there is none.
import type { Toolchain } from "@lamplight/toolchain";

type Answer = {
    id?: number; value?: unknown; error?: string; milliseconds?: number; ready?: boolean; failed?: string;
    /** Whether the toolchain began anew in its worker, since a call was cut off. */
    isReset?: boolean;
};
type Call = { id: number; name: string; inputs: unknown[] };
type Waiting = { call: Call; resolve: (value: unknown) => void; reject: (error: Error) => void; start: () => void };

/** Milliseconds that a call may take. Somebody who types on need not wait for the old text: from `least`
 * on, the toolchain is restarted once the result is not wanted any more. */
export type Limit = { least: number; most: number; isOld: () => boolean };

/** For calls about typed text: nobody knows how long it takes. A busy machine has more time than a
 * second, as long as nobody types on. */
export const typed = (isOld: () => boolean): Limit => ({ least: 1000, most: 10000, isOld });
/** What the library's own programs may take: nobody typed them. */
export const OWN: Limit = { least: 60000, most: 60000, isOld: () => false };

/** What the first answer may take: the browser compiles the toolchain while it runs. */
const COLD = 20000;
/** How often a call is looked at that takes longer than it should. */
const LOOK = 50;

export class TooLong extends Error {}

export class Client {
    /** Milliseconds that the last answer took in the worker. */
    milliseconds = 0;
    /** Milliseconds of all answers. */
    spent = 0;
    /** How often the toolchain was begun anew. What it knew, such as a picture that it had begun, is lost. */
    replaced = 0;
    /** Called whenever the toolchain begins to load, and when it has loaded or cannot be loaded. */
    onLoading: (isLoading: boolean) => void = () => {};
    #worker?: Worker;
    #isReady = false;
    #isWarm = false;
    #next = 0;
    #waiting = new Map<number, Waiting>();

    #begin(): Worker {
        this.#isReady = false;
        this.#isWarm = false;
        const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
        const isCurrent = () => this.#worker === worker;
        worker.onmessage = ({ data }: MessageEvent<Answer>) => { if (isCurrent()) this.#receive(data); };
        worker.onmessageerror = () => { if (isCurrent()) this.#fail("an answer of the toolchain could not be read"); };
        worker.onerror = (event) => { if (isCurrent()) this.#fail(event.message || "the toolchain could not be loaded"); };
        this.#worker = worker;
        this.onLoading(true);
        return worker;
    }

    #receive(answer: Answer) {
        if (answer.ready) {
            this.#isReady = true;
            performance.mark("toolchain-ready");
            this.onLoading(false);
            this.#first()?.start();
        } else if (answer.failed !== undefined) {
            this.#fail(`the toolchain could not be loaded: ${answer.failed}`);
        } else if (answer.id !== undefined) {
            const waiting = this.#waiting.get(answer.id);
            this.#waiting.delete(answer.id);
            this.#isWarm = true;
            this.milliseconds = answer.milliseconds ?? 0;
            this.spent += this.milliseconds;
            if (answer.isReset) this.replaced++;
            // The worker takes one call after another, and the time of each is its own.
            this.#first()?.start();
            if (answer.error === undefined) waiting?.resolve(answer.value);
            else waiting?.reject(new Error(answer.error));
        }
    }

    #first(): Waiting | undefined {
        return this.#waiting.values().next().value;
    }

    /** Whoever waits gets an error. The next call begins with a new worker. */
    #fail(reason: string) {
        this.#worker?.terminate();
        this.#worker = undefined;
        this.onLoading(false);
        const waiting = [...this.#waiting.values()];
        this.#waiting.clear();
        for (const one of waiting) one.reject(new Error(reason));
    }

    /** A new worker gets the calls that wait. */
    #replace() {
        this.#worker?.terminate();
        this.replaced++;
        const worker = this.#begin();
        for (const { call } of this.#waiting.values()) worker.postMessage(call);
    }

    call<N extends keyof Toolchain>(
        { least, most, isOld }: Limit, name: N, ...inputs: Parameters<Toolchain[N]>
    ): Promise<ReturnType<Toolchain[N]>> {
        const id = this.#next++;
        const call = { id, name, inputs };
        return new Promise((resolve, reject) => {
            let [timer, begun] = [0, 0];
            const done = <T>(then: (value: T) => void) => (value: T) => {
                clearTimeout(timer);
                then(value);
            };
            // Time runs once the toolchain is loaded.
            const start = () => {
                begun = performance.now();
                const cold = this.#isWarm ? 0 : COLD;
                const late = () => {
                    const spent = performance.now() - begun;
                    const isOver = spent >= Math.max(most, cold) || (spent >= Math.max(least, cold) && isOld());
                    timer = window.setTimeout(isOver ? giveUp : late, LOOK);
                };
                timer = window.setTimeout(late, Math.max(least, cold));
            };
            // It comes after a last pause, since an answer may wait behind the page's own work.
            const giveUp = () => {
                this.#waiting.delete(id);
                this.#replace();
                waiting.reject(new TooLong(`no answer within ${Math.round((performance.now() - begun) / 1000)} s: the toolchain was restarted`));
            };
            const waiting = { call, resolve: done(resolve as (value: unknown) => void), reject: done(reject), start };
            const worker = this.#worker ?? this.#begin();
            worker.postMessage(call);
            const isFirst = this.#waiting.size === 0;
            this.#waiting.set(id, waiting);
            if (this.#isReady && isFirst) start();
        });
    }
}

export const toolchain = new Client();
