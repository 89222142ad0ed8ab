import { OWN, toolchain } from "../client";
import { ROOT, h, reason, remember, route } from "../dom";
import { NO_DEVICE, device } from "../draw";
import { Card } from "../parts/card";
import { latest } from "../parts/latest";
import { COMPARED, GROUPS } from "../parts/titles";

/** How far the middle of an element is from the middle of the window, in pixels. */
function distance({ element }: Card): number {
    const { top, bottom } = element.getBoundingClientRect();
    return Math.abs((top + bottom - innerHeight) / 2);
}

/** What the user most likely looks at. */
const nearest = (some: Set<Card>): Card | undefined => [...some].sort((a, b) => distance(a) - distance(b))[0];

/** Where the build of the published site draws the large pictures. A quick build has none. */
const LARGE = import.meta.env.VITE_LARGE_PICTURES as string | undefined;

/** A part of the page that can be left out, with a heading. */
const part = (title: string, members: HTMLElement[], kind = "cards") =>
    h("section", { "aria-label": title }, h("h2", {}, title), h("div", { class: kind }, ...members));

/** Every published example, drawn where it is seen, and the comparisons. */
export async function page(into: HTMLElement): Promise<(() => void) | void> {
    const { presets } = await toolchain.call(OWN, "studio");
    const groups = GROUPS.map(({ title, presets: own }) => ({
        title, cards: own.flatMap(([name]) => presets.filter((preset) => preset.name === name)).map((preset) => new Card(preset)),
    }));
    const cards = groups.flatMap((group) => group.cards);
    const parts = groups.map(({ title, cards }) => ({ cards, section: part(title, cards.map(({ element }) => element)) }));
    const compared = COMPARED.map(([name, title]) => h("figure", { class: "strip" },
        h("img", { src: `${ROOT}pictures/compared-${name}.png`, alt: `Comparison: ${title}`, loading: "lazy" }), h("figcaption", {}, title)));
    const comparisons = part("Comparisons", compared, "strips");
    const count = h("p", { class: "note", role: "status" });
    const search = h("input", {
        type: "search", placeholder: "technique, book, axis", "aria-label": "Search the gallery", value: route().query.get("q") ?? "", oninput: () => filter(),
    });
    function filter() {
        const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
        remember(into, "gallery", "", { q: search.value.trim() });
        const fits = (text: string) => words.every((word) => text.includes(word));
        for (const { cards, section } of parts) {
            for (const card of cards) card.element.hidden = !fits(card.words);
            section.hidden = cards.every(({ element }) => element.hidden);
        }
        compared.forEach((figure) => { figure.hidden = !fits(figure.textContent!.toLowerCase()); });
        comparisons.hidden = compared.every((figure) => figure.hidden);
        const shown = cards.filter(({ element }) => !element.hidden).length;
        count.textContent = words.length ? `${shown} of ${cards.length} pictures` : "";
    }
    const links = parts.map(({ section }) => h("button", {
        type: "button", class: "small", onclick: () => section.scrollIntoView({ behavior: "smooth" }),
    }, section.getAttribute("aria-label")!));
    const large = LARGE ? [" ", h("a", { href: `${ROOT}${LARGE}`, target: "_self" }, "Large pictures, with the composed texts.")] : [];
    into.replaceChildren(h("h1", {}, "Gallery"),
        h("p", {}, "The examples that the library’s functions were published with, drawn by your browser. A click on a picture shows the values of that pixel, line by line.", ...large),
        search, count, h("div", { class: "row jumps" }, ...links), ...parts.map(({ section }) => section), comparisons);
    filter();
    if (!await device()) return count.before(h("p", { class: "note", role: "status" }, `${NO_DEVICE} These are stored ones.`));
    // One after another, from the middle of the window outwards, and only what is still in view.
    const waiting = new Set<Card>();
    const draw = latest(async () => {
        for (let card = nearest(waiting); card; card = nearest(waiting)) {
            waiting.delete(card);
            seen.unobserve(card.element);
            try {
                await card.draw();
            } catch (error) {
                card.element.prepend(h("p", { class: "wrong" }, reason(error)));
            }
        }
    });
    const byElement = new Map<Element, Card>(cards.map((card) => [card.element, card]));
    const seen = new IntersectionObserver((entries) => {
        for (const { isIntersecting, target } of entries) {
            if (isIntersecting) waiting.add(byElement.get(target)!);
            else waiting.delete(byElement.get(target)!);
        }
        draw();
    });
    cards.forEach(({ element }) => seen.observe(element));
    return () => {
        seen.disconnect();
        waiting.clear();
    };
}
