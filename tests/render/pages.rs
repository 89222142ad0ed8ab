//! The gallery's pages, and pictures without a driver.

use std::path::Path;

use lamplight::bundle::Language;
use lamplight::diagnostic::Diagnostics;
use lamplight::picture::{Picture, gallery, is_own_png, render_plan, strip};
use lamplight::scene::Equirect;
use lamplight::source::SourceSet;
use libtest_mimic::{Failed, Trial};

use super::difference::{Difference, is_recorded};
use super::{library, on_device, plan, rendered, shot, start};

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
        let wanted = render_plan(vulkan, &library().programs, &plan, &shot).map_err(rendered)?;
        let found = render_plan(start("eval")?.as_ref(), &library().programs, &plan, &shot)
            .map_err(rendered)?;
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

/// The page of the repository, and the comparisons that it shows.
const GALLERY: &str = "docs/gallery";

/// The gallery is current: the page of the repository has the presets, every picture that it shows is
/// there, and every comparison was drawn from the present settings and texts. The page that
/// `render --all` writes links what is written beside it. `INSTA_UPDATE=always` writes the page, but
/// no picture.
fn gallery_is_current() -> Result<(), Failed> {
    let (cards, strips) = gallery_cards()?;
    let cards: Vec<&gallery::Card> = cards.iter().collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(GALLERY);
    let page = gallery::markdown_page(&cards, &strips);
    let mut stale = stale_page(&folder.join("README.md"), &page)?;
    stale.extend(missing_pictures(&folder, &page));
    stale.extend(stale_strips(&folder, &strips)?);
    stale.extend(full_page(&cards, &strips));
    if stale.is_empty() {
        return Ok(());
    }
    let command = "lamplight render --comparisons --force -o docs/gallery";
    Err(format!("the gallery is not current, run `{command}`:\n{}", stale.join("\n")).into())
}

/// What is wrong with the page of the repository.
fn stale_page(page: &Path, wanted: &str) -> Result<Vec<String>, Failed> {
    let found = std::fs::read_to_string(page).unwrap_or_default();
    if found != wanted && is_recorded() {
        lamplight::output::write(page, wanted.as_bytes())?;
    } else if found != wanted {
        return Ok(vec!["README.md should have another text".to_owned()]);
    }
    Ok(Vec::new())
}

/// Pictures that a page of Markdown shows and that are not there.
fn missing_pictures(folder: &Path, page: &str) -> Vec<String> {
    let shown = page.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let pictures = shown.filter(|path| path.ends_with(".png"));
    let missing = pictures.filter(|path| !folder.join(path).is_file());
    missing.map(|path| format!("{path} is not there")).collect()
}

/// Comparisons that were drawn from something else.
fn stale_strips(folder: &Path, strips: &[gallery::StripCard]) -> Result<Vec<String>, Failed> {
    let adapters = std::fs::read_to_string(folder.join("adapters.txt"))?;
    let shot = shot(gallery::SIZE, gallery::SAMPLES, Language::Wesl);
    let mut stale = Vec::new();
    for card in strips {
        let (name, start) = (&card.comparison.name, card.current(&shot));
        if !adapters.lines().any(|line| line.starts_with(&start)) {
            stale.push(format!("{name} was drawn from other settings or texts"));
        }
        let bytes = std::fs::read(folder.join(gallery::strip_file(name)))?;
        if !is_own_png(&bytes) {
            stale.push(format!("{name} is no picture of `render`"));
        }
    }
    Ok(stale)
}

/// Files beside the full page that it does not link, and links to files that are not written.
fn full_page(cards: &[&gallery::Card], strips: &[gallery::StripCard]) -> Vec<String> {
    let page = gallery::html_page(cards, strips);
    let pictures = cards.iter().map(|card| gallery::picture_file(&card.preset.name));
    let strips = strips.iter().map(|card| gallery::strip_file(&card.comparison.name));
    let texts = gallery::composed(cards).into_iter().map(|(path, _)| path);
    let written: Vec<String> = pictures.chain(strips).chain(texts).collect();
    let is_linked = |path: &str| page.contains(&format!("href=\"{path}\""));
    let unlinked = written.iter().filter(|path| !is_linked(path));
    let links = page.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let own = links.filter(|link| !link.starts_with('#') && !link.starts_with("https:"));
    let missing = own.filter(|link| !written.iter().any(|path| path == link));
    unlinked
        .map(|path| format!("index.html does not link {path}"))
        .chain(missing.map(|link| format!("index.html links {link}, which is not written")))
        .collect()
}

/// What the pages say about all presets and comparisons.
pub fn gallery_cards() -> Result<(Vec<gallery::Card>, Vec<gallery::StripCard>), Failed> {
    let programs = &library().programs;
    let cards = library().presets.iter();
    let cards = cards.map(|preset| gallery::Card::new(programs, preset, Language::Wesl));
    let strips = programs.with_texts(comparisons).map_err(rendered)?.into_iter();
    let strips = strips.map(|one| gallery::StripCard::new(programs, one, Language::Wesl));
    let cards = cards.collect::<Result<_, _>>().map_err(rendered)?;
    Ok((cards, strips.collect::<Result<_, _>>().map_err(rendered)?))
}

fn comparisons(texts: &mut SourceSet) -> Result<Vec<strip::Comparison>, Diagnostics> {
    strip::library_comparisons(lamplight::LIBRARY_FILES, texts)
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
