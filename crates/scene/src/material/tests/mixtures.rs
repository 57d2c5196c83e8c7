//! Mixtures.

use super::*;

/// A mixture shows its second material on as large a share of points as was asked, always the same at one point.
#[test]
fn mixtures_have_their_share() {
    let mut fixture = Fixture::default();
    fixture.name_default("matte");
    let glass = fixture.build_clean(&plain("dielectric"));
    fixture.named.insert("glass".to_owned(), glass);
    let names = Value::Strings(vec!["matte".to_owned(), "glass".to_owned()]);
    let share = |fixture: &Fixture, material: MaterialId| {
        let mut rng = Rng::new(7, 0);
        let n = 20_000;
        let count = (0..n)
            .filter(|_| {
                let mut ctx = context();
                ctx.texture.p.x = rng.next_f32();
                let chosen = fixture.materials.resolve(material, &fixture.textures, &ctx);
                assert_eq!(chosen, fixture.materials.resolve(material, &fixture.textures, &ctx));
                matches!(chosen, Material::Dielectric(_))
            })
            .count();
        count as f32 / n as f32
    };
    // 4.5 standard deviations of the worst case.
    let tolerance = (0.25_f32 / 20_000.0).sqrt() * 4.5;
    for amount in [0.0, 0.2, 0.5, 1.0] {
        let entity = plain("mix").with("materials", names.clone()).with("amount", floats(amount));
        let mix = fixture.build_clean(&entity);
        let found = share(&fixture, mix);
        assert!(
            (found - amount).abs() <= tolerance * f32::from(amount > 0.0 && amount < 1.0),
            "{found} {amount}"
        );
    }
    // A mixture of a mixture chooses anew: a quarter, not a half or nothing.
    let half = fixture.build_clean(&plain("mix").with("materials", names));
    fixture.named.insert("half".to_owned(), half);
    let nested = Value::Strings(vec!["matte".to_owned(), "half".to_owned()]);
    let nested = fixture.build_clean(&plain("mix").with("materials", nested));
    let found = share(&fixture, nested);
    assert!((found - 0.25).abs() < tolerance, "{found}");
}

/// A mixture that named itself or a later material could lead around in a circle.
#[test]
#[should_panic(expected = "a mixture names a material that is not there")]
fn mixtures_name_materials_before_them() {
    let mut materials = Materials::new();
    let first = materials.add(Material::default());
    let amount = FloatTexture::Constant(0.5);
    materials.add(Material::Mix(MixMaterial { materials: [first, MaterialId(1)], amount }));
}
