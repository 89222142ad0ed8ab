//! What a surface of glTF reflects, written from the texts of the specification: glTF 2.0, appendix B, and
//! the extensions, each at its function. Nothing here is shared with the library.

use std::f64::consts::PI;

use glam::DVec3;

/// A point of a surface with all factors multiplied by their textures.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Unit; towards the viewer's side.
    pub normal: DVec3,
    /// Unit normal that no texture bends, for the coat.
    pub plain_normal: DVec3,
    /// Unit, along the texture, and across it.
    pub tangent: DVec3,
    pub bitangent: DVec3,
    /// Unit, towards the viewer.
    pub view: DVec3,
    pub base: DVec3,
    pub metallic: f64,
    pub roughness: f64,
    pub ior: f64,
    pub specular: f64,
    pub specular_color: DVec3,
    pub emission: DVec3,
    pub clearcoat: f64,
    pub clearcoat_roughness: f64,
    pub sheen_color: DVec3,
    pub sheen_roughness: f64,
    pub anisotropy: f64,
    /// Unit, in the plane of the tangent and the bitangent.
    pub brush: [f64; 2],
    pub iridescence: f64,
    pub film_ior: f64,
    pub film_thickness: f64,
    pub transmission: f64,
    pub diffuse_transmission: f64,
    pub diffuse_transmission_color: DVec3,
    pub thickness: f64,
    pub attenuation_color: DVec3,
    pub attenuation_distance: f64,
    pub is_unlit: bool,
}

/// What is not printed in appendix B or in the extension. Each of these has a row without it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Choices {
    /// Highlights gain what facets reflect several times: the appendix suggests it in B.2.3, by Turquin
    /// (2019), equation 16: `1 + f0 (1 - E)/E`. Coats and thin films have no gain.
    pub multiple: bool,
    /// Thin films have the colours of the viewer's angle, as in the glTF Sample Renderer (`pbr.frag`).
    /// The text has the angle of the half vector.
    pub film_of_viewer: bool,
    /// The Fresnel term of a light behind the surface is that of its mirror image, as in the glTF Sample
    /// Renderer for KHR_materials_diffuse_transmission (`l_mirror` in `pbr.frag`). For
    /// KHR_materials_transmission, only the library has it. The text has the half vector of the light itself.
    pub mirrored_fresnel: bool,
    /// Tangents that are absent follow the coordinates after KHR_texture_transform, as in the glTF Sample
    /// Renderer (`getNormalInfo`). The text says "texture coordinates associated with the normal texture".
    pub transformed_tangents: bool,
    /// Sheen has the visibility that the extension names for slow devices (Ashikhmin, Premoze).
    pub simple_sheen: bool,
}

/// B.3.2, the note: alpha is not 0, but limited to a small number.
const LEAST_ALPHA: f64 = 1e-6;

fn heaviside(x: f64) -> f64 {
    if x > 0.0 { 1.0 } else { 0.0 }
}

/// B.3.2: the distribution of Trowbridge and Reitz.
fn distribution(nh: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let below = nh * nh * (a2 - 1.0) + 1.0;
    a2 * heaviside(nh) / (PI * below * below)
}

/// B.3.2: the visibility of the height-correlated Smith function.
fn visibility(nl: f64, nv: f64, hl: f64, hv: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let (nl, nv) = (nl.abs(), nv.abs());
    let root = |x: f64| (a2 + (1.0 - a2) * x * x).sqrt();
    heaviside(hl) * heaviside(hv) / (2.0 * (nv * root(nl) + nl * root(nv)))
}

/// B.3.2 for a normal, or KHR_materials_anisotropy for two alphas and the directions that they are along.
#[derive(Debug, Clone, Copy)]
pub enum Lobe {
    Even { normal: DVec3, alpha: f64 },
    Brushed { normal: DVec3, tangent: DVec3, bitangent: DVec3, along: f64, across: f64 },
}

impl Lobe {
    fn normal(&self) -> DVec3 {
        match self {
            Self::Even { normal, .. } | Self::Brushed { normal, .. } => *normal,
        }
    }

