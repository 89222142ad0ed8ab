// The files of the playground, and where they are kept: in the link and in the browser.
import { isFirstPage } from "../dom";
import { packed, unpacked } from "../pack";
import type { Look } from "./sketch";

export type Project = {
    files: Record<string, string>; open: string; target: string; expression: string; look: Look;
};

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
    return vec4f(vec3f(light * falloff(length(to_light))), 1.0);
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

/** A project, whatever a link has. */
function sound(found: unknown): Project {
    const given = (typeof found === "object" && found !== null ? found : {}) as Partial<Record<keyof Project, unknown>>;
    const files = Object.fromEntries(Object.entries(given.files ?? {}).filter(([, text]) => typeof text === "string"));
    const names = Object.keys(files);
    if (!names.length) return structuredClone(FIRST);
    const text = (key: "open" | "target" | "expression") => (typeof given[key] === "string" ? given[key] as string : FIRST[key]);
    const look = (typeof given.look === "object" && given.look !== null ? given.look : {}) as Look;
    const open = names.includes(text("open")) ? text("open") : names[0];
    return { files, open, target: text("target"), expression: text("expression"), look };
}

function parsed(text: string | null): Project | undefined {
    try {
        const found = JSON.parse(text ?? "");
        // Older versions kept the project with its address.
        return sound(found.project ?? found);
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

/** The project of the link; without a link, what was typed last. After a reload it is what was typed
 * in this tab, since the address may not have followed that yet. */
export async function opened(link: string | null): Promise<Project> {
    const again = isReload() ? parsed(stored(KEPT, TAB)) : undefined;
    if (again) return again;
    store(KEPT, null, TAB);
    const text = stored(KEPT, ALL);
    const kept = parsed(text);
    if (!link) return kept ?? structuredClone(FIRST);
    let project: Project;
    try {
        project = sound(JSON.parse(await unpacked(link)));
    } catch {
        // A link that was cut short opens what was typed last.
        return kept ?? structuredClone(FIRST);
    }
    if (text && JSON.stringify(kept) !== JSON.stringify(project)) keepEarlier(text);
    return project;
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
function keepEarlier(text: string) {
    const all = [text, ...earlierTexts().filter((one) => one !== text)].slice(0, MOST_EARLIER);
    // Without room for them, what was typed last is still there until somebody types again.
    store(EARLIER, JSON.stringify(all), ALL);
}

/** What was typed before links were opened, the latest first. */
export const earlier = (): Project[] =>
    earlierTexts().flatMap((text) => parsed(text) ?? []);

/** The project as a part of a link; nothing if it is too large for one. */
export async function linked(project: Project): Promise<string | undefined> {
    const text = await packed(JSON.stringify(project));
    return text.length > LONGEST ? undefined : text;
}
