import { OWN, toolchain } from "../client";
import { h } from "../dom";
import { picture, show } from "../draw";

/** Every published example, drawn where it is seen. */
export async function page(into: HTMLElement) {
    const { presets } = await toolchain.call(OWN, "studio");
    const cards = presets.map((preset) => {
        const canvas = h("canvas", { width: 192, height: 192, role: "img", "aria-label": preset.doc, "data-preset": preset.name });
        return h("article", { class: "card" },
            h("a", { href: `#/programs/${preset.program}?preset=${preset.name}` }, canvas, h("h2", {}, preset.name)),
            h("p", {}, preset.doc), h("p", { class: "note" }, preset.source));
    });
    into.replaceChildren(h("h1", {}, "Gallery"),
        h("p", {}, "The examples that the library’s functions were published with, drawn by your browser."),
        h("div", { class: "cards" }, ...cards));
    const seen = new IntersectionObserver((entries) => {
        for (const { isIntersecting, target } of entries) {
            if (!isIntersecting) continue;
            seen.unobserve(target);
            const canvas = target as HTMLCanvasElement;
            picture({ preset: canvas.dataset.preset, width: 192, height: 192, samples: 4 }).then(
                (pixels) => { show(canvas, pixels); canvas.dataset.drawn = "1"; },
                (error: Error) => { canvas.replaceWith(h("p", { class: "wrong" }, error.message)); },
            );
        }
    });
    into.querySelectorAll("canvas").forEach((canvas) => seen.observe(canvas));
    return () => seen.disconnect();
}
