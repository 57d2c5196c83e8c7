//! Tests of textures.

use std::sync::Arc;

use etendue_image::{Encoding, TexelData, Texels, srgb_decode};
use etendue_math::statistics::{Moments, mean_test};
use etendue_math::{Normal3, Point2, Point3, Rng, Transform, Vector3};
use etendue_spectrum::{ColorSpaceName, Spectrum, Wavelengths};

use super::*;
use crate::assets::Assets;
use crate::document::{Entity, TextureEntity, TextureValue, Value};
use crate::parameters::{BuildContext, Parameters, SpectrumRole};

fn at_uv(u: f32, v: f32) -> TextureContext {
    TextureContext { uv: Point2::new(u, v), n: Normal3::new(0.0, 0.0, 1.0), ..TextureContext::default() }
}

fn at_point(x: f32, y: f32, z: f32) -> TextureContext {
    TextureContext { p: Point3::new(x, y, z), ..TextureContext::default() }
}

/// A footprint of this size, in u and v.
fn with_footprint(mut ctx: TextureContext, du: f32, dv: f32) -> TextureContext {
    (ctx.dudx, ctx.dvdy) = (du, dv);
    ctx
}

fn plane(st: Point2) -> Coordinates2 {
    Coordinates2 { st, dsdx: 0.0, dsdy: 0.0, dtdx: 0.0, dtdy: 0.0 }
}

fn lambda() -> Wavelengths {
    Wavelengths::sample_visible(0.3)
}

/// Builds a texture that yields numbers, with the number of problems.
fn read_float(entity: &Entity, assets: &Assets) -> (Textures, FloatTexture, usize) {
    let mut textures = Textures::default();
    let mut context = BuildContext::new(assets);
    let mut parameters = Parameters::new(entity, &mut context);
    let texture = textures.build_float(&mut parameters, &Transform::IDENTITY);
    parameters.finish();
    let n_problems = context.diagnostics.list().len();
    textures.spectra = context.spectra;
    (textures, texture, n_problems)
}

fn read_spectrum(entity: &Entity, assets: &Assets, role: SpectrumRole) -> (Textures, SpectrumTexture, usize) {
    let mut textures = Textures::default();
    let mut context = BuildContext::new(assets);
    let mut parameters = Parameters::new(entity, &mut context);
    let texture = textures.build_spectrum(&mut parameters, &Transform::IDENTITY, role);
    parameters.finish();
    let n_problems = context.diagnostics.list().len();
    textures.spectra = context.spectra;
    (textures, texture, n_problems)
}

fn floats(values: &[f32]) -> Value {
    Value::Floats(values.to_vec())
}

fn strings(value: &str) -> Value {
    Value::Strings(vec![value.to_owned()])
}

/// Gray texels given as bytes.
fn gray(width: usize, height: usize, values: &[u8]) -> Arc<Texels> {
    Arc::new(Texels::new(width, height, 1, TexelData::U8(values.to_vec())))
}

fn image_map(texels: &Arc<Texels>, filter: ImageFilter, wrap: WrapMode) -> ImageMap {
    let encoding = Encoding::Linear;
    ImageMap::new(texels.clone(), ImageOptions { filter, wrap, encoding, ..ImageOptions::default() })
}

const FILTERS: [ImageFilter; 4] =
    [ImageFilter::Point, ImageFilter::Bilinear, ImageFilter::Trilinear, ImageFilter::Ewa];

// Procedural textures.

/// A board is black and white, nothing between, when looked at from so near that a pixel is a point.
#[test]
fn checkerboard_is_crisp() {
    let (textures, texture, n_problems) = read_float(&Entity::new("checkerboard"), &Assets::default());
    assert_eq!(n_problems, 0);
    let value = |u: f32, v: f32| textures.eval_float(texture, &at_uv(u, v));
    for (u, v, expected) in [
        (0.5, 0.5, 1.0),
        (1.5, 0.5, 0.0),
        (0.5, 1.5, 0.0),
        (1.5, 1.5, 1.0),
        (-0.5, 0.5, 0.0),
        (-0.5, -0.5, 1.0),
    ] {
        assert_eq!(value(u, v), expected, "at {u}, {v}");
    }
    assert_eq!(value(0.999, 0.5), 1.0);
    assert_eq!(value(1.001, 0.5), 0.0);
}

