//! What the sources say of single listings, each with its number.

use glam::DVec3;
use lamplight::bundle::Language;
use lamplight::catalogue::preset::{Preset, PresetNumber};
use lamplight::execute::Session;
use lamplight::picture::{Linear, Plan, prepare_passes};
use libtest_mimic::Trial;

use super::listings::SIZE;
use crate::render::{library, on_device, plan, rendered, shot};

type Check = fn(&dyn Session) -> Result<(), String>;

pub fn tests() -> Vec<Trial> {
    let checks: [(&str, Check); 5] = [
        ("oglpg_7_6_differs_from_7_4", vertices_differ),
        ("hpg_4_spot_has_no_highlight", no_highlight),
        ("ncl_11_has_a_tenth_of_ambient_light", ambient_tenth),
        ("ncl_11_has_the_color_of_its_texture", texture_alone),
        ("igl_1_ambient_fades_and_passes_the_cone", ambient_fades),
    ];
    let trial = |(name, check): (&str, Check)| {
        Trial::test(format!("published::{name}"), move || on_device("eval", check))
    };
    checks.into_iter().map(trial).collect()
}

fn preset(name: &str) -> Result<&'static Preset, String> {
    let found = library().presets.iter().find(|preset| preset.name == name);
    found.ok_or_else(|| format!("no preset `{name}`"))
}

fn drawn(painter: &dyn Session, plan: &Plan) -> Result<Linear, String> {
    let shot = shot(SIZE, 1, Language::Wesl);
    let mut prepared =
        prepare_passes(painter, &library().programs, plan, &shot).map_err(rendered)?;
    prepared.levels.clear();
    prepared.photograph(painter, &shot).map_err(rendered)
}

/// A plan with another key of a program, on the scene and with the numbers of a preset.
fn with_key(preset: &Preset, program: &str, key: &str) -> Result<Plan, String> {
    let mut other = preset.clone();
    other.program = program.to_owned();
    other.key = key.to_owned();
    plan(&other)
}

/// The colours of all pixels that both pictures show.
fn pairs(one: &Linear, other: &Linear) -> Vec<(DVec3, DVec3)> {
    let [width, height] = SIZE;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.filter_map(|(x, y)| one.drawn(x, y).zip(other.drawn(x, y))).collect()
}

fn largest(pairs: &[(DVec3, DVec3)]) -> f64 {
    pairs.iter().map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max)
}

/// Example 7.6 interpolates the half vector and the light's direction, which shortens them: between
/// the vertices of large triangles, its highlight is below that of example 7.4, and far below that of
/// the safe form, which also normalises the normal.
fn vertices_differ(painter: &dyn Session) -> Result<(), String> {
    let vertices = preset("oglpg_7_6")?;
    let printed = drawn(painter, &plan(vertices)?)?;
    let darker = |other: &Plan| {
        let pairs = pairs(&printed, &drawn(painter, other)?);
        let darker = pairs.iter().filter(|(six, other)| other.y - six.y > 0.01).count();
        Ok::<_, String>((darker as f64 / pairs.len() as f64, largest(&pairs)))
    };
    let (share, most) = darker(&with_key(vertices, "published", "default")?)?;
    let safe = vertices.safe_form().ok_or("no safe form")?;
    let (safe_share, safe_most) = darker(&plan(&safe)?)?;
    println!("from example 7.4: {share:.3} of the pixels are darker, the most by {most:.3}");
    println!(
        "from the safe form: {safe_share:.3} of the pixels are darker, the most by {safe_most:.3}"
    );
    if share > 0.02 && most > 0.02 && safe_share > 0.1 && safe_most > 0.5 {
        return Ok(());
    }
    Err(format!("{share}, {most}, {safe_share}, {safe_most}"))
}

