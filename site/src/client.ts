// Calls of the toolchain: each has a limit, after which the worker is replaced.
import type { Toolchain } from "@lamplight/toolchain";

type Answer = { id?: number; value?: unknown; error?: string; milliseconds?: number; ready?: boolean; failed?: string };
type Call = { id: number; name: string; inputs: unknown[] };
type Waiting = { call: Call; resolve: (value: unknown) => void; reject: (error: Error) => void; start: () => void };

/** Milliseconds that a call about typed text may take before the toolchain is restarted. */
export const TYPED = 1000;
/** What the library's own programs may take: nobody typed them. */
export const OWN = 60000;

/** What the first answer may take: the browser compiles the toolchain while it runs. */
const COLD = 20000;

export class TooLong extends Error {}

export class Client {
    /** Milliseconds that the last answer took in the worker. */
    milliseconds = 0;
    /** Milliseconds of all answers. */
    spent = 0;
    /** How often the worker was replaced. */
    replaced = 0;
    #worker!: Worker;
    #ready = false;
    #warm = false;
    #next = 0;
    #waiting = new Map<number, Waiting>();

    constructor() {
        this.#begin();
    }

    #begin() {
        this.#ready = false;
        this.#warm = false;
        this.#worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
        this.#worker.onmessage = ({ data }: MessageEvent<Answer>) => this.#told(data);
        this.#worker.onerror = (event) => this.#drop(new Error(event.message || "the toolchain could not be loaded"));
    }

    #told(answer: Answer) {
        if (answer.ready) {
            this.#ready = true;
            this.#first()?.start();
        } else if (answer.failed !== undefined) {
            this.#drop(new Error(answer.failed));
        } else if (answer.id !== undefined) {
            const waiting = this.#waiting.get(answer.id);
            this.#waiting.delete(answer.id);
            this.#warm = true;
            // The worker takes one call after another, and the time of each is its own.
            this.#first()?.start();
            this.milliseconds = answer.milliseconds ?? 0;
            this.spent += this.milliseconds;
            if (answer.error === undefined) waiting?.resolve(answer.value);
            else waiting?.reject(new Error(answer.error));
        }
    }

    #first(): Waiting | undefined {
        return this.#waiting.values().next().value;
    }

    #drop(error: Error) {
        const waiting = [...this.#waiting.values()];
        this.#waiting.clear();
        for (const one of waiting) one.reject(error);
    }

    call<N extends keyof Toolchain>(
        limit: number, name: N, ...inputs: Parameters<Toolchain[N]>
    ): Promise<ReturnType<Toolchain[N]>> {
        const id = this.#next++;
        return new Promise((resolve, reject) => {
            let timer = 0;
            const done = <T>(then: (value: T) => void) => (value: T) => {
                clearTimeout(timer);
                then(value);
            };
            // Time runs once the toolchain is loaded.
            const start = () => {
                timer = window.setTimeout(() => {
                    this.#worker.terminate();
                    this.replaced++;
                    this.#waiting.delete(id);
                    waiting.reject(new TooLong(`no answer within ${limit / 1000} s: the toolchain was restarted`));
                    this.#begin();
                    for (const { call } of this.#waiting.values()) this.#worker.postMessage(call);
                }, this.#warm ? limit : Math.max(limit, COLD));
            };
            const call = { id, name, inputs };
            const waiting = { call, resolve: done(resolve as (value: unknown) => void), reject: done(reject), start };
            const isFirst = this.#waiting.size === 0;
            this.#waiting.set(id, waiting);
            if (this.#ready && isFirst) start();
            this.#worker.postMessage(call);
        });
    }
}

export const toolchain = new Client();