/// In space the checks are cubes, and move with the texture's placement.
#[test]
fn checkerboard_fills_space() {
    let entity = Entity::new("checkerboard").with("dimension", Value::Integers(vec![3]));
    let (textures, texture, _) = read_float(&entity, &Assets::default());
    let value = |x: f32, y: f32, z: f32| textures.eval_float(texture, &at_point(x, y, z));
    assert_eq!(value(0.5, 0.5, 0.5), 1.0);
    assert_eq!(value(0.5, 0.5, 1.5), 0.0);
    assert_eq!(value(0.5, 1.5, 1.5), 1.0);
    assert_eq!(value(-0.5, 0.5, 0.5), 0.0);
}

/// Far away, a pixel shows the average of the checks under its footprint: the closed form agrees with a numerical mean.
#[test]
fn checkerboard_is_antialiased() {
    let node = Checkerboard { mapping: CheckMapping::Plane(Mapping2::default()), a: (), b: () };
    // A tent of half width r = 1.5 footprints along each axis.
    let numeric = |u: f32, v: f32, r: f32| {
        const N: i32 = 400;
        let wave = |x: f64| if (x.floor() as i64).rem_euclid(2) == 0 { 1.0 } else { -1.0 };
        let mean = |x: f32| {
            let weighted = |i: i32| {
                let t = (f64::from(i) + 0.5) / f64::from(N);
                (1.0 - t.abs()) * wave(f64::from(x) + t * f64::from(r)) / f64::from(N)
            };
            (-N..N).map(weighted).sum::<f64>()
        };
        0.5 - 0.5 * mean(u) * mean(v)
    };
    for (u, v, footprint) in
        [(0.93, 0.4, 0.1), (1.02, 2.97, 0.3), (7.3, 4.1, 0.7), (0.2, 0.3, 2.0), (100.9, 50.2, 0.2)]
    {
        let found = f64::from(node.amount(&with_footprint(at_uv(u, v), footprint, footprint)));
        let expected = numeric(u, v, 1.5 * footprint);
        assert!((found - expected).abs() < 6e-3, "at {u}, {v}: {found} but {expected}");
    }
    let far = node.amount(&with_footprint(at_uv(0.3, 0.4), 50.0, 50.0));
    assert!((far - 0.5).abs() < 1e-3, "a distant board is gray: {far}");
    let narrow = node.amount(&with_footprint(at_uv(1.0, 0.5), 1e-5, 1e-5));
    assert!((narrow - 0.5).abs() < 1e-3, "the middle of an edge, narrowly filtered: {narrow}");
}

/// A linear ramp between corners is recovered at every point.
#[test]
fn bilerp_interpolates() {
    let entity = Entity::new("bilerp")
        .with("v00", floats(&[1.0]))
        .with("v01", floats(&[2.0]))
        .with("v10", floats(&[4.0]))
        .with("v11", floats(&[8.0]));
    let (textures, texture, _) = read_float(&entity, &Assets::default());
    for (u, v, expected) in
        [(0.0, 0.0, 1.0), (0.0, 1.0, 2.0), (1.0, 0.0, 4.0), (1.0, 1.0, 8.0), (0.5, 0.5, 3.75)]
    {
        assert!((textures.eval_float(texture, &at_uv(u, v)) - expected).abs() < 1e-6);
    }
}

/// A mixture of two things holds each by its share, whether numbers or spectra.
#[test]
fn mixtures_hold_their_shares() {
    let mut textures = Textures::default();
    let (a, b) = (FloatTexture::Constant(2.0), FloatTexture::Constant(6.0));
    let mix = textures.add_float(FloatTextureNode::Mix(Mix { a, b, amount: FloatTexture::Constant(0.25) }));
    assert_eq!(textures.eval_float(mix, &at_uv(0.0, 0.0)), 3.0);
    let scaled = textures.add_float(FloatTextureNode::Scale(Scale { texture: mix, scale: b }));
    assert_eq!(textures.eval_float(scaled, &at_uv(0.0, 0.0)), 18.0);
    let direction = Vector3::new(0.0, 0.0, 1.0);
    let by_direction = textures.add_float(FloatTextureNode::DirectionMix(DirectionMix { a, b, direction }));
    let facing =
        |n: Normal3| textures.eval_float(by_direction, &TextureContext { n, ..TextureContext::default() });
    assert_eq!(facing(Normal3::new(0.0, 0.0, -1.0)), 2.0);
    assert_eq!(facing(Normal3::new(1.0, 0.0, 0.0)), 6.0);
    assert!((facing(Normal3::new(0.6, 0.0, 0.8)) - 2.8).abs() < 1e-6);
    let constant = |value: f32| SpectrumTexture::Constant(Spectrum::Constant(value));
    let node = Mix { a: constant(0.2), b: constant(0.6), amount: FloatTexture::Constant(0.5) };
    let spectra = textures.add_spectrum(SpectrumTextureNode::Mix(node));
    let value = textures.eval_spectrum(spectra, &at_uv(0.0, 0.0), &lambda());
    assert!(value.to_array().iter().all(|x| (x - 0.4).abs() < 1e-6));
}

