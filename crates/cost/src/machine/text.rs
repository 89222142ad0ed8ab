//! Reads the disassembly: blocks of instructions, and the edges between them.

use std::collections::BTreeMap;

use super::{MachineError, repair};

/// An instruction: `v_add_f32_e32 v1, v2, v3`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Instruction {
    /// Without the suffix of its encoding: `v_add_f32`.
    pub name: String,
    pub operands: Vec<String>,
    /// How often it stands there in a row.
    pub times: i64,
}

/// An edge to another block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge {
    pub to: usize,
    /// The branch that is taken where no thread is active: it skips one side of an `if`.
    pub skips: bool,
}

/// Instructions that run one after the other.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Block {
    pub label: String,
    pub instructions: Vec<Instruction>,
    pub edges: Vec<Edge>,
}

/// A line of the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Line {
    Label(String),
    Instruction(Instruction),
    /// The instruction before stands there so many times more.
    Repeated(i64),
}

/// Suffixes of encodings, which change neither the unit nor the rate.
const ENCODINGS: [&str; 8] =
    ["_e64_dpp8", "_e64_dpp", "_dpp8", "_dpp", "_sdwa", "_e32", "_e64", "_vi"];

/// The blocks of a text, in its order. The first one is the entry.
pub fn parse_blocks(text: &str) -> Result<Vec<Block>, MachineError> {
    let lines = repair::readable_lines(text)?;
    if lines.is_empty() {
        return Err(MachineError::NoText);
    }
    let mut parts = split_blocks(lines);
    link_blocks(&mut parts)?;
    Ok(parts.blocks)
}

/// Reads an instruction without its comment.
pub fn parse_instruction(text: &str) -> Instruction {
    let text = text.trim();
    let (name, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let stem = ENCODINGS.iter().find_map(|encoding| name.strip_suffix(encoding));
    let operands = rest.split(',').map(|operand| operand.trim().to_owned());
    let operands = operands.filter(|operand| !operand.is_empty()).collect();
    Instruction { name: stem.unwrap_or(name).to_owned(), operands, times: 1 }
}

impl Instruction {
    /// Whether it ends a block.
    pub fn ends_block(&self) -> bool {
        self.is_end() || self.name == "s_branch" || self.is_conditional()
    }

    pub fn is_end(&self) -> bool {
        self.name.starts_with("s_endpgm")
    }

    pub fn is_conditional(&self) -> bool {
        self.name.starts_with("s_cbranch")
    }

    pub fn operand(&self, index: usize) -> &str {
        self.operands.get(index).map_or("", String::as_str)
    }
}

struct Parts {
    blocks: Vec<Block>,
    places: BTreeMap<String, usize>,
}

fn split_blocks(lines: Vec<Line>) -> Parts {
    let mut parts = Parts { blocks: vec![Block::default()], places: BTreeMap::new() };
    // Whether the block is complete. What then has no label is padding, or cannot be reached.
    let mut is_closed = false;
    for line in lines {
        let last = parts.blocks.len() - 1;
        match line {
            Line::Label(label) => {
                let is_empty = !is_closed && parts.blocks[last].instructions.is_empty();
                if !is_empty {
                    parts.blocks.push(Block::default());
                }
                is_closed = false;
                let place = parts.blocks.len() - 1;
                if parts.blocks[place].label.is_empty() {
                    parts.blocks[place].label.clone_from(&label);
                }
                parts.places.insert(label, place);
            }
            Line::Repeated(more) => {
                if let Some(instruction) = parts.blocks[last].instructions.last_mut() {
                    instruction.times += more;
                }
            }
            Line::Instruction(instruction) => {
                if is_closed {
                    if parts.blocks[last]
                        .instructions
                        .last()
                        .is_some_and(|last| last.is_end() || last.name == "s_branch")
                    {
                        continue;
                    }
                    parts.blocks.push(Block::default());
                }
                is_closed = instruction.ends_block();
                let place = parts.blocks.len() - 1;
                parts.blocks[place].instructions.push(instruction);
            }
        }
    }
    parts
}

fn link_blocks(parts: &mut Parts) -> Result<(), MachineError> {
    let count = parts.blocks.len();
    for index in 0..count {
        let last = parts.blocks[index].instructions.last();
        let next = (index + 1 < count).then_some(Edge { to: index + 1, skips: false });
        let target = |instruction: &Instruction| {
            let name = instruction.operand(0);
            let place = parts.places.get(name).copied();
            place.ok_or_else(|| MachineError::UnknownTarget(name.to_owned()))
        };
        let edges = match last {
            Some(last) if last.is_end() => Vec::new(),
            Some(last) if last.name == "s_branch" => {
                vec![Edge { to: target(last)?, skips: false }]
            }
            Some(last) if last.is_conditional() => {
                let skips = last.name == "s_cbranch_execz";
                let taken = Edge { to: target(last)?, skips };
                match decided_branch(&parts.blocks[index]) {
                    Some(true) => vec![taken],
                    Some(false) => next.into_iter().collect(),
                    None => std::iter::once(taken).chain(next).collect(),
                }
            }
            _ => next.into_iter().collect(),
        };
        parts.blocks[index].edges = edges;
    }
    Ok(())
}

/// Whether the branch at the end is always or never taken, since it compares two constants.
fn decided_branch(block: &Block) -> Option<bool> {
    let [.., compare, branch] = &block.instructions[..] else { return None };
    let wanted = match branch.name.as_str() {
        "s_cbranch_scc1" => true,
        "s_cbranch_scc0" => false,
        _ => return None,
    };
    let comparison = compare.name.strip_prefix("s_cmp_").and_then(Comparison::parse)?;
    let [left, right] = [0, 1].map(|index| constant_of(compare.operand(index)));
    Some(comparison.holds(left?, right?) == wanted)
}

/// An integer of an operand: an inline constant or a literal of 32 bits.
pub fn constant_of(operand: &str) -> Option<i64> {
    match operand.strip_prefix("0x") {
        Some(digits) => {
            let bits = u32::from_str_radix(digits, 16).ok()?;
            Some(i64::from(bits.cast_signed()))
        }
        None => operand.parse::<i32>().ok().map(i64::from),
    }
}

/// A comparison of integers, such as `ge_u32`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Comparison {
    relation: Relation,
    is_signed: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Relation {
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
}

impl Comparison {
    /// Reads what stands behind `s_cmp_` or `v_cmp_`.
    pub fn parse(name: &str) -> Option<Self> {
        let (relation, kind) = name.split_once('_')?;
        let relation = match relation {
            "eq" => Relation::Eq,
            "lg" | "ne" => Relation::Ne,
            "lt" => Relation::Lt,
            "le" => Relation::Le,
            "gt" => Relation::Gt,
            "ge" => Relation::Ge,
            _ => return None,
        };
        let is_signed = match kind {
            "i32" => true,
            "u32" => false,
            _ => return None,
        };
        Some(Self { relation, is_signed })
    }

    pub fn is_signed(self) -> bool {
        self.is_signed
    }

    pub fn holds(self, left: i64, right: i64) -> bool {
        let order = match self.is_signed {
            true => left.cmp(&right),
            // The low 32 bits, as unsigned numbers.
            false => (left as u32).cmp(&(right as u32)),
        };
        match self.relation {
            Relation::Eq => order.is_eq(),
            Relation::Ne => order.is_ne(),
            Relation::Lt => order.is_lt(),
            Relation::Le => order.is_le(),
            Relation::Gt => order.is_gt(),
            Relation::Ge => order.is_ge(),
        }
    }
}
