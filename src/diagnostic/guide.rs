//! Which page of the guide explains what a diagnostic is about.
//!
//! The pages are in `docs/guide/`. Messages name a page by its title, which a reader finds in the
//! book, on a forge and in a search.

use super::{Code, codes};

/// A page of the guide, with the codes that it explains.
#[derive(Debug)]
pub struct Page {
    pub title: &'static str,
    /// Name of its file, without the folder.
    pub file: &'static str,
    pub codes: &'static [&'static Code],
}

/// The page that explains a code. Every code has one.
pub fn page_of(code: &Code) -> Option<&'static Page> {
    PAGES.iter().find(|page| page.codes.contains(&code))
}

/// Pages with codes, in the order of the guide.
pub const PAGES: &[Page] = &[
    Page {
        title: "A package of your own",
        file: "package.md",
        codes: &[
            codes::CYCLIC_CONSTANT,
            codes::CYCLIC_IMPORT,
            codes::DUPLICATE_ITEM,
            codes::MISSING_ITEM,
            codes::MISSING_MODULE,
            codes::NAME_CONFLICT,
            codes::NO_ENTRY_POINT,
            codes::NON_UNIFORM_DERIVATIVE,
            codes::NOT_AN_ITEM,
            codes::NOT_UTF8,
            codes::OUTSIDE_ROOT,
            codes::SHADOWED_IMPORT,
            codes::SYNTAX_ERROR,
            codes::UNBALANCED_BRACKET,
            codes::UNKNOWN_ENTRY_POINT,
            codes::UNKNOWN_PACKAGE,
            codes::UNREADABLE,
            codes::UNTERMINATED_COMMENT,
            codes::UNUSED_IMPORT,
            codes::WESL_TOML,
            codes::WGSL_ERROR,
        ],
    },
    Page {
        title: "Axes, constraints and the manifest",
        file: "manifest.md",
        codes: &[
            codes::AXIS_LIMIT,
            codes::BAD_NAME,
            codes::CONSTRAINT_ALWAYS_FALSE,
            codes::CONSTRAINT_ALWAYS_TRUE,
            codes::CONSTRAINT_SYNTAX,
            codes::CONSTRAINT_TYPE,
            codes::DUPLICATE_VALUE,
            codes::DYNAMIC_AXIS,
            codes::EMPTY_SLICE,
            codes::INVALID_PERMUTATION,
            codes::KEY_SYNTAX,
            codes::LOCK_SYNTAX,
            codes::MACRO_COLLISION,
            codes::MANIFEST_SYNTAX,
            codes::MISSING_KEY,
            codes::MIXED_VALUES,
            codes::NO_PERMUTATION,
            codes::SPACE_TOO_COMPLEX,
            codes::TOO_MANY_PERMUTATIONS,
            codes::UNKNOWN_AXIS,
            codes::UNKNOWN_CLIP,
            codes::UNKNOWN_KEY,
            codes::UNKNOWN_PROGRAM,
            codes::UNKNOWN_TARGET,
            codes::UNKNOWN_VALUE,
            codes::UNREAD_AXIS,
            codes::USAGE_SYNTAX,
            codes::VALUE_NEVER_VALID,
            codes::WRONG_TYPE,
        ],
    },
    Page {
        title: "Conditions and constants",
        file: "conditions.md",
        codes: &[
            codes::CONDITION_SYNTAX,
            codes::CONSTANT_CONDITION,
            codes::DEPENDENT_OVERRIDE,
            codes::DISABLED_ITEM,
            codes::ILLEGAL_CONDITION,
            codes::UNDECLARED_FLAG,
            codes::UNKNOWN_FEATURE,
            codes::UNUSED_SETTING,
            codes::WRONG_KIND,
        ],
    },
    Page {
        title: "GLSL",
        file: "glsl.md",
        codes: &[
            codes::BAD_PASTE,
            codes::BAD_SETTING,
            codes::ERROR_DIRECTIVE,
            codes::GLSL_ERROR,
            codes::INCLUDE_CYCLE,
            codes::INVALID_CONDITION,
            codes::MACRO_ARGUMENTS,
            codes::MACRO_REDEFINED,
            codes::MALFORMED_DIRECTIVE,
            codes::MISPLACED_VERSION,
            codes::MISSING_INCLUDE,
            codes::RESERVED_MACRO,
            codes::UNBALANCED_CONDITIONAL,
            codes::UNDEFINED_MACRO,
            codes::UNKNOWN_STAGE,
        ],
    },
    Page {
        title: "Numeric cases",
        file: "cases.md",
        codes: &[
            codes::CASE_INVALID,
            codes::CASE_SYNTAX,
            codes::FIXTURE_MISMATCH,
            codes::UNKNOWN_FUNCTION,
            codes::UNTESTABLE_FUNCTION,
        ],
    },
    Page {
        title: "The report of a check",
        file: "report.md",
        codes: &[
            codes::EVAL_ARGUMENTS,
            codes::EVAL_INTERNAL,
            codes::EVAL_NEEDS_QUAD,
            codes::EVAL_UNBOUND,
            codes::EVAL_UNSUPPORTED,
            codes::EXECUTOR_FAILED,
            codes::EXECUTOR_LACKS,
        ],
    },
    Page { title: "Bundles", file: "bundles.md", codes: &[codes::BUNDLE_FAILED] },
    Page {
        title: "Conventions of each target",
        file: "targets.md",
        codes: &[codes::EMIT_FAILED, codes::OUTPUT_REFUSED],
    },
    Page {
        title: "Limits and what each protects",
        file: "limits.md",
        codes: &[
            codes::EVAL_LOOP_LIMIT,
            codes::EVAL_TOO_LARGE,
            codes::EXPANSION_TOO_LARGE,
            codes::FILE_TOO_LARGE,
            codes::INCLUDE_TOO_DEEP,
            codes::LIMIT_EXCEEDED,
            codes::NAGA_INTERNAL,
            codes::NESTING_TOO_DEEP,
            codes::NOT_SHOWN,
            codes::OUTPUT_TOO_LARGE,
            codes::TOO_MANY_FILES,
            codes::TOO_MANY_TOKENS,
        ],
    },
    Page {
        title: "Troubleshooting by diagnostic",
        file: "troubleshooting.md",
        codes: &[codes::DATA_SYNTAX, codes::PICTURE_INVALID],
    },
];
