//! SPIR-V as words and instructions.

/// Words before the first instruction.
pub const HEADER_WORDS: usize = 5;

/// Opcodes that are treated by name.
pub mod op {
    pub const NAME: u16 = 5;
    pub const MEMBER_NAME: u16 = 6;
    pub const EXTENSION: u16 = 10;
    pub const IMPORT: u16 = 11;
    pub const MEMORY_MODEL: u16 = 14;
    pub const ENTRY_POINT: u16 = 15;
    pub const EXECUTION_MODE: u16 = 16;
    pub const CAPABILITY: u16 = 17;
    pub const TYPE_INT: u16 = 21;
    pub const TYPE_IMAGE: u16 = 25;
    pub const TYPE_ARRAY: u16 = 28;
    pub const TYPE_RUNTIME_ARRAY: u16 = 29;
    pub const TYPE_STRUCT: u16 = 30;
    pub const TYPE_POINTER: u16 = 32;
    pub const CONSTANT: u16 = 43;
    pub const CONSTANT_NULL: u16 = 46;
    pub const SPEC_CONSTANT_TRUE: u16 = 48;
    pub const SPEC_CONSTANT_FALSE: u16 = 49;
    pub const SPEC_CONSTANT: u16 = 50;
    pub const FUNCTION: u16 = 54;
    pub const FUNCTION_PARAMETER: u16 = 55;
    pub const FUNCTION_END: u16 = 56;
    pub const FUNCTION_CALL: u16 = 57;
    pub const VARIABLE: u16 = 59;
    pub const LOAD: u16 = 61;
    pub const STORE: u16 = 62;
    pub const ACCESS_CHAIN: u16 = 65;
    pub const DECORATE: u16 = 71;
    pub const MEMBER_DECORATE: u16 = 72;
    pub const COMPOSITE_CONSTRUCT: u16 = 80;
    pub const COMPOSITE_EXTRACT: u16 = 81;
    pub const COPY_OBJECT: u16 = 83;
    pub const IMAGE_WRITE: u16 = 99;
    pub const IMAGE_QUERY_SIZE_LOD: u16 = 103;
    pub const IMAGE_QUERY_SIZE: u16 = 104;

    /// Those that only debuggers read: `OpSourceContinued`, `OpSource`, `OpSourceExtension`,
    /// `OpName`, `OpMemberName`, `OpString`, `OpLine`, `OpNoLine` and `OpModuleProcessed`.
    pub const DEBUG: [u16; 9] = [2, 3, 4, NAME, MEMBER_NAME, 7, 8, 317, 330];
}

/// The words of a module's bytes, which are little-endian.
pub fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

/// The bytes of words.
pub fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// One instruction.
#[derive(Debug, Clone, Copy)]
pub struct SpirvInstruction<'a> {
    /// Its opcode.
    pub op: u16,
    /// All its words, the first of which holds its length and its opcode.
    pub words: &'a [u32],
}

/// The first instruction of words that have no header, and the words behind it.
///
/// # Errors
/// The words end within the instruction, or its length is zero.
#[inline]
pub fn split_first(words: &[u32]) -> Result<Option<(SpirvInstruction<'_>, &[u32])>, String> {
    let Some(&first) = words.first() else { return Ok(None) };
    match words.split_at_checked((first >> 16) as usize) {
        None => Err("an instruction is cut off".to_owned()),
        Some(([], _)) => Err("an instruction has no words".to_owned()),
        Some((words, rest)) => Ok(Some((SpirvInstruction { op: first as u16, words }, rest))),
    }
}

/// Every instruction of a module, up to one that is cut off.
pub fn instructions(module: &[u32]) -> impl Iterator<Item = SpirvInstruction<'_>> {
    let mut rest = module.get(HEADER_WORDS..).unwrap_or_default();
    std::iter::from_fn(move || {
        let (instruction, after) = split_first(rest).ok()??;
        rest = after;
        Some(instruction)
    })
}

/// The first word of an instruction with so many words.
pub fn first_word(op: u16, words: usize) -> u32 {
    (words as u32) << 16 | u32::from(op)
}

/// The string that words begin with. It ends with a zero byte.
pub fn string(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0);
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}
