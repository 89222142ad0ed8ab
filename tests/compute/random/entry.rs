//! Writes entry points: phases between barriers, which all invocations reach.

use super::body::Body;
use super::program::Draft;
use super::scope::Named;
use super::types::{BOOL, FLOAT, INT, Scalar, Ty, UINT};

/// The atomic variables of the storage buffer, each with the one function that changes it, so that
/// the order does not matter.
const ATOMICS: [(&str, &str, Scalar); 7] = [
    ("marks.sum", "atomicAdd", Scalar::Uint),
    ("marks.rest", "atomicSub", Scalar::Int),
    ("marks.low", "atomicMin", Scalar::Int),
    ("marks.high", "atomicMax", Scalar::Int),
    ("marks.top", "atomicMax", Scalar::Uint),
    ("marks.some", "atomicOr", Scalar::Uint),
    ("marks.odd", "atomicXor", Scalar::Uint),
];

impl Draft {
    /// Adds the variables of workgroups.
    fn shared(&mut self) -> Shared {
        let [x, y, z] = self.size;
        let count = x * y * z;
        let length = match self.random.below(3) {
            0 if y == 1 && z == 1 => "size_x".to_owned(),
            1 if y * z == 2 => "double_x".to_owned(),
            _ => format!("{count}"),
        };
        let types =
            [INT, UINT, FLOAT, Ty::Vector(3, Scalar::Int), Ty::Struct(0), Ty::array(INT, 3)];
        let element = self.random.pick(&types).clone();
        let spelt = element.spelt(&self.structs);
        self.add(&format!("var<workgroup> held: array<{spelt}, {length}>;"));
        self.add("var<workgroup> tally: array<atomic<u32>, double_x>;");
        self.add("var<workgroup> lowest: atomic<i32>;");
        let plan = self.random.pick(&types[..5]).clone();
        self.add(&format!("var<workgroup> plan: {};", plan.spelt(&self.structs)));
        Shared { element, plan, count }
    }

    pub fn entry(&mut self) {
        let shared = self.shared();
        let count = shared.count;
        let [groups_x, groups_y, _] = self.groups;
        let mut named = self.global.clone();
        named.push(Named::new("seed", UINT, false));
        // HLSL has no number of workgroups.
        let counts = !self.is_plain && self.random.chance(50);
        named.push(Named::new("index", UINT, false));
        for name in ["global", "local", "group"] {
            named.push(Named::new(name, Ty::Vector(3, Scalar::Uint), false));
        }
        if counts {
            named.push(Named::new("counts", Ty::Vector(3, Scalar::Uint), false));
        }
        named.push(Named::new("cells[place]", Ty::Struct(self.structs.len() - 3), true));
        let mut body = Body::new(&mut self.random, &self.structs, &self.functions, named);
        (body.calls, body.is_plain) = (6, self.is_plain);
        body.line(format!("let place = ((group.z * {groups_y}u + group.y) * {groups_x}u + group.x) * {count}u + index;"));
        body.line("var seed = place;");
        for _ in 0..3 {
            body.variable();
        }
        for _ in 0..2 + body.random.below(3) {
            phase(&mut body, &shared);
        }
        body.statements(3, 2);
        let lines = body.lines.join("\n");
        let more = if counts { ", @builtin(num_workgroups) counts: vec3u" } else { "" };
        let parameters = format!(
            "@builtin(local_invocation_index) index: u32, @builtin(workgroup_id) group: vec3u,\n    \
             @builtin(global_invocation_id) global: vec3u, \
             @builtin(local_invocation_id) local: vec3u{more}"
        );
        let size = &self.size_text;
        let head = format!("@compute @workgroup_size({size})\nfn main({parameters}) {{");
        self.add(&format!("{head}\n{lines}\n}}"));
    }
}

/// What the invocations of a workgroup share.
struct Shared {
    element: Ty,
    plan: Ty,
    count: u32,
}

