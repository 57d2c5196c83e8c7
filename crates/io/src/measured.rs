//! Measured BRDFs in RGL's layout: tensor files with the fields of [`MeasuredParts`] (Dupuy and Jakob 2018, "An Adaptive
//! Parameterization for Efficient Material Acquisition and Rendering"; the files of their material database).
//!
//! `theta_i`, `phi_i` and `wavelengths` have one dimension; `ndf` and `sigma` are by phi and theta, `vndf` and `luminance` by
//! phi_i, theta_i and the two numbers, `spectra` has the wavelength between these; `jacobian` is a byte. Other fields are
//! passed over. Files with `rgb` in place of `spectra` are not read.

use etendue_scene::bsdf::measured::{Maps, MeasuredBrdf, MeasuredParts};

use crate::tensor::{NewData, NewField, TensorError, TensorFile, tensor_bytes};

/// A measured BRDF.
///
/// # Errors
/// If the bytes are no tensor file, or its fields do not make a BRDF.
pub fn read_measured(bytes: &[u8]) -> Result<MeasuredBrdf, TensorError> {
    let file = TensorFile::read(bytes)?;
    let list = |name| file.field(name, 1)?.floats();
    let (phi_i, theta_i, wavelengths) = (list("phi_i")?, list("theta_i")?, list("wavelengths")?);
    let by_view = [phi_i.len(), theta_i.len()];
    let by_wavelength = [by_view[0], by_view[1], wavelengths.len()];
    let jacobian = file.field("jacobian", 1)?;
    let &[is_relative] = jacobian.bytes()? else { return Err(jacobian.fault("should be one byte")) };
    let parts = MeasuredParts {
        ndf: maps(&file, "ndf", &[])?,
        sigma: maps(&file, "sigma", &[])?,
        vndf: maps(&file, "vndf", &by_view)?,
        luminance: maps(&file, "luminance", &by_view)?,
        spectra: maps(&file, "spectra", &by_wavelength)?,
        phi_i,
        theta_i,
        wavelengths,
        jacobian: is_relative != 0,
    };
    MeasuredBrdf::new(parts).map_err(|fault| TensorError::Field(fault.field.to_owned(), fault.why))
}

/// A field of maps for conditions of those dimensions.
fn maps(file: &TensorFile<'_>, name: &'static str, conditions: &[usize]) -> Result<Maps, TensorError> {
    let field = file.field(name, conditions.len() + 2)?;
    let (found, size) = field.shape().split_at(conditions.len());
    if found != conditions {
        return Err(field.fault(format!(
            "is for {}, but the fields of these are for {}",
            sizes(found),
            sizes(conditions)
        )));
    }
    Ok(Maps { size: [size[1], size[0]], values: field.floats()? })
}

fn sizes(dimensions: &[usize]) -> String {
    dimensions.iter().map(usize::to_string).collect::<Vec<_>>().join(" x ")
}

/// The bytes of a file with this BRDF.
#[must_use]
pub fn measured_bytes(brdf: &MeasuredBrdf, description: &str) -> Vec<u8> {
    let parts = brdf.parts();
    let (phi, theta, nm) = (parts.phi_i.len(), parts.theta_i.len(), parts.wavelengths.len());
    tensor_bytes(&[
        bytes_field("description", description.as_bytes()),
        list_field("theta_i", &parts.theta_i),
        list_field("phi_i", &parts.phi_i),
        list_field("wavelengths", &parts.wavelengths),
        maps_field("ndf", &parts.ndf, &[]),
        maps_field("sigma", &parts.sigma, &[]),
        maps_field("vndf", &parts.vndf, &[phi, theta]),
        maps_field("luminance", &parts.luminance, &[phi, theta]),
        maps_field("spectra", &parts.spectra, &[phi, theta, nm]),
        bytes_field("jacobian", if parts.jacobian { &[1] } else { &[0] }),
    ])
}

fn bytes_field<'a>(name: &'a str, bytes: &'a [u8]) -> NewField<'a> {
    NewField { name, shape: vec![bytes.len()], data: NewData::Bytes(bytes) }
}

fn list_field<'a>(name: &'a str, values: &'a [f32]) -> NewField<'a> {
    NewField { name, shape: vec![values.len()], data: NewData::Floats(values) }
}