    /// `specular_brdf`.
    fn brdf(&self, l: DVec3, v: DVec3) -> f64 {
        let n = self.normal();
        let h = (l + v).normalize();
        let (nl, nv, nh) = (n.dot(l), n.dot(v), n.dot(h));
        match *self {
            Self::Even { alpha, .. } => {
                visibility(nl, nv, h.dot(l), h.dot(v), alpha) * distribution(nh, alpha)
            }
            Self::Brushed { tangent, bitangent, along, across, .. } => {
                let a2 = along * across;
                let f = DVec3::new(across * tangent.dot(h), along * bitangent.dot(h), a2 * nh);
                let w2 = a2 / f.length_squared();
                let d = a2 * w2 * w2 / PI;
                let part = |w: DVec3| {
                    DVec3::new(along * tangent.dot(w), across * bitangent.dot(w), n.dot(w))
                };
                let visibility = 0.5 / (nl * part(v).length() + nv.abs() * part(l).length());
                visibility.clamp(0.0, 1.0) * d
            }
        }
    }

    /// The directional albedo: the share of light that facets reflect once if they absorb nothing. The
    /// integral over the directions of light, by midpoints, with half vectors that are distributed as
    /// the facets that the viewer sees (Heitz 2018, "Sampling the GGX Distribution of Visible Normals"),
    /// each direction weighted by `brdf n.l` over its density.
    pub fn albedo(&self, v: DVec3, steps: usize) -> f64 {
        let n = self.normal();
        let (t, b, at, ab) = match *self {
            Self::Even { alpha, .. } => {
                let t = n.any_orthonormal_vector();
                (t, n.cross(t), alpha, alpha)
            }
            Self::Brushed { tangent, bitangent, along, across, .. } => {
                (tangent, bitangent, along, across)
            }
        };
        let own = DVec3::new(t.dot(v), b.dot(v), n.dot(v).abs());
        let stretched = DVec3::new(at * own.x, ab * own.y, own.z).normalize();
        let side =
            if stretched.z < 0.9999 { DVec3::Z.cross(stretched).normalize() } else { DVec3::X };
        let other = stretched.cross(side);
        let masked = (at * own.x).hypot(ab * own.y).hypot(own.z);
        let mut sum = 0.0;
        for i in 0..steps {
            for k in 0..steps {
                // Denser towards the rim of the disk, where facets are steep.
                let height = (i as f64 + 0.5) / steps as f64;
                let r = (1.0 - height * height).sqrt();
                let phi = 2.0 * PI * (k as f64 + 0.5) / steps as f64;
                let (x, s) = (r * phi.cos(), 0.5 * (1.0 + stretched.z));
                let y = (1.0 - s) * (1.0 - x * x).sqrt() + s * r * phi.sin();
                let z = (1.0 - x * x - y * y).max(0.0).sqrt();
                let facet = side * x + other * y + stretched * z;
                let h = DVec3::new(at * facet.x, ab * facet.y, facet.z.max(1e-9)).normalize();
                let h = t * h.x + b * h.y + n * h.z;
                let l = h * (2.0 * v.dot(h)) - v;
                let nl = n.dot(l);
                if nl <= 0.0 {
                    continue;
                }
                let slope = DVec3::new(t.dot(h) / at, b.dot(h) / ab, n.dot(h));
                let d = 1.0 / (PI * at * ab * slope.length_squared().powi(2));
                // The density of l: G1(v) D/(4 n.v), with G1 = 2 n.v/(n.v + masked).
                let density = 0.5 * d / (own.z + masked);
                sum += 2.0 * height * self.brdf(l, v) * nl / density;
            }
        }
        sum / (steps * steps) as f64
    }
}

/// B.3.4: Schlick's approximation, for two ends.
fn schlick(f0: DVec3, f90: f64, cosine: f64) -> DVec3 {
    f0 + (DVec3::splat(f90) - f0) * (1.0 - cosine.abs()).powi(5)
}

impl Surface {
    fn alpha(&self) -> f64 {
        (self.roughness * self.roughness).max(LEAST_ALPHA)
    }