/// A spectrum that is the same everywhere is itself under every combination that keeps constants.
#[test]
fn constant_spectra_stay_themselves() {
    let mut textures = Textures::default();
    let spectrum = textures.spectra.add_samples(&[[400.0, 0.1], [500.0, 0.9], [700.0, 0.4]]);
    let expected = spectrum.sample(&textures.spectra, &lambda());
    let same = SpectrumTexture::Constant(spectrum);
    let mapping = Mapping2::default();
    let nodes = [
        SpectrumTextureNode::Mix(Mix { a: same, b: same, amount: FloatTexture::Constant(0.3) }),
        SpectrumTextureNode::Scale(Scale { texture: same, scale: FloatTexture::Constant(1.0) }),
        SpectrumTextureNode::Bilerp(Bilerp { mapping, corners: [spectrum; 4] }),
        SpectrumTextureNode::Dots(Dots { mapping, inside: same, outside: same }),
        SpectrumTextureNode::Checkerboard(Checkerboard {
            mapping: CheckMapping::Plane(mapping),
            a: same,
            b: same,
        }),
    ];
    for node in nodes {
        let texture = textures.add_spectrum(node);
        let found = textures.eval_spectrum(texture, &with_footprint(at_uv(0.9, 0.3), 0.2, 0.2), &lambda());
        let difference = (found - expected).to_array().into_iter().fold(0.0_f32, |m, x| m.max(x.abs()));
        assert!(difference < 1e-6, "{node:?}");
    }
}

/// A dot covers 0.35^2 pi of its cell, and cells without a dot nothing.
#[test]
fn dots_cover_their_share() {
    let node = Dots { mapping: Mapping2::default(), inside: 1.0_f32, outside: 0.0 };
    let has_dot = |i: i32| noise(Point3::new((i % 100) as f32 + 0.5, (i / 100) as f32 + 0.5, 0.5)) > 0.0;
    let n_dots = (0..10_000).filter(|i| has_dot(*i)).count();
    assert!((3000..5000).contains(&n_dots), "{n_dots} of 10 000 cells");
    let expected = n_dots as f64 / 1e4 * std::f64::consts::PI * 0.35 * 0.35;
    let mut rng = Rng::new(11, 1);
    let covered: Moments = (0..100_000)
        .map(|_| {
            let u = rng.next_point2();
            f64::from(node.select(&at_uv(100.0 * u.x - 0.5, 100.0 * u.y - 0.5)))
        })
        .collect();
    mean_test(&covered, expected, 1e-5).unwrap();
}

/// Gradient noise is 0 on the lattice, within [-1, 1], continuous, and 0 on average.
#[test]
fn noise_is_bounded_and_continuous() {
    let mut rng = Rng::new(12, 1);
    let mut values = Moments::new();
    for _ in 0..50_000 {
        let mut next = || 40.0 * rng.next_f32() - 20.0;
        let p = Point3::new(next(), next(), next());
        let value = noise(p);
        assert!(value.abs() <= 1.0, "{value} at {p:?}");
        let step = 1e-3;
        let change = (noise(p + Vector3::new(step, -step, step)) - value).abs();
        assert!(change < 8.0 * step, "a jump of {change} at {p:?}");
        assert_eq!(noise(Point3::new(p.x.floor(), p.y.floor(), p.z.floor())), 0.0);
        values.push(f64::from(value));
    }
    // Neighbouring points are correlated over about a cell; 50 000 points in 64 000 cells are nearly independent.
    assert!(values.mean().abs() < 5.0 * values.standard_error(), "{}", values.mean());
    assert!((0.15..0.4).contains(&values.standard_deviation()), "{}", values.standard_deviation());
    assert!(noise(Point3::new(1e30, -1e30, 3.0)).is_finite());
}

