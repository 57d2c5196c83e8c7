use crate::{
    Channel, Chromaticities, DecodeTable, Encoding, Image, TexelData, Texels, box_downsample, luminance,
    pq_decode, pq_encode, srgb_decode, srgb_encode,
};

/// White has luminance 1 whatever the primaries' weights.
#[test]
fn luminance_weights_sum_to_one() {
    assert!((luminance([1.0; 3]) - 1.0).abs() < 1e-6);
    assert_eq!(luminance([0.0, 1.0, 0.0]), 0.7152);
}

/// The standard's own numbers: mid gray of the encoded scale reflects 21.4 % of the light.
#[test]
fn srgb_known_values() {
    assert_eq!(srgb_decode(0.0), 0.0);
    assert_eq!(srgb_decode(1.0), 1.0);
    assert!((srgb_decode(0.5) - 0.214_041_14).abs() < 1e-7);
    assert!((srgb_encode(0.18) - 0.461_356_13).abs() < 1e-6);
    assert_eq!(srgb_encode(0.002), 0.002 * 12.92);
}

/// Encoding undoes decoding for every byte and for values in between, on both pieces.
#[test]
fn srgb_round_trip() {
    for byte in 0..=255u32 {
        let stored = byte as f32 / 255.0;
        let back = srgb_encode(srgb_decode(stored));
        assert_eq!((back * 255.0).round() as u32, byte);
    }
    for i in 0..=10_000 {
        let linear = i as f32 / 10_000.0;
        assert!((srgb_decode(srgb_encode(linear)) - linear).abs() < 1e-6, "at {linear}");
    }
}

/// More light never gives a smaller code, also across the joint of the two pieces.
#[test]
fn srgb_is_monotone() {
    let codes: Vec<f32> = (0..=20_000).map(|i| srgb_encode(i as f32 / 20_000.0)).collect();
    assert!(codes.is_sorted());
}

/// Scene files name encodings by words.
#[test]
fn encodings_parse() {
    assert_eq!(Encoding::parse("sRGB"), Some(Encoding::Srgb));
    assert_eq!(Encoding::parse("linear"), Some(Encoding::Linear));
    assert_eq!(Encoding::parse("gamma 2.2"), Some(Encoding::Gamma(2.2)));
    for wrong in ["", "gamma", "gamma x", "gamma -1", "linear 2", "srgb2"] {
        assert_eq!(Encoding::parse(wrong), None, "{wrong}");
    }
    assert!((Encoding::Gamma(2.2).decode(Encoding::Gamma(2.2).encode(0.3)) - 0.3).abs() < 1e-6);
}

