import { OWN, toolchain } from "../client";
import { h, reason } from "../dom";
import { NO_DEVICE, device, picture, show } from "../draw";
import { latest } from "../parts/latest";

/** How far the middle of an element is from the middle of the window, in pixels. */
function distance(element: Element): number {
    const { top, bottom } = element.getBoundingClientRect();
    return Math.abs((top + bottom - innerHeight) / 2);
}

/** What the user most likely looks at. */
const nearest = (some: Set<HTMLCanvasElement>): HTMLCanvasElement | undefined =>
    [...some].sort((a, b) => distance(a) - distance(b))[0];

/** Where the build of the published site draws the large pictures. A quick build has none. */
const LARGE = import.meta.env.VITE_LARGE_PICTURES as string | undefined;

/** Every published example, drawn where it is seen. */
export async function page(into: HTMLElement): Promise<(() => void) | void> {
    const { presets } = await toolchain.call(OWN, "studio");
    const cards = presets.map((preset) => {
        const canvas = h("canvas", { width: 192, height: 192, role: "img", "aria-label": preset.doc, "data-preset": preset.name });
        return h("article", { class: "card" },
            h("a", { href: `#/programs/${preset.program}?preset=${preset.name}`, "aria-label": preset.name }, canvas, h("h2", {}, preset.name)),
            h("p", {}, preset.doc), h("p", { class: "note" }, preset.source));
    });
    const large = LARGE ? [" ", h("a", { href: LARGE }, "Large pictures, with the composed texts.")] : [];
    const about = h("p", {}, "The examples that the library’s functions were published with, drawn by your browser.", ...large);
    into.replaceChildren(h("h1", {}, "Gallery"), about, h("div", { class: "cards" }, ...cards));
    if (!await device()) return into.querySelector(".cards")!.before(h("p", { class: "wrong", role: "status" }, NO_DEVICE));
    // One after another, from the middle of the window outwards, and only what is still in view.
    const waiting = new Set<HTMLCanvasElement>();
    const draw = latest(async () => {
        for (let canvas = nearest(waiting); canvas; canvas = nearest(waiting)) {
            waiting.delete(canvas);
            seen.unobserve(canvas);
            try {
                show(canvas, await picture({ preset: canvas.dataset.preset, width: 192, height: 192, samples: 4 }));
                canvas.dataset.drawn = "1";
            } catch (error) {
                canvas.replaceWith(h("p", { class: "wrong" }, reason(error)));
            }
        }
    });
    const seen = new IntersectionObserver((entries) => {
        for (const { isIntersecting, target } of entries) {
            if (isIntersecting) waiting.add(target as HTMLCanvasElement);
            else waiting.delete(target as HTMLCanvasElement);
        }
        draw();
    });
    into.querySelectorAll("canvas").forEach((canvas) => seen.observe(canvas));
    return () => {
        seen.disconnect();
        waiting.clear();
    };
}
