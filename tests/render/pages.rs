//! The gallery's pages, and pictures without a driver.

use std::path::Path;

use lamplight::bundle::Language;
use lamplight::diagnostic::Diagnostics;
use lamplight::picture::{Picture, gallery, is_own_png, render_plan, strip};
use lamplight::scene::Equirect;
use lamplight::source::SourceSet;
use libtest_mimic::{Failed, Trial};

use super::difference::{Difference, is_recorded};
use super::{library, on_device, plan, read, reviewed_path, said, shot, start};

/// Presets that the evaluator draws too. They have shading at vertices and at fragments, textures,
/// cube maps, flat and cube shadow maps, blurred moments, and surfaces with two sides.
const DRAWN: &[&str] = &[
    "hpg_1_vertex",
    "hpg_5_shadow",
    "hpg_7_vsm",
    "igl_2_cube",
    "ncl_11_flat",
    "ncl_11_lightmap",
    "oglpg_7_11",
    "oglpg_7_13",
];

pub fn tests() -> Vec<Trial> {
    let drawn = DRAWN
        .iter()
        .map(|name| Trial::test(format!("render/{name}/eval"), move || without_driver(name)));
    let others = [
        Trial::test("render/gallery_is_current", gallery_is_current),
        Trial::test("render/png_round_trip", png_round_trip),
        Trial::test("render/radiance_file", radiance_file),
        Trial::test("render/a_difference_is_seen", difference_is_seen),
    ];
    drawn.chain(others).collect()
}

/// The evaluator's picture looks like Vulkan's.
fn without_driver(name: &str) -> Result<(), Failed> {
    let preset =
        library().presets.iter().find(|preset| preset.name == name).ok_or("no such preset")?;
    on_device("vulkan", |vulkan| {
        let (plan, shot) = (plan(preset)?, shot([64, 64], 1, Language::Wesl));
        let wanted = render_plan(vulkan, &library().programs, &plan, &shot).map_err(said)?;
        let found = render_plan(start("eval")?.as_ref(), &library().programs, &plan, &shot)
            .map_err(said)?;
        let difference = Difference::new(&wanted, &found)?;
        let (mean, most) = (difference.mean(), difference.most());
        // There is one sample for each pixel, so a pixel at an edge may belong to either side.
        if mean < 0.3 && most < 8.0 {
            Ok(())
        } else {
            let found = format!("{mean:.2} on average, {most:.1} for all but 1 %");
            Err(format!("the pictures differ by {found}, expected below 0.3 and 8"))
        }
    })
}

/// The folder of the large pictures.
const GALLERY: &str = "docs/gallery";
/// The smaller form of a large picture is three times as wide as the reviewed picture.
const TIMES: u32 = 3;
/// The largest mean distance, and the largest distance of 99 % of the pixels. They are larger than
/// for reviewed pictures, since large pictures have finer edges and some have finer shadows.
const FINER: (f64, f64) = (2.0, 14.0);
/// A picture with bounds of its own: its bricks are smooth to their edges, so that highlights are
/// smaller than a pixel of the small picture.
const HARD: [(&str, (f64, f64)); 1] = [("tech_gltf_maps", (4.0, 16.0))];

/// The gallery is current: its pages have the presets and their composed texts, and every large
/// picture was drawn from the present settings and texts and looks like the reviewed small one.
/// `INSTA_UPDATE=always` writes the pages, but no picture.
fn gallery_is_current() -> Result<(), Failed> {
    let cards = library()
        .presets
        .iter()
        .map(|preset| gallery::Card::new(&library().programs, preset, Language::Wesl));
    let cards: Vec<gallery::Card> = cards.collect::<Result<_, _>>().map_err(said)?;
    let cards: Vec<&gallery::Card> = cards.iter().collect();
    let strips = library().programs.with_texts(comparisons).map_err(said)?;
    let strips = strips
        .into_iter()
        .map(|one| gallery::StripCard::new(&library().programs, one, Language::Wesl));
    let strips: Vec<gallery::StripCard> = strips.collect::<Result<_, _>>().map_err(said)?;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(GALLERY);
    let mut files = gallery::composed(&cards);
    files.push(("README.md".to_owned(), gallery::markdown_page(&cards, &strips)));
    files.push(("index.html".to_owned(), gallery::html_page(&cards, &strips)));
    let mut stale = unlinked_texts(&folder, &files)?;
    for (path, wanted) in files {
        let found = std::fs::read_to_string(folder.join(&path)).unwrap_or_default();
        if found != wanted && is_recorded() {
            lamplight::output::write(&folder.join(&path), wanted.as_bytes())?;
        } else if found != wanted {
            stale.push(format!("{path} should have another text"));
        }
    }
    let adapters = std::fs::read_to_string(folder.join("adapters.txt"))?;
    let shot = shot(gallery::SIZE, gallery::SAMPLES, Language::Wesl);
    for card in cards {
        let (name, current) = (&card.preset.name, card.current(&shot));
        if !adapters.lines().any(|line| line.starts_with(&current)) {
            stale.push(format!("{name}.png was drawn from other settings or texts"));
        }
        match folder.join(format!("{name}.png")).exists() {
            true => stale.extend(changed(&folder, name)?),
            false => stale.push(format!("{name}.png is not there")),
        }
    }
    for card in &strips {
        if !adapters.lines().any(|line| line.starts_with(&card.current(&shot))) {
            stale.push(format!("{} was drawn from other settings or texts", card.comparison.name));
        }
        read(&folder.join(gallery::strip_file(&card.comparison.name)))?;
    }
    if stale.is_empty() {
        return Ok(());
    }
    let command = "lamplight render --all --force -o docs/gallery";
    Err(format!("the gallery is not current, run `{command}`:\n{}", stale.join("\n")).into())
}

