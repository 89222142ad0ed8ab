// The line of a text that a line of something made of it comes from.

const WORD = /[A-Za-z_]\w*|\d[\w.]*/g;

/** The share of words that two lines need to have in common. */
const ENOUGH = 0.3;

/** The number of the line that is most like another one, from 1; nothing if none is. Names of outputs end
 * with numbers or underscores that the author's do not have. */
export function nearest(text: string, line: string): number | undefined {
    const words = (one: string) => new Set((one.match(WORD) ?? []).map((word) => word.replace(/_\d*$/, "").replace(/([0-9])[fiu]$/, "$1")));
    const wanted = words(line);
    let [best, found]: [number, number | undefined] = [ENOUGH, undefined];
    text.split("\n").forEach((one, index) => {
        const own = words(one.replace(/\/\/.*/, ""));
        const both = [...own].filter((word) => wanted.has(word)).length;
        const share = both / Math.max(1, new Set([...own, ...wanted]).size);
        if (share > best) [best, found] = [share, index + 1];
    });
    return found;
}
