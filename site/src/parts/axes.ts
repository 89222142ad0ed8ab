// Every axis of a program as a control, with what it costs.
import type { AxisCost, Choice, CostInfo, Point, ProgramInfo } from "@lamplight/toolchain";
import { code, h } from "../dom";

const signed = (value: number) => (value > 0 ? `+${value}` : String(value).replace("-", "−"));

/** What a value costs against the default of its axis, in words. */
function cost(rows: AxisCost[]): string {
    const changed = rows.filter((row) => row.cycles.some((one) => one !== 0) || row.texture !== 0 || row.vgprs !== 0);
    if (!changed.length) return "costs nothing";
    return changed.map(({ stage, cycles: [least, median, most], texture, vgprs }) => {
        const spread = least === most ? "" : ` (${signed(least)} to ${signed(most)})`;
        return `${stage}: ${signed(median)} cycles${spread}${texture ? `, ${signed(texture)} texture reads` : ""}${vgprs ? `, ${signed(vgprs)} registers` : ""}`;
    }).join("; ");
}

/** What cannot be chosen next to the other values says why. */
export function axes(
    form: HTMLFormElement, program: ProgramInfo, point: Point, costs: CostInfo, change: (key: string) => void,
) {
    const focused = (document.activeElement as HTMLElement | null)?.dataset?.axis;
    const option = (choice: Choice) => h("option", {
        value: choice.key, disabled: choice.reasons.length > 0, title: choice.reasons.join(" ") || undefined,
        selected: String(point.settings[choice.axis]) === String(choice.value),
    }, choice.reasons.length ? `${choice.value} – ${choice.reasons[0]}` : String(choice.value));
    form.replaceChildren(...program.axes.map((axis) => {
        const choices = point.choices.filter((choice) => choice.axis === axis.name);
        const select = h("select", { "data-axis": axis.name, title: axis.doc, onchange: () => change(select.value) }, ...choices.map(option));
        const value = String(point.settings[axis.name]);
        const rows = costs.axes.filter((row) => row.axis === axis.name && row.value === value);
        const words = rows.length ? cost(rows) : value === String(axis.default) ? "" : "not measured";
        return h("label", {}, h("span", {}, axis.name), select, words ? h("small", { class: "cost" }, words) : undefined);
    }));
    if (focused) form.querySelector<HTMLElement>(`[data-axis="${focused}"]`)?.focus();
    if (point.valid) return;
    form.append(h("p", { class: "wrong" }, point.broken.join(" ")), code(point.key, "key"));
}