    /// The lobe of the base.
    pub fn lobe(&self) -> Lobe {
        let (normal, alpha) = (self.normal, self.alpha());
        if self.anisotropy == 0.0 {
            return Lobe::Even { normal, alpha };
        }
        // KHR_materials_anisotropy: alpha along the brush grows to 1 with the square of the strength.
        let along = alpha + (1.0 - alpha) * self.anisotropy * self.anisotropy;
        let [x, y] = self.brush;
        let tangent = (self.tangent * x + self.bitangent * y).normalize();
        let bitangent = self.plain_normal.cross(tangent).normalize();
        Lobe::Brushed { normal, tangent, bitangent, along, across: alpha }
    }

    /// The lobe of the coat (KHR_materials_clearcoat).
    fn coat_lobe(&self) -> Lobe {
        let rough = self.clearcoat_roughness;
        Lobe::Even { normal: self.plain_normal, alpha: (rough * rough).max(LEAST_ALPHA) }
    }

    /// KHR_materials_ior and KHR_materials_specular: what a dielectric reflects straight back, without
    /// its weight.
    fn dielectric_f0(&self) -> DVec3 {
        let share = ((self.ior - 1.0) / (self.ior + 1.0)).powi(2);
        (self.specular_color * share).min(DVec3::ONE)
    }

    /// The radiance that leaves towards the viewer, of a light that gives a surface facing it the
    /// irradiance 1. `albedo` is that of the lobe of the base, for `Choices::multiple`.
    pub fn reflected(&self, l: DVec3, choices: Choices, albedo: f64) -> DVec3 {
        let (n, v) = (self.normal, self.view);
        let (nl, nv) = (n.dot(l), n.dot(v));
        let mut light = self.base_layers(l, choices, albedo);
        if self.sheen_color != DVec3::ZERO {
            light = self.with_sheen(light, l, nl, nv, choices);
        }
        if self.clearcoat > 0.0 {
            // KHR_materials_clearcoat: `fresnel_coat` over `clearcoat_brdf`.
            let nc = self.plain_normal;
            let fresnel = schlick(DVec3::splat(0.04), 1.0, nc.dot(v)).x * self.clearcoat;
            let lit = nc.dot(l).max(0.0);
            let coat = if lit > 0.0 { self.coat_lobe().brdf(l, v) * lit } else { 0.0 };
            light = light * (1.0 - fresnel) + coat * fresnel;
        }
        light
    }

    /// The cosine of B.3.4, with `H` of B.3.1.
    fn fresnel_cosine(&self, l: DVec3, choices: Choices) -> f64 {
        let (n, v) = (self.normal, self.view);
        let behind = n.dot(l).min(0.0);
        let l = if choices.mirrored_fresnel { l - n * (2.0 * behind) } else { l };
        v.dot((l + v).normalize()).abs()
    }

    /// B.3.5 with KHR_materials_ior, _specular, _iridescence, _transmission and _diffuse_transmission.
    fn base_layers(&self, l: DVec3, choices: Choices, albedo: f64) -> DVec3 {
        let (n, v) = (self.normal, self.view);
        let nl = n.dot(l);
        let cosine = self.fresnel_cosine(l, choices);
        let (dielectric_f0, metal_f0) = (self.dielectric_f0(), self.base);
        let gain = |f0: DVec3| match choices.multiple {
            true => DVec3::ONE + f0 * ((1.0 - albedo) / albedo),
            false => DVec3::ONE,
        };
        // KHR_materials_specular: `fresnel_mix`, and B.3.4: `conductor_fresnel`.
        let mut share = schlick(dielectric_f0, 1.0, cosine) * self.specular;
        let mut metal = schlick(metal_f0, 1.0, cosine) * gain(metal_f0);
        let mut dielectric = share * gain(dielectric_f0);
        if self.iridescence > 0.0 {
            // KHR_materials_iridescence: `iridescent_dielectric_layer` and `iridescent_conductor_layer`.
            let angle = if choices.film_of_viewer { n.dot(v).abs() } else { cosine };
            let film = |f0: DVec3| film_fresnel(self.film_ior, f0, self.film_thickness, angle);
            let of_dielectric = film(dielectric_f0 * self.specular);
            let of_metal = film(metal_f0);
            share = share.lerp(of_dielectric, self.iridescence);
            dielectric = dielectric.lerp(of_dielectric, self.iridescence);
            metal = metal.lerp(of_metal, self.iridescence);
        }
        let lobe = if nl > 0.0 { self.lobe().brdf(l, v) * nl } else { 0.0 };
        let below = self.below(l) * (1.0 - share.max_element());
        (below + dielectric * lobe).lerp(metal * lobe, self.metallic)
    }