/// Octaves finer than the footprint of a pixel are left out rather than aliased.
#[test]
fn fractal_sums_lose_what_a_pixel_cannot_show() {
    let octaves = Octaves { omega: 0.5, count: 8 };
    let p = Point3::new(0.3, 1.7, 2.9);
    let zero = Vector3::default();
    let wide = Vector3::new(10.0, 0.0, 0.0);
    assert_eq!(octaves.fbm(p, wide, zero), 0.0);
    let mean = 0.2 + 0.2 * (1.0 - 0.5_f32.powi(8)) / 0.5;
    assert!((octaves.turbulence(p, wide, zero) - mean).abs() < 1e-5);
    let full = octaves.fbm(p, zero, zero);
    let slightly = octaves.fbm(p, Vector3::new(1e-4, 0.0, 0.0), zero);
    assert!((full - slightly).abs() < 1e-6, "a small footprint changes nothing");
    let one = Octaves { omega: 0.5, count: 1 }.fbm(p, zero, zero);
    assert!((one - noise(p)).abs() < 1e-6, "one octave is the noise itself");
}

/// Stone reflects between black and white, and grey-blue as it is made.
#[test]
fn marble_is_a_reflectance() {
    let (textures, texture, n_problems) =
        read_spectrum(&Entity::new("marble"), &Assets::default(), SpectrumRole::Albedo);
    assert_eq!(n_problems, 0);
    let (mut min, mut max) = (1.0_f32, 0.0_f32);
    for i in 0..500 {
        let ctx = at_point(0.1, 0.02 * i as f32, 0.3);
        let value = textures.eval_spectrum(texture, &ctx, &lambda());
        min = min.min(value.min_value());
        max = max.max(value.max_value());
    }
    assert!(min > 0.3 && max < 0.95 && max - min > 0.2, "{min} to {max}");
}

// Mappings.

/// The change of texture coordinates per pixel is their difference between the points that neighbouring pixels see.
#[test]
fn mappings_agree_with_finite_differences() {
    let placed =
        Transform::translate(Vector3::new(0.1, 0.2, -0.3)) * Transform::scale(2.0, 1.0, 0.5).unwrap();
    let texture_from_world = placed.inverse();
    let mappings = [
        Mapping2::Uv { su: 3.0, sv: -2.0, du: 0.1, dv: 0.2 },
        Mapping2::Spherical(texture_from_world),
        Mapping2::Cylindrical(texture_from_world),
        Mapping2::Planar {
            texture_from_world,
            vs: Vector3::new(1.0, 2.0, 0.5),
            vt: Vector3::new(-1.0, 0.3, 0.2),
            ds: 0.4,
            dt: 0.5,
        },
    ];
    let (dpdx, dpdy) = (Vector3::new(2e-3, -1e-3, 1e-3), Vector3::new(0.0, 1e-3, 3e-3));
    let context = |p: Point3, uv: Point2| TextureContext {
        p,
        uv,
        dpdx,
        dpdy,
        dudx: 1e-3,
        dudy: -2e-3,
        dvdx: 3e-3,
        dvdy: 1e-3,
        ..TextureContext::default()
    };
    let (p, uv) = (Point3::new(1.0, 0.7, 0.9), Point2::new(0.3, 0.6));
    for mapping in mappings {
        let c = mapping.map(&context(p, uv));
        let right = mapping.map(&context(p + dpdx, Point2::new(uv.x + 1e-3, uv.y + 3e-3))).st;
        let below = mapping.map(&context(p + dpdy, Point2::new(uv.x - 2e-3, uv.y + 1e-3))).st;
        for (found, expected) in [
            (c.dsdx, right.x - c.st.x),
            (c.dtdx, right.y - c.st.y),
            (c.dsdy, below.x - c.st.x),
            (c.dtdy, below.y - c.st.y),
        ] {
            assert!((found - expected).abs() < 2e-5, "{mapping:?}: {found} but {expected}");
        }
    }
}

/// Angles on a globe: the pole is at s = 0, the equator at s = 1/2, and t goes once around.
#[test]
fn spherical_mapping_has_its_pole_at_z() {
    let map = |x: f32, y: f32, z: f32| Mapping2::Spherical(Transform::IDENTITY).map(&at_point(x, y, z)).st;
    assert_eq!(map(0.0, 0.0, 2.0).x, 0.0);
    assert!((map(3.0, 0.0, 0.0) - Point2::new(0.5, 0.0)).length() < 1e-6);
    assert!((map(0.0, 1.0, 0.0) - Point2::new(0.5, 0.25)).length() < 1e-6);
    assert!((map(0.0, -1.0, 0.0) - Point2::new(0.5, 0.75)).length() < 1e-6);
    let cylindrical = Mapping2::Cylindrical(Transform::IDENTITY).map(&at_point(2.0, 0.0, 0.7)).st;
    assert!((cylindrical - Point2::new(0.5, 0.7)).length() < 1e-6);
}

