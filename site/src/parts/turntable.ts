// The picture of the first page: a stored one at first, then a live one that can be turned.
import { h, reason } from "../dom";
import { Screen, device, picture } from "../draw";
import { latest } from "./latest";

/** Pixels of the live picture: as many as a device draws at once. */
const [WIDTH, HEIGHT] = [640, 480];

/** Keys that turn the picture, by radians. */
const TURNS: Record<string, [number, number]> = {
    ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.05], ArrowDown: [0, -0.05],
};

/** How far the viewer can go up and down without leaving the room. */
const [LOWEST, HIGHEST] = [-0.35, 0.7];

/** Milliseconds after the first page is shown until the toolchain is asked for: what one reads comes first. */
const SETTLED = 300;

/** Makes the stored picture of a place live. Returns what ends it. */
export function turntable(place: HTMLElement): () => void {
    const stored = place.querySelector("img")!;
    const note = place.querySelector(".note")!;
    const canvas = h("canvas", {
        width: WIDTH, height: HEIGHT, role: "img", tabindex: "0", hidden: true,
        "aria-label": `${stored.alt}. Dragging or the arrow keys turn it.`,
    });
    stored.after(canvas);
    const screen = new Screen(canvas);
    const turn: [number, number] = [0, 0];
    const draw = latest(async (isOld) => {
        if (!place.isConnected) return;
        const samples = (factor: number) => (factor === 1 ? 4 : 1);
        const take = (factor: number) => picture({
            preset: "tech_chess", width: WIDTH / factor, height: HEIGHT / factor, samples: samples(factor), turn,
        });
        try {
            await screen.show(take, isOld);
            stored.hidden = true;
            canvas.hidden = false;
            canvas.dataset.drawn = String(Number(canvas.dataset.drawn ?? 0) + 1);
            note.textContent = `Drawn live, on ${(await device())!.name}. Drag to walk around it.`;
        } catch (error) {
            note.textContent = reason(error);
        }
    });
    const walk = (across: number, up: number) => {
        turn[0] += across;
        turn[1] = Math.min(HIGHEST, Math.max(LOWEST, turn[1] + up));
        draw();
    };
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
        if (event.buttons) walk(-event.movementX / 150, event.movementY / 200);
    });
    canvas.addEventListener("keydown", (event) => {
        const step = TURNS[event.key];
        if (!step) return;
        event.preventDefault();
        walk(...step);
    });
    const timer = setTimeout(async () => {
        if (await device()) return draw();
        note.textContent = "A stored picture: this browser has neither WebGPU nor WebGL2.";
    }, SETTLED);
    return () => clearTimeout(timer);
}