    /// What a dielectric does with the light that it does not reflect, times the cosine.
    fn below(&self, l: DVec3) -> DVec3 {
        let (n, v) = (self.normal, self.view);
        let nl = n.dot(l);
        let before = self.base * (nl.max(0.0) / PI);
        // KHR_materials_volume: T(x) of "Attenuation", along the thickness, where there is one, as in the
        // glTF Sample Renderer (`diffuseTransmissionThickness`).
        let passing = match self.thickness > 0.0 && self.attenuation_distance.is_finite() {
            true => self.attenuation_color.powf(self.thickness / self.attenuation_distance),
            false => DVec3::ONE,
        };
        // KHR_materials_diffuse_transmission: `diffuse_btdf`.
        let behind = self.diffuse_transmission_color * passing * ((-nl).max(0.0) / PI);
        let scattered = before.lerp(behind, self.diffuse_transmission);
        if self.transmission == 0.0 {
            return scattered;
        }
        let through = if nl < 0.0 { self.btdf(l, v) * -nl } else { 0.0 };
        scattered.lerp(self.base * passing * through, self.transmission)
    }

    /// KHR_materials_transmission: `specular_btdf`.
    fn btdf(&self, l: DVec3, v: DVec3) -> f64 {
        let n = self.normal;
        let alpha = self.alpha();
        let a2 = alpha * alpha;
        let (nl, nv) = (n.dot(l), n.dot(v));
        let h = (v - n * (2.0 * nl) + l).normalize();
        let part = |cosine: f64, side: f64| {
            heaviside(side / cosine) / (cosine.abs() + (a2 + (1.0 - a2) * cosine * cosine).sqrt())
        };
        // The half vector is on the viewer's side, where the mirrored light is too.
        part(nl, -h.dot(l - n * (2.0 * nl))) * part(nv, h.dot(v)) * distribution(n.dot(h), alpha)
    }

    /// KHR_materials_sheen, with the albedo scaling of both directions.
    fn with_sheen(&self, light: DVec3, l: DVec3, nl: f64, nv: f64, choices: Choices) -> DVec3 {
        let h = (l + self.view).normalize();
        let alpha = self.sheen_roughness * self.sheen_roughness;
        let lobe = if nl > 0.0 && nv > 0.0 {
            sheen(nl, nv, self.normal.dot(h), alpha, choices.simple_sheen) * nl
        } else {
            0.0
        };
        let most = self.sheen_color.max_element();
        let albedo = |x: f64| sheen_albedo(x, alpha, choices.simple_sheen);
        let scale = (1.0 - most * albedo(nv)).min(1.0 - most * albedo(nl.abs()));
        self.sheen_color * lobe + light * scale
    }

    /// The emission that leaves the surface: the coat is above it (KHR_materials_clearcoat, "Emission").
    pub fn emitted(&self) -> DVec3 {
        let fresnel = schlick(DVec3::splat(0.04), 1.0, self.plain_normal.dot(self.view)).x;
        self.emission * (1.0 - self.clearcoat * fresnel)
    }
}

/// KHR_materials_sheen: distribution and visibility.
fn sheen(nl: f64, nv: f64, nh: f64, alpha: f64, simple: bool) -> f64 {
    let inverse = 1.0 / alpha;
    let d = (2.0 + inverse) * (1.0 - nh * nh).max(0.0).powf(0.5 * inverse) / (2.0 * PI);
    if simple {
        return d / (4.0 * (nl + nv - nl * nv));
    }
    let lambda = |x: f64| {
        let share = (1.0 - alpha).powi(2);
        let mix = |a: f64, b: f64| a + (b - a) * share;
        let (a, b, c) = (mix(21.5473, 25.3245), mix(3.82987, 3.32435), mix(0.19823, 0.16801));
        let (d, e) = (mix(-1.97760, -1.27393), mix(-4.32054, -4.85967));
        let curve = |x: f64| a / (1.0 + b * x.powf(c)) + d * x + e;
        if x < 0.5 { curve(x).exp() } else { (2.0 * curve(0.5) - curve(1.0 - x)).exp() }
    };
    d / ((1.0 + lambda(nv) + lambda(nl)) * (4.0 * nv * nl))
}

