//! Where the photons near a point come from (SPEC SCENE-31): a table, and a picture of the hemisphere.

use std::fmt::Write;

use etendue_math::{Frame, Vector3};

use super::SeenPhoton;

/// A photon's direction, by the angles that people use.
struct Bearing {
    /// From the normal, in degrees.
    theta: f32,
    /// Around it, in degrees from the frame's x.
    phi: f32,
    /// Place in the picture: the direction seen from above, so that equal areas bring equal irradiance for equal radiance.
    disc: [f32; 2],
}

fn bearing(frame: &Frame, wi: Vector3) -> Bearing {
    let local = frame.to_local(wi);
    let theta = local.z.clamp(-1.0, 1.0).acos().to_degrees();
    let phi = local.y.atan2(local.x).to_degrees().rem_euclid(360.0);
    Bearing { theta, phi, disc: [local.x, local.y] }
}

/// What a photon's path was called by Heckbert, from the light on.
fn word(photon: &SeenPhoton) -> String {
    let letters = photon.trail.events().map(|event| match event {
        etendue_transport::lpe::Event::Diffuse => 'D',
        etendue_transport::lpe::Event::SharpGlossy | etendue_transport::lpe::Event::WideGlossy => 'G',
        etendue_transport::lpe::Event::Specular => 'S',
        etendue_transport::lpe::Event::Volume => 'V',
    });
    std::iter::once('L').chain(letters).collect()
}

impl super::PhotonCloud {
    /// One row for each photon: its direction, its power, and its path.
    #[must_use]
    pub fn directions_csv(photons: &[SeenPhoton], n: Vector3) -> String {
        let frame = Frame::from_z(n);
        let mut text = String::from("theta_deg,phi_deg,wi_x,wi_y,wi_z,red,green,blue,path\n");
        for photon in photons {
            let Bearing { theta, phi, .. } = bearing(&frame, photon.wi);
            let Vector3 { x, y, z } = photon.wi;
            let [red, green, blue] = photon.power;
            let _ = writeln!(
                text,
                "{theta:.2},{phi:.2},{x:.5},{y:.5},{z:.5},{red:.6e},{green:.6e},{blue:.6e},{}",
                word(photon)
            );
        }
        text
    }

    /// The hemisphere seen from above, with a dot for each photon: orange through glass and mirrors, black from the lights, blue
    /// from surfaces. Circles are 30 degrees apart.
    #[must_use]
    pub fn directions_svg(photons: &[SeenPhoton], n: Vector3) -> String {
        let frame = Frame::from_z(n);
        let mut text = String::from(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-1.15 -1.15 2.3 2.3\" width=\"520\" height=\"520\">\n\
             <rect x=\"-1.15\" y=\"-1.15\" width=\"2.3\" height=\"2.3\" fill=\"white\"/>\n",
        );
        for theta in [30.0_f32, 60.0, 90.0] {
            let radius = theta.to_radians().sin();
            let _ = writeln!(
                text,
                "<circle r=\"{radius:.4}\" fill=\"none\" stroke=\"#888\" stroke-width=\"0.006\"/>"
            );
        }
        for photon in photons {
            let [x, y] = bearing(&frame, photon.wi).disc;
            let color = match photon.trail {
                trail if trail.is_empty() => "#000000",
                trail if trail.is_caustic() => "#d55e00",
                _ => "#0072b2",
            };
            let _ = writeln!(
                text,
                "<circle cx=\"{x:.4}\" cy=\"{:.4}\" r=\"0.018\" fill=\"{color}\" fill-opacity=\"0.7\"/>",
                -y
            );
        }
        text.push_str("</svg>\n");
        text
    }
}
