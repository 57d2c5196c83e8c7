//! Radiometric and photometric quantities: RAD-1 to RAD-10 and RAD-13.

use std::f64::consts::PI;

use etendue_math::statistics::integrate_sphere;

use super::assert_near;
use crate::photometry::{
    K_M, illuminance, isotropic_luminous_intensity, luminous_efficacy, luminous_efficiency, luminous_flux,
    luminous_flux_of_line,
};
use crate::radiometry::{
    diffuse_flux, flux_density, isotropic_intensity, photon_energy, photons_per_nm, radiance, radiant_energy,
    radiant_energy_of_lines, radiant_flux, spectral_radiant_energy,
};
use crate::{Spectrum, SpectrumTables};

#[test]
fn a_green_photon_has_its_energy() {
    // RAD-1: h c / λ at 550 nm is 3.61e-19 J.
    assert_near(photon_energy(550.0), 3.61e-19, 1e-3);
    assert_near(photon_energy(550.0), 6.626_070_15e-34 * 299_792_458.0 / 550e-9, 1e-12);
}

#[test]
fn photons_are_recovered_from_energy() {
    // RAD-2: Q_λ = n_λ h c / λ and back.
    for nm in [380.0, 555.0, 780.0] {
        assert_near(photons_per_nm(spectral_radiant_energy(1e20, nm), nm), 1e20, 1e-12);
    }
}

#[test]
fn a_line_spectrum_has_the_energy_of_its_photons() {
    // RAD-3: ∫ Q_λ dλ of a narrow line of n photons is n h c / λ.
    let (n, nm, width) = (1e18, 589.3, 0.5);
    let line = |x: f64| n / width * f64::from(u8::from((x - nm).abs() < width / 2.0));
    assert_near(radiant_energy(line, 500.0, 700.0), n * photon_energy(nm), 0.3);
    let gauss = |x: f64| n / (2.0 * PI).sqrt() * (-0.5 * (x - nm).powi(2)).exp();
    assert_near(radiant_energy(gauss, 500.0, 700.0), n * photon_energy(nm), 1e-5);
    let lines = [[450.0, 1e18], [600.0, 2e18]];
    let expected = 1e18 * photon_energy(450.0) + 2e18 * photon_energy(600.0);
    assert_near(radiant_energy_of_lines(&lines), expected, 1e-12);
}

#[test]
fn emitted_photons_sum_to_the_flux() {
    // RAD-4: a 1 W laser at 633 nm emits 3.19e18 photons per second; their energies over time are the flux again.
    let per_second = 1.0 / photon_energy(633.0);
    assert_near(per_second, 3.19e18, 2e-3);
    let energy = radiant_energy_of_lines(&[[633.0, 5.0 * per_second]]);
    assert_near(radiant_flux(energy, 5.0), 1.0, 1e-12);
}

#[test]
fn a_sphere_around_a_lamp_receives_its_flux() {
    // RAD-5, RAD-6: Φ = ∫ I dω = 4π I, and E = I / r² on a sphere of any radius collects Φ.
    let flux = 60.0;
    let intensity = isotropic_intensity(flux);
    assert_near(integrate_sphere(|_| intensity, 1e-9), flux, 1e-6);
    for radius in [0.5, 3.0] {
        let area = 4.0 * PI * radius * radius;
        assert_near(flux_density(flux, area), intensity / (radius * radius), 1e-12);
    }
}

#[test]
fn radiance_of_a_disc_does_not_depend_on_distance_or_angle() {
    // RAD-7, RAD-8: flux from a small patch into a small far aperture falls as cos θ / r², and so does the solid angle.
    let (l, patch, aperture) = (12.0, 1e-4, 1e-4);
    for distance in [1.0, 10.0] {
        for cos_theta in [1.0, 0.5, 0.1] {
            let solid_angle = aperture / (distance * distance);
            let flux = l * patch * cos_theta * solid_angle;
            assert_near(radiance(flux, cos_theta, patch, solid_angle), l, 1e-12);
        }
    }
}

#[test]
fn a_diffuse_disc_emits_pi_squared_r_squared_l() {
    // RAD-9: Φ = ∫∫ L cos θ dω dA = π² R² L.
    let (radius, l) = (0.3_f64, 7.0);
    let area = PI * radius * radius;
    assert_near(diffuse_flux(l, area), PI * PI * radius * radius * l, 1e-12);
    let over_hemisphere = integrate_sphere(|w| f64::from(w.z).max(0.0) * l * area, 1e-6);
    assert_near(diffuse_flux(l, area), over_hemisphere, 1e-4);
}

#[test]
fn the_eye_is_most_sensitive_at_555_nm() {
    // RAD-13: V peaks near 555 nm, where 1 W is 683 lm.
    let peak =
        (360..=830).max_by(|a, b| luminous_efficiency(*a as f32).total_cmp(&luminous_efficiency(*b as f32)));
    assert_eq!(peak, Some(555));
    assert_near(f64::from(luminous_efficiency(555.0)), 1.0, 1e-4);
    assert_near(f64::from(luminous_flux_of_line(1.0, 555.0)), 683.0, 1e-4);
    assert_near(f64::from(luminous_flux_of_line(1.0, 510.0)), 683.0 * 0.503, 1e-3);
    assert_eq!(luminous_flux_of_line(1.0, 900.0), 0.0);
}

#[test]
fn luminous_flux_integrates_over_the_spectrum() {
    // RAD-13: Φ_v = K_m ∫ Φ_λ V dλ; a triangle of 1 W around 555 nm, and equal energy of 1 W/nm.
    let mut tables = SpectrumTables::new();
    let line = tables.add_samples(&[[554.0, 0.0], [555.0, 1.0], [556.0, 0.0]]);
    assert_near(f64::from(luminous_flux(&line, &tables)), 683.0, 1e-4);
    assert_near(f64::from(luminous_efficacy(&line, &tables)), 683.0, 1e-4);
    let equal = Spectrum::Constant(1.0);
    assert_near(f64::from(luminous_flux(&equal, &tables)), 683.0 * 106.856_895, 1e-5);
    // The range 380–780 nm holds all but a hundred-thousandth of it.
    let narrow = tables.add_samples(&[[380.0, 1.0], [780.0, 1.0]]);
    assert_near(f64::from(luminous_flux(&narrow, &tables)), 683.0 * 106.856_895, 1e-4);
    assert_eq!(luminous_efficacy(&Spectrum::Constant(0.0), &tables), 0.0);
}

#[test]
fn photometric_units_follow_from_lumen() {
    // RAD-10, RAD-13: an isotropic lamp of 4π · 100 lm has 100 cd, and gives 100 lx at 1 m, 25 lx at 2 m.
    let flux = 4.0 * std::f32::consts::PI * 100.0;
    assert_near(f64::from(isotropic_luminous_intensity(flux)), 100.0, 1e-6);
    for (radius, expected) in [(1.0_f32, 100.0), (2.0, 25.0)] {
        let area = 4.0 * std::f32::consts::PI * radius * radius;
        assert_near(f64::from(illuminance(flux, area)), expected, 1e-6);
    }
    assert_eq!(K_M, 683.0);
}
