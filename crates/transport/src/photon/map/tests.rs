//! Tests of the photon map.

use etendue_geometry::points::Neighbours;
use etendue_math::{Normal3, Point3, Rng, Vector3, warp};
use etendue_spectrum::Xyz;

use super::{Photon, PhotonMap, PhotonMapBuilder, StoredPhoton, Storing};
use crate::lpe::Event;
use crate::photon::Trail;

const UP: Vector3 = Vector3::new(0.0, 1.0, 0.0);

pub(super) fn photon(position: Point3) -> StoredPhoton {
    StoredPhoton { position, power: Xyz::new(0.5, 1.0, 0.25), wi: UP, trail: Trail::EMPTY, is_shadow: false }
}

fn random_photon(rng: &mut Rng) -> StoredPhoton {
    let [x, z] = [rng.next_f32(), rng.next_f32()];
    let events = [Event::Diffuse, Event::Specular, Event::WideGlossy];
    let trail = (0..rng.next_below(4)).fold(Trail::EMPTY, |t, _| t.with(events[rng.next_below(3) as usize]));
    StoredPhoton {
        position: Point3::new(x, 0.0, z),
        power: Xyz::from([0; 3].map(|_| rng.next_f32())),
        wi: warp::sample_uniform_sphere(rng.next_point2()),
        trail,
        is_shadow: rng.next_below(2) == 0,
    }
}

pub(super) fn random_map(n: usize, seed: u64) -> (Vec<StoredPhoton>, PhotonMap) {
    let mut rng = Rng::new(seed, 0);
    let photons: Vec<StoredPhoton> = (0..n).map(|_| random_photon(&mut rng)).collect();
    let map = PhotonMap::from_photons(&photons, 1);
    (photons, map)
}

/// Each photon is in the map once, with all that it had, whatever place it has there.
#[test]
fn photons_keep_what_they_had() {
    let (photons, map) = random_map(3000, 1);
    assert_eq!((map.len(), map.photons().len(), map.n_emitted()), (3000, 3000, 1));
    let key = |p: Point3| [p.x.to_bits(), p.z.to_bits()];
    let mut kept: Vec<Photon> = map.photons().collect();
    kept.sort_by_key(|photon| key(photon.position()));
    let mut stored = photons;
    stored.sort_by_key(|photon| key(photon.position));
    for (kept, stored) in kept.iter().zip(&stored) {
        assert_eq!(kept.position(), stored.position);
        assert_eq!(map.trail(kept), Some(stored.trail));
        assert_eq!(kept.is_shadow(), stored.is_shadow);
        assert!(kept.wi().angle_between(stored.wi).to_degrees() < 0.79);
        let largest = stored.power.to_array().into_iter().fold(0.0, f32::max);
        for (a, b) in map.power(kept).to_array().into_iter().zip(stored.power.to_array()) {
            assert!((a - b).abs() <= largest / 127.0);
        }
    }
    let trails: std::collections::HashSet<Trail> = stored.iter().map(|p| p.trail).collect();
    assert_eq!(map.trails().len(), trails.len());
}

/// A map takes 20 bytes a photon, to 5 %.
#[test]
fn memory() {
    let (_, map) = random_map(100_000, 2);
    let bytes = map.memory_bytes() as f64 / map.len() as f64;
    assert!((19.0..21.0).contains(&bytes), "{bytes}");
}

/// The state of a map while it is filled: each light's photons are scaled once, and it takes no more than it may.
#[test]
fn storing_and_scaling() {
    let mut builder = PhotonMapBuilder::new(5);
    let at = |x: i32| photon(Point3::new(x as f32, 0.0, 0.0));
    assert!(builder.is_empty() && !builder.is_full());
    builder.scale_power(7.0);
    for x in 0..3 {
        assert_eq!(builder.store(&at(x)), Storing::Stored);
    }
    builder.scale_power(0.5);
    builder.scale_power(7.0);
    for x in 3..5 {
        assert_eq!(builder.store(&at(x)), Storing::Stored);
    }
    assert!(builder.is_full());
    assert_eq!(builder.store(&at(5)), Storing::Full);
    builder.scale_power(0.25);
    assert_eq!((builder.len(), builder.n_refused()), (5, 0));
    let map = builder.balance(10);
    let mut powers: Vec<(f32, f32)> = map.photons().map(|p| (p.position().x, map.power(&p).y)).collect();
    powers.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(powers, [(0.0, 0.5), (1.0, 0.5), (2.0, 0.5), (3.0, 0.25), (4.0, 0.25)]);
    assert_eq!(map.n_emitted(), 10);
}

/// A photon that is not finite, or takes light away, is refused and counted.
#[test]
fn refused_photons() {
    let mut builder = PhotonMapBuilder::new(10);
    let good = photon(Point3::splat(1.0));
    for bad in [
        StoredPhoton { position: Point3::new(f32::NAN, 0.0, 0.0), ..good },
        StoredPhoton { position: Point3::new(0.0, f32::INFINITY, 0.0), ..good },
        StoredPhoton { power: Xyz::new(0.0, -1e-6, 0.0), ..good },
        StoredPhoton { power: Xyz::new(0.0, 0.0, f32::NAN), ..good },
        StoredPhoton { wi: Vector3::splat(f32::NAN), ..good },
    ] {
        assert_eq!(builder.store(&bad), Storing::Refused);
    }
    assert_eq!((builder.n_refused(), builder.len()), (5, 0));
    let map = builder.balance(3);
    assert!(map.is_empty());
    let mut found = Neighbours::new();
    let up = Normal3::new(0.0, 1.0, 0.0);
    assert_eq!(map.irradiance_estimate(Point3::splat(0.0), up, 50, 1.0, 8, &mut found), Xyz::default());
}