// Pictures.

/// Row 0 is the top of a picture and v runs upward: the first row is near v = 1.
#[test]
fn image_is_upright() {
    let texels = gray(2, 2, &[255, 0, 51, 102]);
    for filter in FILTERS {
        let map = image_map(&texels, filter, WrapMode::Clamp);
        for (s, t, expected) in [(0.25, 0.75, 1.0), (0.75, 0.75, 0.0), (0.25, 0.25, 0.2), (0.75, 0.25, 0.4)] {
            let [found] = map.lookup::<1>(&plane(Point2::new(s, t)));
            assert!((found - expected).abs() < 1e-5, "{filter:?} at {s}, {t}: {found} but {expected}");
        }
    }
}

/// Between texel centres, values are interpolated.
#[test]
fn bilinear_interpolates() {
    let map = image_map(&gray(2, 1, &[0, 255]), ImageFilter::Bilinear, WrapMode::Clamp);
    for (s, expected) in [(0.0, 0.0), (0.25, 0.0), (0.5, 0.5), (0.625, 0.75), (1.0, 1.0)] {
        let [found] = map.lookup::<1>(&plane(Point2::new(s, 0.5)));
        assert!((found - expected).abs() < 1e-5, "at {s}: {found} but {expected}");
    }
}

/// Beyond its border, a picture goes on as asked.
#[test]
fn wrap_modes() {
    let texels = gray(2, 1, &[51, 255]);
    let value = |wrap: WrapMode, s: f32| {
        image_map(&texels, ImageFilter::Point, wrap).lookup::<1>(&plane(Point2::new(s, 0.5)))[0]
    };
    for (wrap, before, after) in [
        (WrapMode::Repeat, 1.0, 0.2),
        (WrapMode::Clamp, 0.2, 1.0),
        (WrapMode::Black, 0.0, 0.0),
        (WrapMode::OctahedralSphere, 0.2, 1.0),
    ] {
        assert!((value(wrap, -0.25) - before).abs() < 1e-6, "{wrap:?}: {}", value(wrap, -0.25));
        assert!((value(wrap, 1.25) - after).abs() < 1e-6, "{wrap:?}: {}", value(wrap, 1.25));
        assert!((value(wrap, 0.25) - 0.2).abs() < 1e-6);
    }
    assert!((value(WrapMode::Repeat, 1000.25) - 0.2).abs() < 1e-6);
}

/// On an equal-area map of all directions, what lies across a border is the neighbouring direction.
#[test]
fn octahedral_wrap_continues_the_sphere() {
    let size = 64;
    let direction = |x: f32, y: f32| {
        etendue_math::warp::equal_area_square_to_sphere(Point2::new(x / size as f32, y / size as f32))
    };
    let texels = Texels::from_fn(size, size, 3, |x, y, c| 1.0 + direction(x as f32 + 0.5, y as f32 + 0.5)[c]);
    let map = image_map(&Arc::new(texels), ImageFilter::Point, WrapMode::OctahedralSphere);
    let beyond = 0.4 / size as f32;
    for i in 0..size {
        let along = (i as f32 + 0.5) / size as f32;
        for (outside, inside) in [
            (Point2::new(-beyond, along), Point2::new(beyond, along)),
            (Point2::new(1.0 + beyond, along), Point2::new(1.0 - beyond, along)),
            (Point2::new(along, -beyond), Point2::new(along, beyond)),
            (Point2::new(along, 1.0 + beyond), Point2::new(along, 1.0 - beyond)),
        ] {
            let (a, b) = (map.lookup::<3>(&plane(outside)), map.lookup::<3>(&plane(inside)));
            let gap = (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0_f32, f32::max);
            assert!(gap < 0.12, "a jump of {gap} across the border at {outside:?}");
        }
    }
}