/// KHR_materials_sheen: `E`, the integral of the sheen with the cosine, by midpoints.
fn sheen_albedo(cosine: f64, alpha: f64, simple: bool) -> f64 {
    const STEPS: usize = 24;
    let nv = cosine.clamp(1e-4, 1.0);
    let v = DVec3::new((1.0 - nv * nv).sqrt(), 0.0, nv);
    let mut sum = 0.0;
    for i in 0..STEPS {
        for k in 0..STEPS {
            let nl = (i as f64 + 0.5) / STEPS as f64;
            let phi = PI * (k as f64 + 0.5) / STEPS as f64;
            let side = (1.0 - nl * nl).sqrt();
            let l = DVec3::new(side * phi.cos(), side * phi.sin(), nl);
            let h = (l + v).normalize();
            sum += sheen(nl, nv, h.z, alpha, simple) * nl;
        }
    }
    sum * 2.0 * PI / (STEPS * STEPS) as f64
}

/// KHR_materials_iridescence: `iridescent_fresnel`, for a film in air.
fn film_fresnel(film: f64, f0: DVec3, thickness: f64, cosine: f64) -> DVec3 {
    let between = |to: f64, from: f64| ((to - from) / (to + from)).powi(2);
    let sine2 = (1.0 / film).powi(2) * (1.0 - cosine * cosine);
    let cosine2 = (1.0 - sine2).sqrt();
    // First interface.
    let r12 = schlick(DVec3::splat(between(film, 1.0)), 1.0, cosine).x;
    let t121 = 1.0 - r12;
    let phase21 = PI - if film < 1.0 { PI } else { 0.0 };
    // Second interface.
    let base_ior = (f0 + 0.0001).to_array().map(|f| (1.0 + f.sqrt()) / (1.0 - f.sqrt()));
    let r1 = DVec3::from_array(base_ior.map(|ior| between(ior, film)));
    let r23 = schlick(r1, 1.0, cosine2);
    let phase = base_ior.map(|ior| phase21 + if ior < film { PI } else { 0.0 });
    let difference = 2.0 * film * thickness * cosine2;
    // The series of Airy.
    let r123 = (r12 * r23).clamp(DVec3::splat(1e-5), DVec3::splat(0.9999));
    let root = r123.powf(0.5);
    let rs = r23 * (t121 * t121) / (DVec3::ONE - r123);
    let mut sum = DVec3::splat(r12) + rs;
    let mut order = rs - DVec3::splat(t121);
    for m in 1..=2 {
        let m = f64::from(m);
        order *= root;
        sum += order * 2.0 * film_response(m * difference, phase.map(|phase| m * phase));
    }
    sum.max(DVec3::ZERO)
}

/// KHR_materials_iridescence: `evalSensitivity`, the response of the eye in Rec. 709.
fn film_response(difference: f64, phase: [f64; 3]) -> DVec3 {
    let path = 2.0 * PI * difference * 1.0e-9;
    let value = [5.4856e-13, 4.4201e-13, 5.2481e-13];
    let place = [1.6810e+06, 1.7953e+06, 2.2084e+06];
    let width = [4.3278e+09, 9.3046e+09, 6.6121e+09];
    let wave = |i: usize| {
        value[i]
            * (2.0 * PI * width[i]).sqrt()
            * (place[i] * path + phase[i]).cos()
            * (-path * path * width[i]).exp()
    };
    let mut xyz = [wave(0), wave(1), wave(2)];
    xyz[0] += 9.7470e-14
        * (2.0 * PI * 4.5282e+09_f64).sqrt()
        * (2.2399e+06 * path + phase[0]).cos()
        * (-4.5282e+09 * path * path).exp();
    let [x, y, z] = xyz.map(|part| part / 1.0685e-7);
    DVec3::new(
        3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
        -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
        0.0556434 * x - 0.2040259 * y + 1.0572252 * z,
    )
}