/// Adds statements between barriers, which all invocations reach.
fn phase(body: &mut Body<'_>, shared: &Shared) {
    match body.random.below(7) {
        6 => pushed(body),
        0 => body.statements(4, 3),
        1 => plan(body, shared),
        2 => atomics(body),
        3 => {
            let name = body.name();
            let count = *body.random.pick(&["settings.count & 3u", "2u", "(double_x / size_x)"]);
            body.line(format!("for (var {name} = 0u; {name} < ({count}); {name}++) {{"));
            let known = body.named.len();
            body.named.push(Named::new(name, UINT, false));
            exchange(body, shared);
            body.named.truncate(known);
            body.line("}");
        }
        4 => {
            let condition = *body.random.pick(&[
                "is_on",
                "settings.count > 4u",
                "!is_on || settings.count < 9u",
            ]);
            body.line(format!("if {condition} {{"));
            let known = body.named.len();
            exchange(body, shared);
            body.named.truncate(known);
            body.line("}");
        }
        _ => exchange(body, shared),
    }
}

/// Every invocation writes its own element; then all read.
fn exchange(body: &mut Body<'_>, shared: &Shared) {
    let value = body.value(&shared.element, 2);
    body.line(format!("held[index] = {value};"));
    let counted = body.computed(&UINT, 1);
    let by = body.computed(&UINT, 0);
    let raised = match body.random.chance(50) {
        true => format!("atomicAdd(&tally[({counted}) % double_x], {by});"),
        false => format!("raise(&tally[({counted}) % double_x], {by});"),
    };
    body.line(raised);
    let low = body.computed(&INT, 1);
    body.line(format!("atomicMin(&lowest, {low});"));
    body.line("workgroupBarrier();");
    let known = body.named.len();
    body.named.push(Named::new("held", Ty::array(shared.element.clone(), shared.count), false));
    body.named.push(Named::new("atomicLoad(&tally[index % double_x])", UINT, false));
    body.named.push(Named::new("atomicLoad(&lowest)", INT, false));
    body.assigned();
    body.statements(3, 2);
    body.named.truncate(known);
    let barriers =
        *body.random.pick(&["workgroupBarrier();", "storageBarrier(); workgroupBarrier();"]);
    body.line(barriers);
}

/// One invocation writes a value that all read at once.
fn plan(body: &mut Body<'_>, shared: &Shared) {
    let value = body.value(&shared.plan, 2);
    let who = body.random.below(shared.count as usize);
    body.line(format!("if index == {who}u {{ plan = {value}; }}"));
    let name = body.name();
    body.line(format!("let {name} = workgroupUniformLoad(&plan);"));
    body.named.push(Named::new(name, shared.plan.clone(), false));
}

/// Functions on atomics of storage buffers, where not all invocations come.
fn atomics(body: &mut Body<'_>) {
    let condition = body.condition(1);
    body.line(format!("if {condition} {{"));
    let known = body.named.len();
    for _ in 0..1 + body.random.below(3) {
        if body.random.chance(40) {
            own_slot(body);
            continue;
        }
        let (at, fun, scalar) = *body.random.pick(&ATOMICS);
        if body.is_plain && scalar == Scalar::Int {
            continue;
        }
        let value = body.computed(&Ty::Scalar(scalar), 1);
        body.line(format!("{fun}(&{at}, {value});"));
    }
    body.named.truncate(known);
    body.line("}");
}

/// What an atomic function gives of an element that only one invocation changes.
fn own_slot(body: &mut Body<'_>) {
    let (a, b) = (body.computed(&UINT, 1), body.computed(&UINT, 0));
    let fun =
        *body.random.pick(&["atomicExchange", "atomicAdd", "atomicSub", "atomicXor", "atomicMax"]);
    let (value, ty) = match body.random.below(4) {
        0 => (format!("replace(&slots[place], atomicLoad(&slots[place]), {a})"), BOOL),
        1 => (format!("replace(&slots[place], {a}, {b})"), BOOL),
        // A weak exchange may fail for no reason, so the helper tries again.
        2 => (format!("replace(&slots[place], {b}, {a})"), BOOL),
        _ => (format!("{fun}(&slots[place], {a})"), UINT),
    };
    let name = body.name();
    body.line(format!("let {name} = {value};"));
    body.named.push(Named::new(name, ty, false));
}

/// A pointer to a structure of a buffer.
fn pushed(body: &mut Body<'_>) {
    let (by, name) = (body.computed(&UINT, 2), body.name());
    body.line(format!("let {name} = push(&cells[place], {by});"));
    body.named.push(Named::new(name, UINT, false));
}