/// The recipe's picture is that of diffuse light, and far from one with highlights.
fn no_highlight(painter: &dyn Session) -> Result<(), String> {
    let spot = preset("hpg_4_spot")?;
    let printed = drawn(painter, &plan(spot)?)?;
    let with = |specular: &str| {
        let key = format!("ambient=none,lights=spot,max_lights=1{specular}");
        Ok::<_, String>(largest(&pairs(
            &printed,
            &drawn(painter, &with_key(spot, "forward", &key)?)?,
        )))
    };
    let (without, shining) = (with(",specular=none")?, with("")?);
    println!("at most {without:.4} from diffuse light, and {shining:.3} from highlights");
    if without < 0.02 && shining > 0.2 { Ok(()) } else { Err(format!("{without} and {shining}")) }
}

/// Beyond the radius of the lamp, the colour is a tenth of that of the surface.
fn ambient_tenth(painter: &dyn Session) -> Result<(), String> {
    for name in ["ncl_11_flat", "ncl_11_gouraud", "ncl_11_phong"] {
        let mut dark = preset(name)?.clone();
        let light = dark.numbers.get_mut("light").ok_or("no light")?;
        light.insert("range".to_owned(), PresetNumber::Scalar(1e-3));
        let unlit = with_key(&dark, "forward", "ambient=none,base_map,lights=none")?;
        let pairs = pairs(&drawn(painter, &plan(&dark)?)?, &drawn(painter, &unlit)?);
        let scaled: Vec<_> = pairs.iter().map(|(dark, base)| (*dark, *base * 0.1)).collect();
        let most = largest(&scaled);
        println!("{name}: {} pixels, at most {most:.1e} from a tenth", pairs.len());
        if pairs.len() < 500 || most > 1e-5 {
            return Err(format!("{name}: {most} from a tenth"));
        }
    }
    Ok(())
}

/// The tutorial's fragment shader reads the texture, and not the colour that its vertex shader passes.
fn texture_alone(painter: &dyn Session) -> Result<(), String> {
    for name in ["ncl_11_flat", "ncl_11_phong", "ncl_11_further_2"] {
        let mut tinted = preset(name)?.clone();
        let color = PresetNumber::Vector(vec![0.2, 0.9, 0.4]);
        tinted.numbers.entry("object".to_owned()).or_default().insert("color".to_owned(), color);
        let pairs =
            pairs(&drawn(painter, &plan(preset(name)?)?)?, &drawn(painter, &plan(&tinted)?)?);
        let most = largest(&pairs);
        println!("{name}: {} pixels, at most {most:.1e} apart", pairs.len());
        if pairs.len() < 500 || most > 1e-6 {
            return Err(format!("{name}: the colour of the vertices changes it by {most}"));
        }
    }
    Ok(())
}

/// The article's ambient light is that of the lamp over the polynomial of the distance, and neither
/// cut by the cone nor added to by anything else.
fn ambient_fades(painter: &dyn Session) -> Result<(), String> {
    let ambient = preset("igl_1_ambient")?;
    let (all, alone) =
        (drawn(painter, &plan(preset("igl_1_spot")?)?)?, drawn(painter, &plan(ambient)?)?);
    let unlit = drawn(painter, &with_key(ambient, "forward", "ambient=none,lights=none")?)?;
    let outside = pairs(&all, &alone).iter().filter(|(all, alone)| all == alone).count();
    // Where the material reflects all ambient light, the ratio to the surface is the lamp's.
    let ratios: Vec<f64> = pairs(&alone, &unlit).iter().map(|(a, base)| a.y / base.y).collect();
    let (low, high) = ratios
        .iter()
        .fold((f64::MAX, 0.0_f64), |(low, high), ratio| (low.min(*ratio), high.max(*ratio)));
    println!(
        "{outside} pixels have ambient light alone, from {low:.4} to {high:.4} of the surface"
    );
    // The lamp's ambient light is 0.0576 green over its fading at its target; it is 4.4 to 18 away.
    if outside > 500 && low > 0.005 && high < 0.1 && high > 3.0 * low {
        Ok(())
    } else {
        Err(format!("{outside} pixels outside, from {low} to {high}"))
    }
}
