// What stands at the ends of lines while somebody goes through a run.
import type { PixelRun, RunEvent, RunMark, RunPlace, RunValue } from "@lamplight/toolchain";

/** What is known of a line at a moment of a run. */
export type Line = { values: RunValue[]; decided: string[]; marks: RunMark[] };

/** A moment of a run: the lines of each file, by their numbers, and where the run is. */
export type Moment = { files: Map<string, Map<number, Line>>; now?: RunPlace };

/** Numbers in a few digits, as there is room for at the end of a line. */
export const short = (text: string): string => text.split(" ").map((one) => {
    const number = Number(one);
    return /[.e]/.test(one) && Number.isFinite(number) ? String(Number(number.toPrecision(5))) : one;
}).join(" ");

/** The first words of what a mark says. */
export const headline = ({ text }: RunMark): string => text.split(":")[0];

/** The values of a line, and what it decided. */
export const parts = ({ values, decided }: Line): string[] =>
    [...values.map(({ name, text }) => `${name} ${short(text)}`), ...decided.map((one) => `→ ${one}`)];

/** A run up to one of its events. Each statement has the values that it gave last, and all of its marks. */
export function moment(run: PixelRun, last: number): Moment {
    const latest = new Map<number, RunEvent>();
    const marks = new Map<number, RunMark[]>();
    for (const event of run.events.slice(0, last + 1)) {
        if (event.place === undefined) continue;
        latest.set(event.place, event);
        if (event.marks.length) marks.set(event.place, [...marks.get(event.place) ?? [], ...event.marks]);
    }
    const files: Moment["files"] = new Map();
    for (const [number, event] of [...latest].sort(([one], [other]) => one - other)) {
        const { file, line } = run.places[number];
        const lines = files.get(file) ?? new Map<number, Line>();
        files.set(file, lines);
        const known = lines.get(line) ?? { values: [], decided: [], marks: [] };
        const isAgain = ({ name }: RunValue) => event.values.some((one) => one.name === name);
        lines.set(line, {
            values: [...known.values.filter((one) => !isAgain(one)), ...event.values], decided: [...known.decided, ...event.decided],
            marks: [...known.marks, ...marks.get(number) ?? []],
        });
    }
    const place = run.events[last]?.place;
    return { files, now: place === undefined ? undefined : run.places[place] };
}

const keyOf = (run: PixelRun, event: RunEvent): string => {
    const place = event.place === undefined ? undefined : run.places[event.place];
    return [event.kind, place?.file, place?.line, place?.text, event.turns].join(" ");
};

/** The event of another run that is the same part of the text in the same turn: after as many of its kind. */
export function counterpart(run: PixelRun, index: number, other: PixelRun): RunEvent | undefined {
    const key = keyOf(run, run.events[index]);
    const before = run.events.slice(0, index).filter((event) => keyOf(run, event) === key).length;
    return other.events.filter((event) => keyOf(other, event) === key)[before];
}
