// Two texts, line by line, with what only one of them has.
import { diffLines } from "diff";
import { h, scrolled } from "../dom";

/** Lines around a difference that are shown too. */
const AROUND = 3;
/** Milliseconds after which texts are too different to compare. */
const LONGEST = 1000;

/** How `after` differs from `before`. The signs at the starts of lines say it without colours. */
export function differences(before: string, after: string, label: string): HTMLElement {
    const found = diffLines(before, after, { timeout: LONGEST });
    if (!found) return h("p", { class: "note" }, `${label}: the texts differ almost everywhere.`);
    const count = (which: "added" | "removed") =>
        found.filter((one) => one[which]).reduce((sum, one) => sum + one.count, 0);
    const [added, removed] = [count("added"), count("removed")];
    if (!added && !removed) return h("p", { class: "note" }, `${label}: no difference.`);
    const pre = scrolled(`Differences of ${label}`);
    pre.classList.add("differences");
    found.forEach((part, index) => {
        const lines = part.value.replace(/\n$/, "").split("\n");
        if (part.added) pre.append(h("ins", {}, lines.map((line) => `+ ${line}\n`).join("")));
        else if (part.removed) pre.append(h("del", {}, lines.map((line) => `- ${line}\n`).join("")));
        else pre.append(shortened(lines, index > 0, index < found.length - 1));
    });
    return h("div", {}, h("p", { class: "note" }, `${label}: ${added} lines added, ${removed} removed.`), pre);
}

function shortened(lines: string[], after: boolean, before: boolean): string {
    const [head, tail] = [after ? AROUND : 0, before ? AROUND : 0];
    const same = (some: string[]) => some.map((line) => `  ${line}\n`).join("");
    if (lines.length <= head + tail + 1) return same(lines);
    const left = lines.length - head - tail;
    return `${same(lines.slice(0, head))}  … ${left} equal lines\n${same(tail ? lines.slice(-tail) : [])}`;
}