fn comparisons(texts: &mut SourceSet) -> Result<Vec<strip::Comparison>, Diagnostics> {
    strip::library_comparisons(lamplight::LIBRARY_FILES, texts)
}

/// Composed texts that no page links, such as those of a preset that has another's text now.
fn unlinked_texts(folder: &Path, files: &[(String, String)]) -> Result<Vec<String>, Failed> {
    let mut unlinked = Vec::new();
    for entry in std::fs::read_dir(folder.join("composed"))? {
        let path = format!("composed/{}", entry?.file_name().to_string_lossy());
        if !files.iter().any(|(linked, _)| *linked == path) {
            unlinked.push(format!("{path} is linked by no page: delete it"));
        }
    }
    Ok(unlinked)
}

/// The difference of a large picture and its smaller form from the reviewed picture, if it is too
/// large.
fn changed(folder: &Path, name: &str) -> Result<Option<String>, String> {
    let [large, thumb] = gallery::picture_files(name).map(|file| folder.join(file));
    let head = std::fs::read(&large).map_err(|error| format!("{}: {error}", large.display()))?;
    // Width and height are the first numbers of the header.
    let number = |at: usize| head.get(at..at + 4).and_then(|bytes| bytes.try_into().ok());
    let size = [16, 20].map(|at| number(at).map_or(0, u32::from_be_bytes));
    if size != gallery::SIZE || !is_own_png(&head) {
        let expected = gallery::SIZE;
        let what = format!("expected {expected:?} and a picture of `render`");
        return Ok(Some(format!("{name}.png has {size:?} pixels, {what}")));
    }
    let wanted = read(&reviewed_path(name))?;
    let difference = Difference::new(&wanted, &read(&thumb)?.shrunk(TIMES))?;
    let (mean, most) = (difference.mean(), difference.most());
    let bounds = HARD.iter().find(|(hard, _)| *hard == name).map_or(FINER, |(_, own)| *own);
    let is_other = mean > bounds.0 || most > bounds.1;
    Ok(is_other.then(|| {
        format!("{name}.png looks different: {mean:.2} on average, {most:.1} for all but 1 %")
    }))
}

fn png_round_trip() -> Result<(), Failed> {
    let pixels = (0..3 * 7 * 5).map(|index| (index * 37 % 256) as u8).collect();
    let picture = Picture { width: 7, height: 5, pixels };
    let read = Picture::from_png(&picture.png()?)?;
    if read == picture { Ok(()) } else { Err("the picture came back changed".into()) }
}

/// A Radiance file of two by one pixels, written by hand, has its radiance: three mantissas and one
/// shared exponent for each pixel. Files that are cut or too large are refused.
fn radiance_file() -> Result<(), Failed> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n".to_vec();
    bytes.extend([128, 64, 32, 129, 128, 128, 128, 132]);
    let image = Equirect::from_radiance(&bytes)?;
    let radiance: Vec<_> = image.samples().map(|(_, _, radiance)| radiance.to_array()).collect();
    let wanted = [[1.0, 0.5, 0.25], [8.0, 8.0, 8.0]];
    let close = radiance
        .iter()
        .zip(&wanted)
        .all(|(a, b)| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 0.01 * b));
    if radiance.len() != 2 || !close {
        return Err(format!("expected {wanted:?}, found {radiance:?}").into());
    }
    for wrong in
        [&bytes[..20], &bytes[..bytes.len() - 3], b"", b"#?RADIANCE\n\n-Y 99999999 +X 99999999\n"]
    {
        if Equirect::from_radiance(wrong).is_ok() {
            let text = String::from_utf8_lossy(wrong);
            return Err(format!("a broken file was read as an image: {text:?}").into());
        }
    }
    Ok(())
}

/// The comparison of pictures notices a shadow that is missing, and does not notice an edge that is
/// moved by a fifth of a pixel.
fn difference_is_seen() -> Result<(), Failed> {
    let disk = |middle: f64, shade: u8| {
        let inside =
            |index: u32| (f64::from(index % 64) - middle).hypot(f64::from(index / 64) - 32.0) < 9.0;
        let pixels =
            (0..64 * 64).flat_map(|index| [if inside(index) { shade } else { 200 }; 3]).collect();
        Picture { width: 64, height: 64, pixels }
    };
    let plain = disk(32.0, 120);
    let seen = Difference::new(&plain, &disk(32.0, 200))?.is_visible();
    let unseen = !Difference::new(&plain, &disk(32.2, 120))?.is_visible();
    let same = !Difference::new(&plain, &plain)?.is_visible();
    let _ = start("nothing").err().ok_or("there is no such executor")?;
    if seen && unseen && same {
        Ok(())
    } else {
        let what = format!("a missing shadow is noticed: {seen}");
        let what = format!("{what}, a moved edge is not: {unseen}");
        Err(format!("{what}, equal pictures are equal: {same}; all should be true").into())
    }
}
