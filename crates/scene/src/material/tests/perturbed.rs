//! Bumps and normal maps.

use super::*;

/// A height that rises by s per metre turns the normal by atan s against the slope.
#[test]
fn bumps_tilt_the_normal() {
    let mut fixture = Fixture::default();
    let ramp = fixture.ramp(0.5);
    fixture.float_textures.insert("ramp".to_owned(), ramp);
    let entity = plain("diffuse").with("displacement", Value::Texture("ramp".to_owned()));
    let material = fixture.build_clean(&entity);
    let mut lambda = Wavelengths::sample_visible(0.5);
    let bsdf = fixture.bsdf(material, &context(), &mut lambda).unwrap();
    // 0.5 m per unit of u, which is 2 m long.
    let expected = Vector3::new(-0.25, 0.0, 1.0).normalized();
    assert!((bsdf.ns().as_vector() - expected).length() < 1e-3, "{:?}", bsdf.ns());
    assert_eq!(bsdf.ng(), Normal3::new(0.0, 0.0, 1.0));
    // The same with the step of a pixel.
    let mut ctx = context();
    ctx.texture.dudx = 0.02;
    let bsdf = fixture.bsdf(material, &ctx, &mut lambda).unwrap();
    assert!((bsdf.ns().as_vector() - expected).length() < 1e-3, "{:?}", bsdf.ns());
    // Seen from a flipped surface the normal stays on the side of the geometric one.
    let down = Normal3::new(0.0, 0.0, -1.0);
    let flipped = MaterialContext { ng: down, ns: down, ..ctx };
    let bsdf = fixture.bsdf(material, &flipped, &mut lambda).unwrap();
    assert!(bsdf.ns().z < 0.0);
}

/// Without slope, on a curved surface, a constant height keeps the normal.
#[test]
fn a_constant_height_keeps_the_normal() {
    let mut fixture = Fixture::default();
    let material = fixture.build_clean(&plain("diffuse").with("displacement", floats(0.1)));
    let ctx =
        MaterialContext { dndu: Vector3::new(1.0, 0.0, 0.0), dndv: Vector3::new(0.0, 0.5, 0.0), ..context() };
    let mut lambda = Wavelengths::sample_visible(0.5);
    let bsdf = fixture.bsdf(material, &ctx, &mut lambda).unwrap();
    assert!((bsdf.ns().as_vector() - Vector3::new(0.0, 0.0, 1.0)).length() < 1e-6);
}

/// A normal map's blue is the normal, red the first tangent, green the second; its top row is v = 1.
#[test]
fn normal_maps_turn_the_normal() {
    let encode = |n: Vector3| [0.5 * (n.x + 1.0), 0.5 * (n.y + 1.0), 0.5 * (n.z + 1.0)];
    let tilted = Vector3::new(0.6, 0.0, 0.8);
    let flat = Vector3::new(0.0, 0.0, 1.0);
    let texels = Texels::from_fn(4, 4, 3, |_, y, c| encode(if y < 2 { tilted } else { flat })[c]);
    let mut fixture = Fixture::default();
    fixture.assets.images.insert("n.png".to_owned(), Arc::new(texels));
    let entity = plain("diffuse").with("normalmap", strings("n.png"));
    let material = fixture.build_clean(&entity);
    let mut lambda = Wavelengths::sample_visible(0.5);
    let mut normal_at = |v: f32| {
        let mut ctx = context();
        ctx.texture.uv = Point2::new(0.3, v);
        fixture.bsdf(material, &ctx, &mut lambda).unwrap().ns().as_vector()
    };
    assert!((normal_at(0.75) - tilted).length() < 1e-5);
    assert!((normal_at(0.25) - flat).length() < 1e-5);
    // It repeats, and between rows it interpolates.
    assert!((normal_at(-0.25) - tilted).length() < 1e-5);
    assert!((normal_at(0.5) - (tilted + flat).normalized()).length() < 1e-4);
    // An image is held once, however many materials use it.
    let other = fixture.build_clean(&plain("conductor").with("normalmap", strings("n.png")));
    let perturbation = |id| fixture.materials.get(id).perturbation().copied();
    assert_eq!(perturbation(material), perturbation(other));
    // A grey image is no normal map.
    fixture.assets.images.insert("n.png".to_owned(), Arc::new(Texels::from_fn(1, 1, 1, |_, _, _| 0.5)));
    assert!(fixture.build(&entity).1.has_errors());
}

/// A texture of normals runs along u and v even where these are mirrored, and its relief may be scaled.
#[test]
fn normal_textures_follow_v() {
    let tilted = Vector3::new(0.0, 0.6, 0.8);
    let encoded = [tilted.x, tilted.y, tilted.z].map(|x| 0.5 * (x + 1.0));
    let mut fixture = Fixture::default();
    fixture
        .assets
        .images
        .insert("n.png".to_owned(), Arc::new(Texels::from_fn(1, 1, 3, |_, _, c| encoded[c])));
    let picture = plain("imagemap").with("filename", strings("n.png")).with("encoding", strings("linear"));
    let mut context_of_build = BuildContext::new(&fixture.assets);
    let texture = fixture.textures.build_spectrum(
        &mut Parameters::new(&picture, &mut context_of_build),
        &Transform::IDENTITY,
        SpectrumRole::Unbounded,
    );
    let mut normal = |scale: f32, mirrored: bool| {
        let entity = plain("principled").with("normaltexture", Value::Texture("n".to_owned()));
        let entity = entity.with("normalscale", floats(scale));
        let mut context_of_build = BuildContext::new(&fixture.assets);
        context_of_build.spectrum_textures.insert(("n".to_owned(), SpectrumRole::Unbounded), texture);
        let parameters = Parameters::new(&entity, &mut context_of_build);
        let material = fixture.materials.build(parameters, &fixture.named).expect("sound");
        assert!(context_of_build.diagnostics.list().is_empty(), "{:?}", context_of_build.diagnostics.list());
        let mut ctx = context();
        if mirrored {
            ctx.dpdv = -ctx.dpdv;
        }
        fixture.bsdf(material, &ctx, &mut Wavelengths::sample_visible(0.5)).unwrap().ns().as_vector()
    };
    let near = |a: Vector3, b: Vector3| assert!((a - b.normalized()).length() < 1e-5, "{a:?} is not {b:?}");
    near(normal(1.0, false), tilted);
    near(normal(1.0, true), Vector3::new(0.0, -0.6, 0.8));
    near(normal(0.5, false), Vector3::new(0.0, 0.3, 0.8));
}
