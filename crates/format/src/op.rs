//! What a text is laid out from: tokens, blanks, and places where a line may or must end.

/// One step of a layout.
#[derive(Debug, Clone, Copy)]
pub enum Op {
    /// A token, by its index.
    Token(u32),
    /// A space.
    Space,
    /// The blanks that the author put before a comment at the end of a line, by its index.
    Gap(u32),
    /// A place where a line may end, or must.
    Break(Break),
    /// A place behind `=`, where a line ends if nothing else helps.
    Soft {
        is_forced: bool,
    },
    /// The end of a line between statements.
    Line(Line),
    Open(Group),
    Close,
}

/// A place where a line may end.
#[derive(Debug, Clone, Copy)]
pub struct Break {
    /// Whether a space stands there if the line does not end.
    pub is_spaced: bool,
    /// Whether the line ends in any case.
    pub is_forced: bool,
    /// Whether an empty line follows.
    pub is_empty: bool,
    /// Whether it is right behind the opening bracket of its list, or before the closing one.
    pub is_edge: bool,
    /// Where the next line begins.
    pub place: Place,
    /// Whether it begins in column 0 all the same.
    pub is_margin: bool,
}

/// Where a line begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Inside of the brackets of a list.
    Inner,
    /// Where the line of the opening bracket begins.
    Outer,
    /// Where the line of the element begins.
    Element,
    /// One level behind that, and more where operands of a lower precedence stand below each other.
    Chain,
    /// One level behind the element; none where it stands alone in its lines between brackets.
    Trail,
    /// At a level of blocks.
    Level(u16),
}

/// The end of a line between statements.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    pub level: u16,
    /// Whether the next line begins in column 0, whatever its level.
    pub is_margin: bool,
    /// Whether an empty line follows.
    pub is_empty: bool,
}

/// Places that end their lines together.
#[derive(Debug, Clone, Copy)]
pub struct Group {
    pub kind: GroupKind,
    /// Whether one of its own places must end its line. Then the others do only where the line
    /// would be too long.
    pub is_forced: bool,
    /// Whether it is filled: as many elements in a line as fit.
    pub is_filled: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GroupKind {
    /// A statement, or an element of a list.
    Element,
    /// Brackets with elements.
    List,
    /// The same, whose lines end only where they must.
    Rigid,
    /// Operands of operators of one precedence.
    Chain,
    /// A block in one line, or statements behind a label.
    Block,
}
