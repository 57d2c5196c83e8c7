//! A look at photons shows what is there.

use etendue_math::{Point3, Vector3};
use etendue_transport::photon::Trail;

use super::*;
use crate::scenes::StudyScene;

const UP: Vector3 = Vector3::new(0.0, 1.0, 0.0);

fn cloud(kind: PhotonKind) -> (Scene, PhotonCloud) {
    let scene = StudyScene::standard_box().with_resolution([48, 48]).build();
    let cloud = PhotonCloud::trace(&scene, 20_000, kind, 1);
    (scene, cloud)
}

/// The floor of the box is brighter than its corners, the mirror ball has no photons and so is black, and dots hide behind things.
#[test]
fn photons_are_seen_where_they_lie() {
    let (scene, cloud) = cloud(PhotonKind::All);
    let image = cloud.picture(&scene, PictureSettings { radius_px: 2.0, n_density: 20 });
    let pixels = image.rgb_pixels().expect("a picture has colour");
    let mean = |x: std::ops::Range<usize>, y: std::ops::Range<usize>| -> f32 {
        let n = (x.len() * y.len()) as f32;
        y.flat_map(|y| x.clone().map(move |x| (x, y))).map(|(x, y)| pixels[x + 48 * y][1]).sum::<f32>() / n
    };
    assert!(mean(14..34, 8..14) > 0.01, "the back wall");
    assert!(pixels.iter().flatten().all(|value| value.is_finite()));
    // The middle of the mirror ball, as the camera of the box sees it.
    let n_black = pixels.iter().filter(|rgb| rgb.iter().all(|value| *value == 0.0)).count();
    assert!(n_black > 48 * 48 / 30, "{n_black}");
}

/// Below the glass ball photons come through glass, from above.
#[test]
fn near_photons_tell_where_light_comes_from() {
    let (_, cloud) = cloud(PhotonKind::Caustic);
    assert!(!cloud.photons.is_empty() && cloud.photons.iter().all(|photon| photon.trail.is_caustic()));
    let near = cloud.nearest(Point3::new(0.48, 0.0, -0.1), Some(UP), 30);
    assert_eq!(near.len(), 30);
    assert!(near.iter().all(|photon| photon.p.y.abs() < 1e-3 && photon.wi.dot(UP) > 0.0));
    let csv = PhotonCloud::directions_csv(&near, UP);
    assert_eq!(csv.lines().count(), 31);
    assert!(csv.lines().skip(1).all(|line| line.contains(",LS")), "{csv}");
    assert_eq!(PhotonCloud::directions_svg(&near, UP).matches("<circle").count(), 33);
}

/// The PLY file reads back as points with their properties.
#[test]
fn clouds_are_files_of_points() {
    let photon = SeenPhoton {
        p: Point3::new(1.0, 2.0, 3.0),
        n: Normal3::new(0.0, 1.0, 0.0),
        wi: UP,
        power: [0.1, 0.2, 0.3],
        trail: Trail::EMPTY,
    };
    let cloud = PhotonCloud { photons: vec![photon; 3], n_emitted: 3, ..PhotonCloud::default() };
    let read = etendue_io::ply::read_ply_points(&cloud.ply()).expect("our own file reads").mesh;
    assert_eq!(read.positions, vec![photon.p; 3]);
    assert_eq!(read.normals, vec![photon.n; 3]);
}

/// No light, no photons: black, and nothing near.
#[test]
fn darkness_is_black() {
    let text = "Camera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\nShape \"sphere\"\n";
    let scene = StudyScene::of_text("dark", text).build();
    let cloud = PhotonCloud::trace(&scene, 100, PhotonKind::All, 0);
    assert!(cloud.photons.is_empty() && cloud.nearest(Point3::new(0.0, 0.0, 0.0), None, 5).is_empty());
    let image = cloud.picture(&scene, PictureSettings::default());
    assert!(image.rgb_pixels().expect("colour").iter().flatten().all(|value| *value == 0.0));
}