/// Stored bytes are decoded before they are filtered: half between black and white is half the light.
#[test]
fn encodings_are_decoded_before_filtering() {
    let texels = gray(2, 1, &[0, 128]);
    let stored = 128.0 / 255.0_f32;
    for (encoding, full) in [
        (Encoding::Linear, stored),
        (Encoding::Srgb, srgb_decode(stored)),
        (Encoding::Gamma(2.0), stored * stored),
    ] {
        let options = ImageOptions { encoding, wrap: WrapMode::Clamp, ..ImageOptions::default() };
        let map = ImageMap::new(texels.clone(), options);
        let value = |s: f32| map.lookup::<1>(&plane(Point2::new(s, 0.5)))[0];
        assert!((value(0.75) - full).abs() < 1e-6, "{encoding:?}");
        assert!((value(0.5) - full / 2.0).abs() < 1e-6, "{encoding:?}");
    }
}

/// A uniform picture stays uniform under every filter, footprint and border that has no black.
#[test]
fn filters_keep_constants() {
    let texels = Arc::new(Texels::from_fn(13, 7, 3, |_, _, c| 0.25 * (c + 1) as f32));
    let mut rng = Rng::new(13, 1);
    for filter in FILTERS {
        for wrap in [WrapMode::Repeat, WrapMode::Clamp, WrapMode::OctahedralSphere] {
            let map = image_map(&texels, filter, wrap);
            for _ in 0..200 {
                let mut scaled = || (2.0 * rng.next_f32() - 1.0) * 10.0_f32.powf(-4.0 + 4.5 * rng.next_f32());
                let c = Coordinates2 {
                    st: Point2::new(3.0 * scaled(), 3.0 * scaled()),
                    dsdx: scaled(),
                    dsdy: scaled(),
                    dtdx: scaled(),
                    dtdy: scaled(),
                };
                let rgb = map.lookup::<3>(&c);
                let error = (0..3).map(|i| (rgb[i] - 0.25 * (i + 1) as f32).abs()).fold(0.0_f32, f32::max);
                assert!(error < 1e-4, "{filter:?} {wrap:?} {c:?}: {rgb:?}");
            }
        }
    }
}

/// Under a footprint as large as the picture, its mean is seen; each level of the pyramid keeps it, whatever its size.
#[test]
fn wide_footprints_see_the_mean() {
    let mut rng = Rng::new(14, 1);
    for (width, height) in [(16, 16), (13, 7), (1, 9), (1, 1)] {
        let texels = Arc::new(Texels::from_fn(width, height, 1, |_, _, _| rng.next_f32()));
        let n = (width * height) as f32;
        let mean = (0..width * height).map(|i| texels.texel(i % width, i / width, 0)).sum::<f32>() / n;
        for filter in [ImageFilter::Trilinear, ImageFilter::Ewa] {
            let map = image_map(&texels, filter, WrapMode::Repeat);
            let c = Coordinates2 { st: Point2::new(0.3, 0.4), dsdx: 40.0, dsdy: 0.0, dtdx: 0.0, dtdy: 40.0 };
            let [found] = map.lookup::<1>(&c);
            assert!((found - mean).abs() < 1e-5, "{filter:?} {width} x {height}: {found} but {mean}");
        }
    }
}

/// A footprint that is long in one direction blurs along it and keeps detail across: stripes survive the elliptic
/// filter, but not the trilinear one, which knows circles only.
#[test]
fn elliptic_filter_keeps_detail_across() {
    let texels = Arc::new(Texels::from_fn(64, 64, 1, |_, y, _| if y / 4 % 2 == 0 { 1.0 } else { 0.0 }));
    let c = |t: f32| Coordinates2 {
        st: Point2::new(0.5, t),
        dsdx: 8.0 / 64.0,
        dsdy: 0.0,
        dtdx: 0.0,
        dtdy: 1.0 / 64.0,
    };
    let contrast = |filter: ImageFilter| {
        let map = image_map(&texels, filter, WrapMode::Repeat);
        let [a] = map.lookup::<1>(&c(2.0 / 64.0));
        let [b] = map.lookup::<1>(&c(6.0 / 64.0));
        (a - b).abs()
    };
    assert!(contrast(ImageFilter::Ewa) > 0.9, "{}", contrast(ImageFilter::Ewa));
    assert!(contrast(ImageFilter::Trilinear) < 0.2, "{}", contrast(ImageFilter::Trilinear));
}

