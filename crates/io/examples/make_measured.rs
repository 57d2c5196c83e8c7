//! Writes a measurement of copper with facets of GGX, in RGL's layout:
//! `cargo run --release -p etendue-io --example make_measured -- copper.bsdf [ALPHA [ALPHA_Y]]`.

use etendue_io::measured_bytes;
use etendue_scene::bsdf::measured::{MeasuredBrdf, MeasuredFault, MeasuredGrid};
use etendue_scene::bsdf::microfacet::Microfacets;
use etendue_scene::bsdf::{Conductor, Lobes};
use etendue_spectrum::{Sampled, SpectrumTables};

fn main() -> std::io::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().expect("usage: make_measured FILE [ALPHA [ALPHA_Y]]");
    let mut alphas = arguments.map(|alpha| alpha.parse().expect("alpha is a number"));
    let alpha_x = alphas.next().unwrap_or(0.3);
    let alpha_y = alphas.next().unwrap_or(alpha_x);
    let brdf = copper(Microfacets::new(alpha_x, alpha_y)).expect("the model is sound");
    std::fs::write(path, measured_bytes(&brdf, "copper with facets of GGX"))
}

fn copper(microfacets: Microfacets) -> Result<MeasuredBrdf, MeasuredFault> {
    let (alpha_x, alpha_y) = microfacets.alpha();
    let grid = MeasuredGrid {
        n_phi: if alpha_x == alpha_y { 1 } else { 9 },
        n_theta: 12,
        n_facets: [24, 24],
        n_spectra: 20,
        wavelengths: vec![400.0, 550.0, 600.0, 700.0],
    };
    let mut tables = SpectrumTables::new();
    let [eta, k] = ["metal-Cu-eta", "metal-Cu-k"].map(|name| tables.add_named(name).expect("it is built in"));
    MeasuredBrdf::of_model(
        &grid,
        |m| microfacets.d(m),
        |wo, wi, nm| {
            let [eta, k] = [eta, k].map(|spectrum| Sampled::splat(spectrum.at(&tables, nm)));
            Conductor { microfacets, eta, k }.eval(wo, wi, Lobes::ALL)[0]
        },
    )
}
