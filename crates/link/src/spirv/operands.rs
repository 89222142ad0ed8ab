//! The layout of each instruction's operands.

use lamplight_emit::spirv::SpirvInstruction;

/// Where an instruction may stand in a module.
#[derive(Clone, Copy, PartialEq)]
pub enum Section {
    /// Before the declarations: it says something about the module or about an id.
    Head,
    /// Among the declarations.
    Global,
    /// In a function.
    Body,
    /// Among the declarations or in a function.
    Either,
}
use Section::{Body, Either, Global, Head};

/// The section of an opcode and the layout of its operands: `i` an id, `r` the id that is defined,
/// `l` a literal, `s` a string, `I` ids to the end, `L` literals to the end, `P` pairs of a literal
/// and an id to the end, `m` image operands, and `a` a memory access.
fn operand_layout(op: u16) -> Option<(Section, &'static str)> {
    Some(match op {
        1 => (Either, "ir"),                   // Undef
        59 => (Either, "irlI"),                // Variable
        5 => (Head, "is"),                     // Name
        6 => (Head, "ils"),                    // MemberName
        10 => (Head, "s"),                     // Extension
        14 => (Head, "ll"),                    // MemoryModel
        15 => (Head, "lisI"),                  // EntryPoint
        17 => (Head, "l"),                     // Capability
        16 | 71 => (Head, "ilL"),              // ExecutionMode, Decorate
        72 => (Head, "illL"),                  // MemberDecorate
        11 => (Global, "rs"),                  // ExtInstImport
        19 | 20 | 26 => (Global, "r"),         // TypeVoid, TypeBool, TypeSampler
        21 => (Global, "rll"),                 // TypeInt
        22 => (Global, "rl"),                  // TypeFloat
        23 | 24 => (Global, "ril"),            // TypeVector, TypeMatrix
        25 => (Global, "rillllll"),            // TypeImage
        27 | 29 => (Global, "ri"),             // TypeSampledImage, TypeRuntimeArray
        28 => (Global, "rii"),                 // TypeArray
        30 => (Global, "rI"),                  // TypeStruct
        32 => (Global, "rli"),                 // TypePointer
        33 => (Global, "riI"),                 // TypeFunction
        41 | 42 | 46 => (Global, "ir"),        // ConstantTrue, ConstantFalse, ConstantNull
        43 => (Global, "irl"),                 // Constant, of 32 bits
        44 => (Global, "irI"),                 // ConstantComposite
        54 => (Body, "irli"),                  // Function
        55 => (Body, "ir"),                    // FunctionParameter
        12 => (Body, "irilI"),                 // ExtInst
        57 | 65 | 66 => (Body, "iriI"),        // FunctionCall, AccessChain, InBoundsAccessChain
        61 => (Body, "iria"),                  // Load
        62 => (Body, "iia"),                   // Store
        68 => (Body, "iril"),                  // ArrayLength
        79 | 82 => (Body, "iriiL"),            // VectorShuffle, CompositeInsert
        80 | 245 => (Body, "irI"),             // CompositeConstruct, Phi
        81 => (Body, "iriL"),                  // CompositeExtract
        87 | 88 | 95 | 98 => (Body, "iriim"), // ImageSample{Implicit,Explicit}Lod, ImageFetch, ImageRead
        89 | 90 | 96 | 97 => (Body, "iriiim"), // ImageSampleDref{Implicit,Explicit}Lod, ImageGather, ImageDrefGather
        99 => (Body, "iiim"),                  // ImageWrite
        201 => (Body, "iriiii"),               // BitFieldInsert
        246 => (Body, "iilL"),                 // LoopMerge
        247 => (Body, "il"),                   // SelectionMerge
        248 => (Body, "r"),                    // Label
        249 | 254 => (Body, "i"),              // Branch, ReturnValue
        250 => (Body, "iiiL"),                 // BranchConditional
        251 => (Body, "iiP"),                  // Switch, of 32 bits
        4450 | 4451 => (Body, "iriil"),        // SDot, UDot of packed bytes
        // FunctionEnd, Kill, Return, Unreachable, DemoteToHelperInvocation
        56 | 252 | 253 | 255 | 5380 => (Body, ""),
        // CopyObject, Transpose, Image, ImageQuerySize, ImageQueryLevels, ImageQuerySamples
        83 | 84 | 100 | 104 | 106 | 107 => (Body, "iri"),
        // conversions (ConvertFToU to QuantizeToF16), Bitcast, SNegate, FNegate, Any, All, IsNan,
        // IsInf, LogicalNot, Not, BitReverse, BitCount, derivatives (DPdx to FwidthCoarse)
        109..=116 | 124 | 126 | 127 | 154..=157 | 168 | 200 | 204 | 205 | 207..=215 => {
            (Body, "iri")
        }
        // VectorExtractDynamic, SampledImage, ImageQuerySizeLod, ImageQueryLod
        77 | 86 | 103 | 105 => (Body, "irii"),
        // arithmetic (IAdd to SMulExtended), LogicalEqual to LogicalAnd, comparisons (IEqual to
        // FUnordGreaterThanEqual), shifts, BitwiseOr, BitwiseXor, BitwiseAnd
        128..=152 | 164..=167 | 170..=191 | 194..=199 => (Body, "irii"),
        // VectorInsertDynamic, Select, BitFieldSExtract, BitFieldUExtract
        78 | 169 | 202 | 203 => (Body, "iriii"),
        224 => (Body, "iii"),                       // ControlBarrier
        225 => (Body, "ii"),                        // MemoryBarrier
        60 | 227 => (Body, "iriii"),                // ImageTexelPointer, AtomicLoad
        228 => (Body, "iiii"),                      // AtomicStore
        230 => (Body, "iriiiiii"),                  // AtomicCompareExchange
        229 | 234..=242 | 6035 => (Body, "iriiii"), // AtomicExchange, AtomicIAdd to AtomicXor, AtomicFAddEXT
        // GroupNonUniform: All, Any, BroadcastFirst, Ballot
        334 | 335 | 338 | 339 => (Body, "irii"),
        // GroupNonUniform: Shuffle, ShuffleXor, ShuffleUp, ShuffleDown, QuadBroadcast, QuadSwap
        345..=348 | 365 | 366 => (Body, "iriii"),
        349..=364 => (Body, "irili"), // GroupNonUniformIAdd to GroupNonUniformLogicalXor
        _ => return None,
    })
}

