// The files of the playground, and where they are kept: in the link and in the browser.
import { isFirstPage } from "../dom";
import { TooLarge, packed, unpacked } from "../pack";
import { LARGEST, type Project, WrongState, sound } from "./state";

export const FIRST: Project = {
    files: {
        "lit.wesl": `import lamplight::brdf::diffuse::lambert;
import lamplight::brdf::specular::blinn_phong;
import package::lamp::falloff;

@fragment
fn fs_main(@location(0) normal: vec3f, @location(1) to_light: vec3f) -> @location(0) vec4f {
    let n = normalize(normal);
    let l = normalize(to_light);
    let light = lambert(n, l) + blinn_phong(n, l, vec3f(0.0, 0.0, 1.0), 32.0);
    let warm = vec3f(1.0, 0.62, 0.32);
    return vec4f(8.0 * warm * light * falloff(length(to_light)), 1.0);
}
`,
        "lamp.wesl": `import lamplight::lighting::attenuation::inverse_square;

fn falloff(distance: f32) -> f32 {
    return inverse_square(distance * distance, 0.01);
}
`,
        "lit.frag.glsl": `#version 450
#include <lamplight/brdf/diffuse.glsl>

layout(location = 0) in vec3 normal;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(lambert(normalize(normal), vec3(0.0, 1.0, 0.0)));
}
`,
    },
    open: "lit.wesl", target: "wgsl", expression: "package::lamp::falloff(2.0)", look: {},
};

/** What somebody typed last, and what was there before links replaced it: the latest first. */
const [KEPT, EARLIER] = ["lamplight-playground", "lamplight-playground-earlier"];

/** How many projects are there from before a link. */
const MOST_EARLIER = 4;

/** Characters of a link that browsers and servers still take. */
const LONGEST = 60000;

/** Bytes of a state: a character has at most three, and quotation marks and line ends have two characters in
 * JSON. */
const MOST_BYTES = 3 * LARGEST;

/** What the browser kept; nothing if that is no project. Somebody's own files are not refused for what is
 * wrong beside them. */
function parsed(text: string | null): Project | undefined {
    if (text === null) return undefined;
    try {
        return sound(text, FIRST, false);
    } catch {
        return undefined;
    }
}

/** What the browser keeps of all tabs or of one; nothing where it keeps nothing. */
function stored(key: string, storage: () => Storage): string | null {
    try {
        return storage().getItem(key);
    } catch {
        return null;
    }
}

/** Puts a text into a storage, or takes it out. False if the browser has no room. */
function store(key: string, text: string | null, storage: () => Storage): boolean {
    try {
        if (text === null) storage().removeItem(key);
        else storage().setItem(key, text);
        return true;
    } catch {
        return false;
    }
}

const [ALL, TAB] = [() => localStorage, () => sessionStorage];

/** Keeps a project. False if the browser has no room. */
export function keep(project: Project): boolean {
    const text = JSON.stringify(project);
    store(KEPT, text, TAB);
    return store(KEPT, text, ALL);
}

/** Whether a reload of the page has just brought it here. */
function isReload(): boolean {
    const [entry] = performance.getEntriesByType("navigation") as PerformanceNavigationTiming[];
    return entry?.type === "reload" && isFirstPage();
}

/** A project to begin with, and why it is not that of the link. */
export type Opened = { project: Project; refused?: string };

/** The project of the link; without a link, what was typed last. After a reload it is what was typed
 * in this tab, since the address may not have followed that yet. */
export async function opened(link: string | null): Promise<Opened> {
    const again = isReload() ? parsed(stored(KEPT, TAB)) : undefined;
    if (again) return { project: again };
    store(KEPT, null, TAB);
    const text = stored(KEPT, ALL);
    const kept = parsed(text);
    if (!link) return { project: kept ?? structuredClone(FIRST) };
    let project: Project;
    try {
        project = sound(await unpacked(link, MOST_BYTES), FIRST);
    } catch (error) {
        const isWord = error instanceof WrongState || error instanceof TooLarge;
        const why = isWord ? error.message : "it is damaged, or was cut short";
        return { project: kept ?? structuredClone(FIRST), refused: `The project of the link cannot be opened: ${why}.` };
    }
    if (text && JSON.stringify(kept) !== JSON.stringify(project)) keepEarlier(text);
    return { project };
}

function earlierTexts(): string[] {
    const text = stored(EARLIER, ALL);
    try {
        const found: unknown = JSON.parse(text ?? "[]");
        // Older versions kept one project.
        return Array.isArray(found) ? found.filter((one) => typeof one === "string") : [text ?? ""];
    } catch {
        return [];
    }
}

/** The user's own files stay within reach, even if several links are opened and typed into. */
export function keepEarlier(text: string) {
    const all = [text, ...earlierTexts().filter((one) => one !== text)].slice(0, MOST_EARLIER);
    // Without room for them, what was typed last is still there until somebody types again.
    store(EARLIER, JSON.stringify(all), ALL);
}

/** What was typed before links were opened, the latest first. */
export const earlier = (): Project[] =>
    earlierTexts().flatMap((text) => parsed(text) ?? []);

/** The project as a part of a link; nothing if it is too large for one. */
export async function linked(project: Project): Promise<string | undefined> {
    const state = JSON.stringify(project);
    // Nothing is linked that the page would not open again.
    if (state.length > LARGEST) return undefined;
    const text = await packed(state);
    return text.length > LONGEST ? undefined : text;
}