/// The loaded picture is held once, as loaded; coarser levels exist only for filters that use them.
#[test]
fn memory_is_held_once() {
    let texels = gray(64, 64, &[7; 64 * 64]);
    let mut textures = Textures::default();
    let id = textures.add_image("a.png", &texels, ImageOptions::default());
    assert_eq!(id, textures.add_image("a.png", &texels, ImageOptions::default()));
    assert_eq!(textures.image(id).n_levels(), 1);
    assert_eq!(Arc::strong_count(&texels), 2);
    let options = ImageOptions { filter: ImageFilter::Ewa, ..ImageOptions::default() };
    let filtered = textures.add_image("a.png", &texels, options);
    assert_ne!(id, filtered);
    assert_eq!(textures.image(filtered).n_levels(), 7);
}

/// Gray reflects all wavelengths alike, white light is the illuminant, and values above 1 are kept where they may be.
#[test]
fn images_become_spectra_by_role() {
    let mut assets = Assets::default();
    let halves = |value: f32| Arc::new(Texels::from_fn(2, 2, 3, |_, _, _| value));
    assets.images.insert("half.exr".to_owned(), halves(0.5));
    assets.images.insert("three.exr".to_owned(), halves(3.0));
    let value = |file: &str, role: SpectrumRole| {
        let entity = Entity::new("imagemap").with("filename", strings(file));
        let (mut textures, texture, n_problems) = read_spectrum(&entity, &assets, role);
        assert_eq!(n_problems, 0);
        let found = textures.eval_spectrum(texture, &at_uv(0.4, 0.6), &lambda());
        let id = textures.spectra.illuminant(ColorSpaceName::Srgb);
        (found.to_array(), textures.spectra.sample(id, &lambda()).to_array())
    };
    let near = |a: f32, b: f32| (a - b).abs() < 2e-3 * b.max(1.0);
    let (albedo, white) = value("half.exr", SpectrumRole::Albedo);
    assert!(albedo.iter().all(|x| near(*x, 0.5)), "{albedo:?}");
    let (clamped, _) = value("three.exr", SpectrumRole::Albedo);
    assert!(clamped.iter().all(|x| near(*x, 1.0)), "{clamped:?}");
    let (unbounded, _) = value("three.exr", SpectrumRole::Unbounded);
    assert!(unbounded.iter().all(|x| near(*x, 3.0)), "{unbounded:?}");
    let (light, _) = value("three.exr", SpectrumRole::Illuminant);
    assert!(light.iter().zip(&white).all(|(x, w)| near(*x, 3.0 * w)), "{light:?} {white:?}");
}

/// A red picture reflects more at 650 nm than at 450 nm.
#[test]
fn colours_keep_their_hue() {
    let mut assets = Assets::default();
    let red = Arc::new(Texels::from_fn(1, 1, 3, |_, _, c| if c == 0 { 0.8 } else { 0.05 }));
    assets.images.insert("red.exr".to_owned(), red);
    let entity = Entity::new("imagemap").with("filename", strings("red.exr"));
    let (textures, texture, _) = read_spectrum(&entity, &assets, SpectrumRole::Albedo);
    let lambda = Wavelengths::from_parts([450.0, 500.0, 600.0, 650.0], [1.0; 4]);
    let [blue, _, _, red] = textures.eval_spectrum(texture, &at_uv(0.5, 0.5), &lambda).to_array();
    assert!(red > 0.7 && blue < 0.15, "{red} {blue}");
}

/// Scaling comes before inversion, and neither makes light negative.
#[test]
fn scale_and_invert() {
    let mut assets = Assets::default();
    assets.images.insert("a.png".to_owned(), gray(1, 1, &[102]));
    let value = |scale: f32, invert: bool| {
        let entity = Entity::new("imagemap")
            .with("filename", strings("a.png"))
            .with("encoding", strings("linear"))
            .with("scale", floats(&[scale]))
            .with("invert", Value::Bools(vec![invert]));
        let (textures, texture, n_problems) = read_float(&entity, &assets);
        assert_eq!(n_problems, 0);
        textures.eval_float(texture, &at_uv(0.5, 0.5))
    };
    assert!((value(1.0, false) - 0.4).abs() < 1e-6);
    assert!((value(2.0, true) - 0.2).abs() < 1e-6);
    assert_eq!(value(5.0, true), 0.0);
}

// Building.