/// More kinds of trails than the table has room for: the last ones are "others".
#[test]
fn many_trails() {
    let letters = [Event::Diffuse, Event::SharpGlossy, Event::WideGlossy, Event::Specular, Event::Volume];
    let mut photons = Vec::new();
    for i in 0..10_000 {
        let trail = (0..6).fold(Trail::EMPTY, |t, digit| t.with(letters[i / 5_usize.pow(digit) % 5]));
        photons.push(StoredPhoton { trail, ..photon(Point3::new(i as f32, 0.0, 0.0)) });
    }
    let map = PhotonMap::from_photons(&photons, 1);
    assert_eq!(map.trails().len(), 8191);
    for kept in map.photons() {
        let i = kept.position().x as usize;
        assert_eq!(map.trail(&kept), (i < 8191).then(|| photons[i].trail));
    }
}

/// A uniform field: n photons of power 1/n on a square metre make an irradiance of 1. A disk of k photons has a relative
/// standard deviation of 1/sqrt(k), and a bias of 1/k (the k-th lies on its rim).
#[test]
fn irradiance_of_a_uniform_field() {
    let n = 20_000;
    let mut rng = Rng::new(4, 0);
    let at = |[x, z]: [f32; 2]| photon(Point3::new(x, 0.0, z));
    let photons: Vec<StoredPhoton> = (0..n).map(|_| at([rng.next_f32(), rng.next_f32()])).collect();
    let map = PhotonMap::from_photons(&photons, n);
    let mut found = Neighbours::new();
    let (k, n_places, mut sum) = (100, 400, 0.0);
    for _ in 0..n_places {
        let p = Point3::new(0.2 + 0.6 * rng.next_f32(), 0.0, 0.2 + 0.6 * rng.next_f32());
        let up = Normal3::new(0.0, 1.0, 0.0);
        let e = map.irradiance_estimate(p, up, k, f32::INFINITY, 8, &mut found);
        assert!((e.x / e.y - 0.5).abs() < 1e-2 && (e.z / e.y - 0.25).abs() < 1e-2);
        let below = map.irradiance_estimate(p, Normal3::new(0.0, -1.0, 0.0), k, f32::INFINITY, 8, &mut found);
        assert_eq!(below, Xyz::default());
        sum += e.y / n_places as f32;
    }
    // 400 disks of 100 photons hold 36 % of 20,000 photons, several times each: as good as 7200 independent photons.
    let expected = k as f32 / (k - 1) as f32;
    assert!((sum - expected).abs() < 5.0 / 7200.0_f32.sqrt(), "{sum}");
}

/// Seven photons make no light by the book's rule, eight do; the rule is a parameter. Where the radius holds fewer photons than
/// were asked for, it is the radius that divides.
#[test]
fn few_photons() {
    let mut found = Neighbours::new();
    let up = Normal3::new(0.0, 1.0, 0.0);
    for (n, min, expected) in [(7, 8, 0.0), (8, 8, 8.0), (7, 7, 7.0), (1, 0, 1.0), (0, 0, 0.0)] {
        let photons: Vec<StoredPhoton> = (0..n).map(|i| photon(Point3::splat(i as f32 * 0.01))).collect();
        let map = PhotonMap::from_photons(&photons, 1);
        let e = map.irradiance_estimate(Point3::splat(0.0), up, 50, 2.0, min, &mut found);
        let expected = expected / (4.0 * std::f32::consts::PI);
        assert!((e.y - expected).abs() < 1e-6, "{n} photons, {min} needed: {e:?}");
    }
}

/// All photons at one place: neither NaN nor infinity, whatever is asked.
#[test]
fn one_place() {
    let map = PhotonMap::from_photons(&vec![photon(Point3::splat(0.5)); 1000], 1000);
    let mut found = Neighbours::new();
    let up = Normal3::new(0.0, 1.0, 0.0);
    for p in [0.5, 0.6, f32::NAN, f32::INFINITY].map(Point3::splat) {
        for (k, radius) in [(0, 1.0), (50, 1.0), (5000, f32::INFINITY), (50, 0.0), (50, -1.0), (50, f32::NAN)]
        {
            let e = map.irradiance_estimate(p, up, k, radius, 1, &mut found);
            assert!(e.to_array().iter().all(|v| v.is_finite() && *v >= 0.0), "{p:?} {k} {radius} {e:?}");
        }
    }
}

/// One and two threads make the same map.
#[test]
fn threads() {
    let map = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("threads start");
        pool.install(|| random_map(60_000, 6).1.photons().collect::<Vec<Photon>>())
    };
    assert!(map(1) == map(2));
}
