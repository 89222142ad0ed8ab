// Curves as SVG: f64, the values of a device in f32, and the band that WGSL's bounds allow.
import type { CurveResult, PlotInfo } from "@lamplight/toolchain";

const NS = "http://www.w3.org/2000/svg";
const [H, LEFT, BOTTOM, TOP, RIGHT] = [320, 56, 36, 12, 16];
/** Units across: as many as there are pixels, so that the letters stay readable on a phone. */
const [NARROW, WIDE] = [320, 640];

function s(tag: string, given: Record<string, string | number>, text?: string): SVGElement {
    const made = document.createElementNS(NS, tag);
    for (const [name, value] of Object.entries(given)) made.setAttribute(name, String(value));
    if (text) made.textContent = text;
    return made;
}

const short = (value: number) => String(Number(value.toPrecision(3)));

export const colour = (index: number) => `var(--curve-${index % 5})`;

export function plot(info: PlotInfo, found: CurveResult, at: number, device: number[][], pixels: number): SVGElement {
    const W = Math.round(Math.min(WIDE, Math.max(NARROW, pixels)));
    const values = found.curves.flatMap((curve) => curve.double).filter(Number.isFinite);
    const low = info.low ?? Math.min(0, ...values);
    const high = Math.max(info.high ?? Math.max(...values, low + 1e-6), low + 1e-9);
    const x = (value: number) => LEFT + ((value - info.from) / (info.to - info.from)) * (W - LEFT - RIGHT);
    const y = (value: number) => {
        const share = Math.min(1.2, Math.max(-0.2, (value - low) / (high - low)));
        return H - BOTTOM - share * (H - BOTTOM - TOP);
    };
    const svg = s("svg", { viewBox: `0 0 ${W} ${H}`, role: "img", "aria-label": `${info.value} over ${info.label}` });
    for (let tick = 0; tick <= 4; tick++) {
        const [vx, vy] = [info.from + (tick / 4) * (info.to - info.from), low + (tick / 4) * (high - low)];
        svg.append(
            s("line", { class: "grid", x1: LEFT, x2: W - RIGHT, y1: y(vy), y2: y(vy) }),
            s("text", { x: LEFT - 6, y: y(vy) + 4, "text-anchor": "end" }, short(vy)),
            s("text", { x: x(vx), y: H - 18, "text-anchor": "middle" }, short(vx) + (info.unit === "degrees" ? "°" : "")),
        );
    }
    svg.append(s("text", { x: (LEFT + W) / 2, y: H - 3, "text-anchor": "middle" }, info.label));
    found.curves.forEach((curve, index) => {
        const points = (of: (i: number) => number) => found.inputs.map((input, i) => `${x(input).toFixed(2)},${y(of(i)).toFixed(2)}`);
        const safe = (value: number) => (Number.isFinite(value) ? value : high - low);
        const band = [...points((i) => curve.double[i] + safe(curve.error[i])),
            ...points((i) => curve.double[i] - safe(curve.error[i])).reverse()];
        const own = colour(index);
        if (info.unit === "integers") {
            const aside = 4 * (index - (found.curves.length - 1) / 2);
            found.inputs.forEach((input, i) => {
                const [px, py] = [x(input) + aside, y(device[index][i])];
                svg.append(
                    s("line", { x1: px, x2: px, y1: y(Math.min(Math.max(0, low), high)), y2: py, stroke: own }),
                    s("circle", { cx: px, cy: py, r: 3, fill: own, class: "stem" }),
                );
            });
            return;
        }
        svg.append(
            s("polygon", { points: band.join(" "), fill: own, opacity: 0.18, class: "band" }),
            s("polyline", { points: points((i) => curve.double[i]).join(" "), stroke: own, class: "curve" }),
            s("polyline", { points: points((i) => device[index][i]).join(" "), class: "device" }),
        );
    });
    svg.append(s("line", { class: "at", x1: x(at), x2: x(at), y1: TOP, y2: H - BOTTOM }));
    return svg;
}
