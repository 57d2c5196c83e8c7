//! Configurations of these models; see [`crate::bsdf::catalogue`].

use etendue_math::Vector3;
use etendue_spectrum::Sampled;

use super::{ExtendedPrincipled, PrincipledParameters, ThinFilm};
use crate::bsdf::BsdfKind;
use crate::bsdf::catalogue::Configuration;
use crate::bsdf::facetted::Facetted;
use crate::bsdf::laws::Law;

/// All configurations: a new one is one line.
pub(in crate::bsdf) fn configurations() -> Vec<Configuration> {
    let white = PrincipledParameters::default();
    let color = Sampled::from_array([0.1, 0.2, 0.4, 0.5]);
    let rough_glass = PrincipledParameters { transmission: 1.0, roughness: 0.6, ..white };
    let smooth_glass = PrincipledParameters { roughness: 0.0, ..rough_glass };
    let solid = |p| PrincipledParameters { is_solid: true, ..p };
    let film = ThinFilm { share: 1.0, ..ThinFilm::NONE };
    vec![
        row("specular", PrincipledParameters { specular: 0.6, specular_color: color * 2.0, ..white })
            .lossless(),
        row("brushed plastic", PrincipledParameters { anisotropy: 0.7, roughness: 0.3, ..white }).lossless(),
        row("brushed metal", PrincipledParameters { anisotropy: 0.7, metallic: 1.0, ..white }).lossless(),
        row("coat", PrincipledParameters { clearcoat: 1.0, ..white }).lossless(),
        row(
            "tilted coat",
            PrincipledParameters {
                clearcoat: 1.0,
                clearcoat_roughness: 0.3,
                clearcoat_normal: Vector3::new(0.3, -0.2, 0.0),
                ..white
            },
        )
        .lossless()
        .breaking(&[Law::Furnace]),
        row("sheen", PrincipledParameters { sheen_color: Sampled::ONE, sheen_roughness: 0.5, ..white })
            .lossless(),
        row(
            "narrow sheen",
            PrincipledParameters { sheen_color: Sampled::ONE, sheen_roughness: 0.1, ..white },
        )
        .lossless(),
        row("film on plastic", PrincipledParameters { film, roughness: 0.3, ..white }).lossless(),
        row(
            "film on steel",
            PrincipledParameters {
                film: ThinFilm { share: 0.8, ior: 2.0, thickness_nm: 900.0 },
                base_color: Sampled::splat(0.6),
                metallic: 1.0,
                ..white
            },
        ),
        row("window", smooth_glass).lossless(),
        row("rough window", rough_glass).lossless(),
        row("solid glass", solid(smooth_glass)).lossless(),
        row("solid rough glass", solid(rough_glass)).lossless().breaking(&[Law::Furnace]),
        row(
            "solid rough glass without highlight",
            solid(PrincipledParameters { specular: 0.0, ..rough_glass }),
        )
        .breaking(&[]),
        row("solid of index 1", solid(PrincipledParameters { ior: 1.0, ..rough_glass })).lossless(),
        row("everything", solid(everything(color))),
    ]
}

/// A bit of each extension.
fn everything(color: Sampled) -> PrincipledParameters {
    PrincipledParameters {
        base_color: color,
        metallic: 0.3,
        roughness: 0.4,
        ior: 1.7,
        specular: 0.8,
        specular_color: Sampled::ONE - color,
        anisotropy: 0.5,
        transmission: 0.5,
        clearcoat: 0.5,
        clearcoat_roughness: 0.2,
        clearcoat_normal: Vector3::new(-0.1, 0.1, 0.99),
        sheen_color: color,
        sheen_roughness: 0.6,
        film: ThinFilm { share: 0.5, ior: 1.4, thickness_nm: 350.0 },
        ..PrincipledParameters::default()
    }
}

fn row(name: &'static str, p: PrincipledParameters) -> Configuration {
    let bits = |flag| f32::from(u8::from(flag));
    let kind = BsdfKind::Facetted(Facetted::Extended(ExtendedPrincipled::new(&p)));
    let plain = PrincipledParameters::default();
    let mut row = Configuration::new(name, "principled", kind);
    let mut add = |name, values: &[f32], defaults: &[f32]| {
        if values != defaults {
            row = row.clone().with(name, values);
        }
    };
    add("basecolor", &p.base_color.to_array(), &[]);
    add("metallic", &[p.metallic], &[]);
    add("roughness", &[p.roughness], &[]);
    add("ior", &[p.ior], &[]);
    add("specular", &[p.specular], &[plain.specular]);
    add("specularcolor", &p.specular_color.to_array(), &plain.specular_color.to_array());
    add("anisotropy", &[p.anisotropy], &[plain.anisotropy]);
    add("transmission", &[p.transmission], &[plain.transmission]);
    add("thickness", &[bits(p.is_solid)], &[0.0]);
    add("clearcoat", &[p.clearcoat], &[plain.clearcoat]);
    add("clearcoatroughness", &[p.clearcoat_roughness], &[plain.clearcoat_roughness]);
    add("sheencolor", &p.sheen_color.to_array(), &plain.sheen_color.to_array());
    add("sheenroughness", &[p.sheen_roughness], &[plain.sheen_roughness]);
    add("iridescence", &[p.film.share], &[plain.film.share]);
    add("iridescenceior", &[p.film.ior], &[plain.film.ior]);
    add("iridescencethickness", &[p.film.thickness_nm], &[plain.film.thickness_nm]);
    row
}