/// An instruction with the layout of its operands.
pub struct Inst<'a> {
    pub op: u16,
    pub section: Section,
    pub words: &'a [u32],
    layout: &'static str,
}

impl<'a> Inst<'a> {
    /// Looks the opcode up in the table. An unknown instruction is refused, since ids in it would
    /// not be renumbered.
    pub fn new(instruction: SpirvInstruction<'a>) -> Result<Self, String> {
        let SpirvInstruction { op, words } = instruction;
        let (section, layout) =
            operand_layout(op).ok_or_else(|| format!("opcode {op} is not known"))?;
        Ok(Self { op, section, words, layout })
    }

    /// The word at an index; the word at 0 has the opcode.
    pub fn word(&self, at: usize) -> Result<u32, String> {
        self.words.get(at).copied().ok_or_else(|| format!("opcode {} has too few words", self.op))
    }

    /// The id that the instruction defines, if any.
    pub fn result(&self) -> Option<u32> {
        let at = match self.layout.as_bytes() {
            [b'r', ..] => 1,
            [_, b'r', ..] => 2,
            _ => return None,
        };
        self.words.get(at).copied()
    }

    /// Calls back with each id and its index, the defined id included. Fails where the words do not
    /// fit the layout.
    pub fn ids(
        &self,
        mut show: impl FnMut(usize, u32) -> Result<(), String>,
    ) -> Result<(), String> {
        let mut at = 1;
        for kind in self.layout.bytes() {
            let rest = self.words.get(at..).unwrap_or_default();
            let (times, literals, ids) = match kind {
                b'I' => (1, 0, rest.len()),
                b'l' => (1, 1, 0),
                b'L' => (1, rest.len(), 0),
                b's' => (
                    1,
                    1 + rest.iter().take_while(|word| !word.to_le_bytes().contains(&0)).count(),
                    0,
                ),
                b'm' => (1, rest.len().min(1), rest.len().saturating_sub(1)),
                // Memory operands `Volatile`, `Aligned` and `Nontemporal` are known: the others
                // bring ids of scopes.
                b'a' if rest.first().is_some_and(|mask| mask & !7 != 0) => {
                    return Err("a memory access is not known".into());
                }
                b'a' => (1, rest.len(), 0),
                b'P' => (rest.len() / 2, 1, 1),
                _ => (1, 0, 1),
            };
            for _ in 0..times {
                at += literals;
                for _ in 0..ids {
                    show(at, self.word(at)?)?;
                    at += 1;
                }
            }
        }
        if at == self.words.len() {
            Ok(())
        } else {
            Err(format!("opcode {} has wrong operands", self.op))
        }
    }

    /// The string that starts at a word.
    pub fn string(&self, at: usize) -> Result<String, String> {
        let bytes = self.words.iter().skip(at).flat_map(|word| word.to_le_bytes());
        String::from_utf8(bytes.take_while(|&byte| byte != 0).collect())
            .map_err(|_| "a string is not UTF-8".into())
    }
}
