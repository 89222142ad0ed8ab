// Every axis of a program as a control, with what it costs, in groups. What cannot be chosen next to the
// other values says why, and which other values it needs.
import type { AxisCost, Choice, CostInfo, Point, ProgramInfo } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { code, h, reason } from "../dom";

/** Axes by what they are about. Those of no group come last. */
const GROUPS: [title: string, axes: string[]][] = [
    ["Light", ["lights", "max_lights", "frequency", "attenuation", "cone", "area", "clustered", "profile"]],
    ["Surface", ["specular", "diffuse", "material", "metallic_roughness", "material_maps", "base_map", "normal_map", "two_sided", "alpha_test"]],
    ["Layers of glTF", ["clearcoat", "sheen", "iridescence", "anisotropy", "transmission", "volume", "dispersion", "diffuse_transmission"]],
    ["Shadow", ["shadow", "shadow_light", "cascades", "contact"]],
    ["Surroundings", ["ambient", "ambient_attenuated", "lightmap", "occlusion", "box_projection"]],
    ["Air and display", ["fog", "fog_sun", "curve"]],
];

/** So many axes need no groups. */
const FEW = 8;

/** How many points are looked at for a way to a value, and how many values may change on it. */
const [LOOKED, LONGEST] = [40, 3];

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

/** A value of an axis, as a person says it. */
const named = ({ axis, value }: Choice) => (value === true ? axis : value === false ? `no ${axis}` : `${axis} = ${value}`);

/** A valid point that has a value, and the other values that change on the way there. */
type Way = { key: string; changed: Choice[] };

/** The shortest way to a value: steps that each mend something which is broken. */
async function wayTo(program: string, wanted: Choice): Promise<Way | undefined> {
    let waiting: Way[] = [{ key: wanted.key, changed: [] }];
    const seen = new Set<string>();
    while (waiting.length && seen.size < LOOKED) {
        const way = waiting.shift()!;
        if (seen.has(way.key)) continue;
        seen.add(way.key);
        const { valid, key, broken, choices, settings } = await toolchain.call(OWN, "point", { program, key: way.key });
        if (valid) return { ...way, key };
        if (way.changed.length === LONGEST) continue;
        const isOpen = ({ axis, value, reasons }: Choice) => axis !== wanted.axis && !way.changed.some((one) => one.axis === axis)
            && String(settings[axis]) !== String(value) && broken.some((one) => !reasons.includes(one));
        const next = choices.filter(isOpen).sort((one, other) => one.reasons.length - other.reasons.length);
        waiting = [...waiting, ...next.map((choice) => ({ key: choice.key, changed: [...way.changed, choice] }))];
    }
    return undefined;
}

/** The values of an axis that need other ones, each with a button that sets them all. They are looked for
 * when somebody opens the list. */
function blocked(program: string, choices: Choice[], change: (key: string) => void): HTMLElement | undefined {
    const closed = choices.filter((choice) => choice.reasons.length);
    if (!closed.length) return undefined;
    const list = h("ul", {});
    const fill = async () => {
        if (list.childElementCount) return;
        for (const choice of closed) {
            const row = h("li", {}, h("strong", {}, String(choice.value)), `: ${choice.reasons[0]} `);
            list.append(row);
            try {
                const way = await wayTo(program, choice);
                row.append(way ? h("button", { type: "button", class: "small", onclick: () => change(way.key) }, `needs ${way.changed.map(named).join(", ")}: set`) : "");
            } catch (error) {
                row.append(reason(error));
            }
        }
    };
    const words = closed.length === 1 ? "1 value needs others" : `${closed.length} values need others`;
    return h("details", { class: "blocked", ontoggle: fill }, h("summary", {}, words), list);
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
    const control = (axis: ProgramInfo["axes"][number]) => {
        const choices = point.choices.filter((choice) => choice.axis === axis.name);
        const select = h("select", { "data-axis": axis.name, title: axis.doc, onchange: () => change(select.value) }, ...choices.map(option));
        const value = String(point.settings[axis.name]);
        const rows = costs.axes.filter((row) => row.axis === axis.name && row.value === value);
        const words = rows.length ? cost(rows) : value === String(axis.default) ? "" : "not measured";
        return h("div", {}, h("label", {}, h("span", {}, axis.name), select, words ? h("small", { class: "cost" }, words) : undefined),
            blocked(program.name, choices, change));
    };
    const of = (names: string[]) => names.flatMap((name) => program.axes.filter((axis) => axis.name === name));
    const known = new Set(GROUPS.flatMap(([, names]) => names));
    const others = program.axes.filter(({ name }) => !known.has(name));
    const groups = program.axes.length <= FEW ? [["Axes", program.axes] as const]
        : [...GROUPS.map(([title, names]) => [title, of(names)] as const), ["Others", others] as const];
    form.replaceChildren(...groups.filter(([, own]) => own.length).map(([title, own]) =>
        h("fieldset", {}, h("legend", {}, title), h("div", { class: "axes" }, ...own.map(control)))));
    if (focused) form.querySelector<HTMLElement>(`[data-axis="${focused}"]`)?.focus();
    if (point.valid) return;
    form.append(h("p", { class: "wrong" }, point.broken.join(" ")), code(point.key, "key"));
}
