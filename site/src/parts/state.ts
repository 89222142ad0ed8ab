// What the state of a link or of the browser must be, before anything of it is used.
import { repeated } from "../dom";
import type { Look } from "./sketch";

export type Project = {
    files: Record<string, string>; open: string; target: string; expression: string; look: Look;
};

/** Letters of all files: with more, the page would stand still for a second while it keeps them. */
export const LARGEST = 4 << 20;

/** Files of a project: each is a tab. */
const MOST_FILES = 500;

/** Names that the toolchain and a zip take. */
export const NAME = /^(?!\/)(?!.*\.\.)[\w./-]+$/;
const LONGEST_NAME = 200;

/** A state that is no project; it says why. */
export class WrongState extends Error {}

/** What a value must be, in words, and whether it is that. */
type Kind = { words: string; is: (value: unknown) => boolean };

const isNumber = (value: unknown) => typeof value === "number" && Number.isFinite(value);
const isTable = (value: unknown): value is Record<string, unknown> =>
    typeof value === "object" && value !== null && !Array.isArray(value);
const numbers = (value: unknown, count?: number) =>
    Array.isArray(value) && value.every(isNumber) && (count === undefined || value.length === count);

const TEXT: Kind = { words: "a text", is: (value) => typeof value === "string" };
const TABLE: Kind = { words: "a table", is: isTable };
const list = (count: number): Kind => ({ words: `a list of ${count} numbers`, is: (value) => numbers(value, count) });
const tableOf = (words: string, is: Kind["is"]): Kind =>
    ({ words: `a table of ${words}`, is: (value) => isTable(value) && Object.values(value).every(is) });

const LOOK: Record<keyof Look, Kind> = {
    model: TEXT, turn: list(2), lamp: list(3), exposure: { words: "a number", is: isNumber },
    inputs: tableOf("texts", TEXT.is), textures: tableOf("texts", TEXT.is), uniforms: tableOf("lists of numbers", (value) => numbers(value)),
};

const PROJECT: Record<keyof Project, Kind> = {
    files: tableOf("texts", TEXT.is), open: TEXT, target: TEXT, expression: TEXT, look: TABLE,
};

/** The members of a table that have a kind. What is absent stays absent, and what is unknown is left out:
 * a newer version may have made it. What is wrong is refused, or else left out too. */
function members<T>(
    table: Record<string, unknown>, kinds: Record<keyof T & string, Kind>, before: string, isStrict: boolean,
): Partial<T> {
    const found: Record<string, unknown> = {};
    for (const [name, kind] of Object.entries<Kind>(kinds)) {
        if (!Object.hasOwn(table, name)) continue;
        if (kind.is(table[name])) found[name] = table[name];
        else if (isStrict) throw new WrongState(`its ${before}${name} is not ${kind.words}`);
    }
    return found as Partial<T>;
}

function checked(files: Record<string, string>) {
    const names = Object.keys(files);
    if (names.length > MOST_FILES) throw new WrongState(`it has more than ${MOST_FILES} files`);
    const wrong = names.find((name) => !NAME.test(name) || name.length > LONGEST_NAME);
    if (wrong !== undefined) throw new WrongState(`a file cannot be named "${repeated(wrong)}"`);
    const length = names.reduce((sum, name) => sum + files[name].length, 0);
    if (length > LARGEST) throw new WrongState(`its files have more than ${LARGEST.toLocaleString("en")} characters in total`);
}

/** A project, completed with what `base` has; or an error that says what is wrong. Without `isStrict`,
 * only its files must be there. */
export function sound(text: string, base: Project, isStrict = true): Project {
    let found: unknown;
    try {
        found = JSON.parse(text);
    } catch {
        throw new WrongState("it is not JSON");
    }
    if (!isTable(found)) throw new WrongState("it is not a table");
    // Older versions kept the project with its address.
    const table = Object.hasOwn(found, "project") && isTable(found.project) ? found.project : found;
    const given = members<Project>(table, PROJECT, "", isStrict);
    if (!given.files || !Object.keys(given.files).length) throw new WrongState("it has no files");
    if (isStrict) checked(given.files);
    const look = members<Look>((given.look ?? {}) as Record<string, unknown>, LOOK, "look.", isStrict);
    const names = Object.keys(given.files);
    const open = given.open !== undefined && Object.hasOwn(given.files, given.open) ? given.open : names[0];
    // That of the base may call a function of its files.
    const { files, target = base.target, expression = "1.0" } = given;
    return { files, open, target, expression, look };
}
