//! Environment maps of `render` that are too large, empty, or not files.

use super::Hostile;

fn header(size: &str) -> Vec<(&'static str, String)> {
    vec![("e.hdr", format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n"))]
}

const fn picture(name: &'static str, words: &'static str, arguments: &'static str) -> Hostile {
    Hostile { name, files: Vec::new, arguments, code: 1, words }
}

const fn sized(
    name: &'static str,
    words: &'static str,
    files: fn() -> Vec<(&'static str, String)>,
) -> Hostile {
    let arguments = "render hpg_4_spot --executor eval --size 4x4 -o out.png --environment e.hdr";
    Hostile { name, files, arguments, code: 1, words }
}

pub const CASES: &[Hostile] = &[
    sized("picture_of_ten_gigapixels", "pixels are more than", || header("-Y 100000 +X 100000")),
    sized("picture_of_the_largest_size", "too large", || header("-Y 4294967295 +X 4294967295")),
    // The size is near the limit, so the file is first decoded in a process of its own.
    sized("picture_without_pixels", "`e.hdr`", || header("-Y 4000 +X 4000")),
    picture(
        "picture_from_a_device",
        "is a pipe or a device",
        "render hpg_4_spot --executor eval --size 4x4 -o out.png --environment /dev/zero",
    ),
    Hostile {
        code: 2,
        ..picture(
            "exposure_not_a_number",
            "expected a number",
            "render hpg_4_spot --executor eval --size 4x4 -o out.png --exposure nan",
        )
    },
];
