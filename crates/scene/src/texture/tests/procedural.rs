//! Textures that are computed.

use super::*;

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