/// Textures refer to earlier ones by name; one that yields spectra is there for every role.
#[test]
fn textures_are_found_by_name() {
    let assets = Assets::default();
    let mut context = BuildContext::new(&assets);
    let mut textures = Textures::default();
    let entity = |name: &str, value: TextureValue, entity: Entity| TextureEntity {
        name: name.to_owned(),
        value,
        world_from_texture: Transform::IDENTITY,
        entity,
    };
    let checks = Entity::new("checkerboard")
        .with("tex1", Value::Rgb(vec![[2.0, 2.0, 2.0]]))
        .with("tex2", Value::Texture("dark".to_owned()));
    let dark = Entity::new("constant").with("value", Value::Rgb(vec![[0.5, 0.5, 0.5]]));
    textures.define(&entity("dark", TextureValue::Spectrum, dark), &mut context);
    textures.define(&entity("checks", TextureValue::Spectrum, checks), &mut context);
    let amount = Entity::new("constant").with("value", floats(&[0.5]));
    textures.define(&entity("amount", TextureValue::Float, amount), &mut context);
    assert_eq!(context.float_textures["amount"], FloatTexture::Constant(0.5));
    assert!(context.diagnostics.list().is_empty(), "{:?}", context.diagnostics.list());
    textures.spectra = context.spectra.clone();
    let value = |role: SpectrumRole, u: f32| {
        let texture = context.spectrum_textures[&("checks".to_owned(), role)];
        textures.eval_spectrum(texture, &at_uv(u, 0.5), &lambda()).to_array()[0]
    };
    assert!((value(SpectrumRole::Unbounded, 0.5) - 2.0).abs() < 1e-3);
    assert!((value(SpectrumRole::Albedo, 0.5) - 1.0).abs() < 1e-3);
    assert!((value(SpectrumRole::Albedo, 1.5) - 0.5).abs() < 1e-3);
}

/// What cannot be built is reported once, with a hint.
#[test]
fn problems_are_reported() {
    let assets = Assets::default();
    let n_problems = |entity: Entity| read_float(&entity, &assets).2;
    assert_eq!(n_problems(Entity::new("checkerbord")), 1);
    assert_eq!(n_problems(Entity::new("ptex").with("filename", strings("a.ptx"))), 1);
    assert_eq!(n_problems(Entity::new("imagemap")), 1);
    assert_eq!(n_problems(Entity::new("imagemap").with("filename", strings("missing.png"))), 1);
    assert_eq!(n_problems(Entity::new("checkerboard").with("dimension", Value::Integers(vec![4]))), 1);
    assert_eq!(n_problems(Entity::new("mix").with("amont", floats(&[0.5]))), 1);
    assert_eq!(n_problems(Entity::new("bilerp").with("mapping", strings("conical"))), 1);
    assert_eq!(n_problems(Entity::new("fbm").with("octaves", Value::Integers(vec![-1]))), 1);
    let mut context = BuildContext::new(&assets);
    let entity = TextureEntity {
        name: "a".to_owned(),
        value: TextureValue::Spectrum,
        world_from_texture: Transform::IDENTITY,
        entity: Entity::new("wrinkled"),
    };
    Textures::default().define(&entity, &mut context);
    assert_eq!(context.diagnostics.list().len(), 1, "once, not once for each role");
}

/// Every kind in the tables can be built from its defaults, and asks only for parameters that its table lists.
#[test]
fn tables_list_what_is_asked_for() {
    let mut assets = Assets::default();
    assets.images.insert("a.png".to_owned(), gray(1, 1, &[1]));
    for (value, table) in [("float", FLOAT_TEXTURES), ("spectrum", SPECTRUM_TEXTURES)] {
        for (name, specs) in table {
            let mut entity = Entity::new(*name);
            for spec in *specs {
                let given = match (spec.name, spec.kind) {
                    ("filename", _) => strings("a.png"),
                    ("mapping", _) => strings("planar"),
                    ("wrap", _) => strings("clamp"),
                    ("filter", _) => strings("EWA"),
                    ("encoding", _) => strings("gamma 2.2"),
                    (_, "integer") => Value::Integers(vec![3]),
                    (_, "bool") => Value::Bools(vec![true]),
                    (_, "vector3") => Value::Vectors3(vec![Vector3::new(0.0, 0.0, 1.0)]),
                    _ => floats(&[0.5]),
                };
                // These belong to other mappings than the planar one, or to fewer dimensions.
                if matches!(spec.name, "uscale" | "vscale" | "dimension") {
                    continue;
                }
                entity = entity.with(spec.name, given);
            }
            let n_problems = if value == "float" {
                read_float(&entity, &assets).2
            } else {
                read_spectrum(&entity, &assets, SpectrumRole::Albedo).2
            };
            assert_eq!(n_problems, 0, "{value} texture \"{name}\"");
        }
    }
}