/// Layers are channels that share a prefix; taking one out and putting it back changes nothing.
#[test]
fn layers_by_prefix() {
    let mut image = Image::rgb(2, 1, vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    image.set_rgb("direct.glossy", &[[7.0; 3], [8.0; 3]]);
    image.set_channel("N.X", vec![0.5, 0.25]);
    image.metadata.insert("samples".to_owned(), "16".to_owned());
    assert_eq!(image.layers(), ["", "direct.glossy", "N"]);
    let layer = image.layer("direct.glossy").expect("the layer was just set");
    assert_eq!(layer.rgb_pixels(), Some(vec![[7.0; 3], [8.0; 3]]));
    assert_eq!(layer.metadata["samples"], "16");
    assert_eq!(image.layer("").map(|main| main.channels.len()), Some(3));
    assert_eq!(image.layer("direct"), None);
    assert_eq!(image.layer_rgb("N"), None);
    let mut again = image.layer("").expect("the picture itself");
    again.add_layer("direct.glossy", &layer);
    again.add_layer("N", &image.layer("N").expect("a layer of normals"));
    assert_eq!(again, image);
}

/// A gray image shows equal red, green and blue.
#[test]
fn gray_as_rgb() {
    assert_eq!(Image::gray(1, 2, vec![0.25, 4.0]).rgb_pixels(), Some(vec![[0.25; 3], [4.0; 3]]));
    let depth =
        Image { channels: vec![Channel { name: "Z".to_owned(), values: vec![1.0] }], ..Image::new(1, 1) };
    assert_eq!(depth.rgb_pixels(), None);
}

/// Averaging conserves the mean where the blocks fit, and edge blocks average only what they hold.
#[test]
fn box_downsample_conserves_energy() {
    let image = Image::from_fn(6, 4, |x, y| [x as f32, y as f32, (x * y) as f32]);
    let small = box_downsample(&image, 2);
    assert_eq!((small.width, small.height), (3, 2));
    let mean = |image: &Image| {
        image
            .channels
            .iter()
            .map(|c| c.values.iter().sum::<f32>() / c.values.len() as f32)
            .collect::<Vec<_>>()
    };
    assert_eq!(mean(&image), mean(&small));
    assert_eq!(small.rgb_pixels().map(|pixels| pixels[1]), Some([2.5, 0.5, 1.25]));
    let ragged = box_downsample(&Image::gray(3, 1, vec![1.0, 3.0, 7.0]), 2);
    assert_eq!(ragged.channels[0].values, [2.0, 7.0]);
    assert_eq!(box_downsample(&image, 1), image);
}

/// A byte texture costs a byte per value and is decoded by a table; alpha is never decoded.
#[test]
fn bytes_decode_by_table() {
    let texels = Texels::new(2, 1, 4, TexelData::U8(vec![255, 128, 0, 128, 1, 2, 3, 255]));
    let table = DecodeTable::new(Encoding::Srgb);
    assert_eq!(texels.n_bytes(), 8);
    assert_eq!(texels.texel(0, 0, 1), 128.0 / 255.0);
    assert_eq!(texels.linear(0, 0, 1, &table), srgb_decode(128.0 / 255.0));
    assert_eq!(texels.linear(0, 0, 3, &table), 128.0 / 255.0);
    assert_eq!(texels.alpha(0, 0), 128.0 / 255.0);
    assert_eq!(texels.linear_rgb(0, 0, &table), [1.0, srgb_decode(128.0 / 255.0), 0.0]);
    let image = texels.to_image(Encoding::Srgb);
    assert_eq!(image.channel("A").map(|alpha| alpha.values[1]), Some(1.0));
}

/// Sixteen-bit integers are encoded as bytes are, only finer.
#[test]
fn wide_integers_decode() {
    let texels = Texels::new(1, 1, 1, TexelData::U16(vec![32768]));
    let table = DecodeTable::new(Encoding::Srgb);
    assert_eq!(texels.texel(0, 0, 0), 32768.0 / 65535.0);
    assert_eq!(texels.linear(0, 0, 0, &table), srgb_decode(32768.0 / 65535.0));
    assert_eq!(texels.alpha(0, 0), 1.0);
}

/// Floats and halves are light already, so the encoding does not touch them.
#[test]
fn floats_are_linear() {
    let table = DecodeTable::new(Encoding::Srgb);
    let texels = Texels::from_fn(3, 2, 3, |x, y, c| (x + 10 * y + 100 * c) as f32);
    assert_eq!(texels.linear_rgb(2, 1, &table), [12.0, 112.0, 212.0]);
    let half = texels.clone().compact();
    assert!(matches!(half.data(), TexelData::F16(_)), "small integers are halves");
    assert_eq!(half.n_bytes() * 2, texels.n_bytes());
    assert_eq!(half.to_linear(Encoding::Srgb), texels);
}

/// Halves have eleven bits of precision and end at 65504; what they cannot hold stays float.
#[test]
fn half_conversion() {
    let third = Texels::from_fn(1, 1, 1, |_, _, _| 1.0 / 3.0);
    assert_eq!(third.clone().compact(), third);
    let rounded = third.to_half(Encoding::Linear).texel(0, 0, 0);
    assert!((rounded * 3.0 - 1.0).abs() < 1.0 / 2048.0);
    assert_ne!(rounded, 1.0 / 3.0);
    let bright = Texels::from_fn(1, 1, 1, |_, _, _| 1e5);
    assert_eq!(bright.clone().compact(), bright);
    assert_eq!(bright.to_half(Encoding::Linear).texel(0, 0, 0), f32::INFINITY);
}

/// Gray is the average of light, not of codes, and leaves alpha out.
#[test]
fn gray_averages_light() {
    let texels = Texels::new(1, 1, 4, TexelData::U8(vec![255, 0, 0, 7]));
    let gray = texels.to_gray(Encoding::Srgb);
    assert_eq!((gray.n_channels(), gray.texel(0, 0, 0)), (1, 1.0 / 3.0));
}

/// The primaries of a file stay with its texels through conversions.
#[test]
fn chromaticities_travel() {
    let mut texels = Texels::from_fn(1, 1, 3, |_, _, c| c as f32);
    texels.color_space = Some(Chromaticities::ACES2065_1);
    assert_eq!(texels.to_linear(Encoding::Srgb).color_space, texels.color_space);
    assert_eq!(texels.compact().color_space, Some(Chromaticities::ACES2065_1));
}

/// The curve of SMPTE ST 2084 at luminances for which its table is published: 0, 100, 1000 and 10,000 cd/m².
#[test]
fn perceptual_quantizer() {
    for (luminance, code) in [(0.0, 7.3e-7), (100.0, 0.508_078), (1000.0, 0.751_827), (10_000.0, 1.0)] {
        assert!((pq_encode(luminance) - code).abs() < 1e-6, "{luminance}: {}", pq_encode(luminance));
        let back = pq_decode(pq_encode(luminance));
        assert!((back - luminance).abs() <= 1e-5 * luminance + 1e-6, "{luminance}: {back}");
    }
    assert_eq!([pq_decode(-1.0), pq_decode(2.0)], [0.0, 10_000.0]);
    assert_eq!(
        [pq_encode(f32::INFINITY), pq_encode(f32::NAN), pq_encode(-1.0)],
        [1.0, pq_encode(0.0), pq_encode(0.0)]
    );
}
