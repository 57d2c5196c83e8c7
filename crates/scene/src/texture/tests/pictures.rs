//! Textures that show pictures.

use super::*;

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
        (WrapMode::Mirror, 0.2, 1.0),
    ] {
        assert!((value(wrap, -0.25) - before).abs() < 1e-6, "{wrap:?}: {}", value(wrap, -0.25));
        assert!((value(wrap, 1.25) - after).abs() < 1e-6, "{wrap:?}: {}", value(wrap, 1.25));
        assert!((value(wrap, 0.25) - 0.2).abs() < 1e-6);
    }
    assert!((value(WrapMode::Repeat, 1000.25) - 0.2).abs() < 1e-6);
    assert!((value(WrapMode::Mirror, 1.75) - 0.2).abs() < 1e-6);
    assert!((value(WrapMode::Mirror, 1001.75) - 0.2).abs() < 1e-6);
}

/// Numbers come from the channel that is asked for, which alpha is where there is one, and may be cut to 0 and 1.
#[test]
fn channels() {
    let texels = |n_channels: usize| {
        let texel = [51, 102, 153, 204];
        let texel = if n_channels == 2 { vec![51, 204] } else { texel[..n_channels].to_vec() };
        let mut assets = Assets::default();
        let picture = Texels::new(1, 1, n_channels, TexelData::U8(texel));
        assets.images.insert("a.png".to_owned(), Arc::new(picture));
        assets
    };
    let entity =
        Entity::new("imagemap").with("filename", strings("a.png")).with("encoding", strings("linear"));
    let value = |entity: &Entity, n_channels: usize| {
        let (textures, texture, n_problems) = read_float(entity, &texels(n_channels));
        assert_eq!(n_problems, 0);
        textures.eval_float(texture, &at_uv(0.3, 0.6))
    };
    let with = |channel: &str| entity.clone().with("channel", strings(channel));
    for (channel, n_channels, expected) in [
        ("r", 4, 0.2),
        ("g", 4, 0.4),
        ("b", 4, 0.6),
        ("a", 4, 0.8),
        ("b", 3, 0.6),
        ("a", 3, 1.0),
        ("g", 2, 0.2),
        ("a", 2, 0.8),
        ("b", 1, 0.2),
        ("a", 1, 1.0),
        ("", 4, 0.2),
    ] {
        let found = value(&with(channel), n_channels);
        assert!((found - expected).abs() < 1e-6, "{channel} of {n_channels}: {found} but {expected}");
    }
    let cut =
        |cutoff: f32| value(&with("g").with("scale", floats(&[0.5])).with("cutoff", floats(&[cutoff])), 4);
    assert_eq!((cut(0.19), cut(0.21)), (1.0, 0.0));
}

/// A tint multiplies the linear colours of a picture: white under a tint is the tint.
#[test]
fn tints() {
    let assets = |texel: [u8; 3]| {
        let mut assets = Assets::default();
        let picture = Texels::new(1, 1, 3, TexelData::U8(texel.to_vec()));
        assets.images.insert("a.png".to_owned(), Arc::new(picture));
        assets
    };
    let entity =
        Entity::new("imagemap").with("filename", strings("a.png")).with("encoding", strings("linear"));
    let eval = |entity: &Entity, texel: [u8; 3]| {
        let (textures, texture, n_problems) = read_spectrum(entity, &assets(texel), SpectrumRole::Albedo);
        assert_eq!(n_problems, 0);
        textures.eval_spectrum(texture, &at_uv(0.5, 0.5), &lambda())
    };
    let tint = Value::Rgb(vec![[0.2, 0.4, 0.6]]);
    assert_eq!(eval(&entity.clone().with("tint", tint), [255; 3]), eval(&entity, [51, 102, 153]));
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
        let options = ImageOptions { encoding, wrap: [WrapMode::Clamp; 2], ..ImageOptions::default() };
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

/// Paths that carry bands see the colours of the file, those that no smooth spectrum has too, limited where reflectances
/// are; at wavelengths the same texture has another value.
#[test]
fn bands_see_the_colours_of_the_file() {
    let mut assets = Assets::default();
    let color = [1.5, 0.02, 0.0];
    assets.images.insert("red.exr".to_owned(), Arc::new(Texels::from_fn(1, 1, 3, |_, _, c| color[c])));
    let entity = Entity::new("imagemap").with("filename", strings("red.exr"));
    let roles = [SpectrumRole::Albedo, SpectrumRole::Unbounded, SpectrumRole::Illuminant];
    for (role, expected) in roles.into_iter().zip([[1.0, 0.02, 0.0], color, color]) {
        let (textures, texture, _) = read_spectrum(&entity, &assets, role);
        let bands = Wavelengths::bands(0.5);
        let value = textures.eval_spectrum(texture, &at_uv(0.4, 0.6), &bands);
        let rgb = bands.estimate_bands(value).expect("a path that carries bands");
        assert!((0..3).all(|c| (rgb[c] - expected[c]).abs() < 1e-3), "{role:?}: {rgb:?}");
        let at_wavelengths = textures.eval_spectrum(texture, &at_uv(0.4, 0.6), &lambda());
        assert!((at_wavelengths - value).map(f32::abs).max_value() > 0.1);
    }
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