fn maps_field<'a>(name: &'a str, maps: &'a Maps, conditions: &[usize]) -> NewField<'a> {
    let shape = [conditions, &[maps.size[1], maps.size[0]]].concat();
    NewField { name, shape, data: NewData::Floats(&maps.values) }
}

#[cfg(test)]
mod tests {
    use etendue_scene::bsdf::measured::MeasuredGrid;

    use super::*;

    /// Even facets that reflect evenly.
    fn even() -> MeasuredBrdf {
        let wavelengths = vec![400.0, 700.0];
        let grid = MeasuredGrid { n_phi: 1, n_theta: 3, n_facets: [4, 5], n_spectra: 3, wavelengths };
        MeasuredBrdf::of_model(&grid, |_| 1.0, |_, _, nm| nm / 1e4).unwrap()
    }

    #[track_caller]
    fn check(change: impl Fn(&mut Vec<NewField<'_>>), expected: &str) {
        let brdf = even();
        let parts = brdf.parts();
        let mut fields = vec![
            list_field("theta_i", &parts.theta_i),
            list_field("phi_i", &parts.phi_i),
            list_field("wavelengths", &parts.wavelengths),
            maps_field("ndf", &parts.ndf, &[]),
            maps_field("sigma", &parts.sigma, &[]),
            maps_field("vndf", &parts.vndf, &[1, 3]),
            maps_field("luminance", &parts.luminance, &[1, 3]),
            maps_field("spectra", &parts.spectra, &[1, 3, 2]),
            bytes_field("jacobian", &[1]),
        ];
        change(&mut fields);
        let message = read_measured(&tensor_bytes(&fields)).map_err(|error| error.to_string());
        assert_eq!(message.err().as_deref().unwrap_or(""), expected);
    }

    /// What is written is read again, to the last bit.
    #[test]
    fn measurements_are_read() {
        let brdf = even();
        assert_eq!(read_measured(&measured_bytes(&brdf, "even")), Ok(brdf));
    }

    /// Fields that are missing, of wrong size or type, or hold what no BRDF has, are named.
    #[test]
    fn damage_is_located() {
        check(|_| (), "");
        check(|fields| drop(fields.remove(0)), "there is no field `theta_i`");
        check(|fields| fields[0].shape = vec![1, 3], "the field `theta_i` should have 1 dimensions, not 2");
        check(
            |fields| fields[0].shape = vec![usize::MAX],
            "the field `theta_i` lies beyond the end of the file",
        );
        check(
            |fields| fields[1].data = NewData::Bytes(&[0]),
            "the field `phi_i` should have the type float32",
        );
        check(
            |fields| fields[3].shape = vec![20, 1],
            "the field `ndf` should have at least 2 by 2 values, not 20 by 1",
        );
        check(
            |fields| fields[5].shape = vec![3, 1, 5, 4],
            "the field `vndf` is for 3 x 1, but the fields of these are for 1 x 3",
        );
        check(
            |fields| fields[6].data = NewData::Floats(&[f32::NAN; 27]),
            "the field `luminance` has values that are no numbers",
        );
        check(|fields| fields[8] = bytes_field("jacobian", &[]), "the field `jacobian` should be one byte");
        check(
            |fields| fields[8] = list_field("jacobian", &[1.0]),
            "the field `jacobian` should have the type uint8",
        );
    }

    /// Damaged files are read without panic, and take no more memory than they have bytes.
    #[test]
    fn damaged_files_do_not_panic() {
        let sound = measured_bytes(&even(), "even");
        let mut state = 7_u64;
        let mut below = |n: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) as usize % n
        };
        let n_headers = 500;
        for i in 0..20_000 {
            let mut bytes = sound.clone();
            for _ in 0..=below(3) {
                // Half of the damage goes to the descriptions.
                let at = below(if i % 2 == 0 { bytes.len().min(n_headers) } else { bytes.len() });
                match below(4) {
                    0 => bytes[at] = below(256) as u8,
                    1 if bytes.len() > 1 => drop(bytes.remove(at)),
                    2 => bytes.insert(at, [0, 0xff, below(256) as u8][below(3)]),
                    _ => bytes.truncate(at.max(1)),
                }
            }
            drop(read_measured(&bytes));
        }
    }
}
