//! Curves of displays and films, channel by channel: bright colours go to white, as film does. All expect middle grey at 0.18
//! and give linear light in [0, 1].

/// Which curve.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum DisplayCurve {
    /// Hable 2010, "Uncharted 2: HDR Lighting": toe, straight part and shoulder of film.
    Filmic,
    /// The reference and output transforms of ACES 1.x for sRGB as fitted by Hill, "`BakingLab`" 2016.
    Aces,
    /// Sobotka's `AgX` base look, with the fit of its curve by Wrensch 2023, "Minimal `AgX` Implementation".
    Agx,
}

impl DisplayCurve {
    /// One pixel of non-negative, finite values.
    pub(super) fn map(self, pixel: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Filmic => pixel.map(|value| hable(2.0 * value) / hable(11.2)),
            Self::Aces => aces(pixel),
            Self::Agx => agx(pixel),
        }
        .map(|value| value.clamp(0.0, 1.0))
    }
}

type Matrix = [[f64; 3]; 3];

fn transform(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Shoulder strength A to toe denominator F of the talk.
fn hable(x: f64) -> f64 {
    let [a, b, c, d, e, f] = [0.15, 0.50, 0.10, 0.20, 0.02, 0.30];
    (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f
}

const ACES_IN: Matrix =
    [[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]];
const ACES_OUT: Matrix =
    [[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]];

fn aces(pixel: [f64; 3]) -> [f64; 3] {
    let curve =
        |v: f64| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081);
    transform(&ACES_OUT, transform(&ACES_IN, pixel).map(curve))
}

const AGX_IN: Matrix = [
    [0.842_479_062_253_094, 0.078_433_599_999_999_2, 0.079_223_745_147_764_3],
    [0.042_328_242_261_012_3, 0.878_468_636_469_772, 0.079_166_127_460_543_4],
    [0.042_375_654_905_705_1, 0.078_433_6, 0.879_142_973_793_104],
];
const AGX_OUT: Matrix = [
    [1.196_879_005_120_17, -0.098_020_881_140_136_8, -0.099_029_744_079_720_5],
    [-0.052_896_851_757_456_2, 1.151_903_129_904_17, -0.098_961_176_844_843_3],
    [-0.052_971_635_514_443_8, -0.098_043_450_117_124_1, 1.151_073_672_641_16],
];
/// Stops below and above 1 that the curve covers.
const AGX_EV: [f64; 2] = [-12.473_93, 4.026_069];
/// Coefficients of the curve, from the sixth power down.
const AGX_CURVE: [f64; 7] = [15.5, -40.14, 31.96, -6.868, 0.4298, 0.1191, -0.00232];

fn agx(pixel: [f64; 3]) -> [f64; 3] {
    let [low, high] = AGX_EV;
    let curve = |v: f64| {
        let x = ((v.max(1e-10).log2() - low) / (high - low)).clamp(0.0, 1.0);
        AGX_CURVE.iter().fold(0.0, |sum, coefficient| sum * x + coefficient)
    };
    // The curve ends at values for a display of gamma 2.2.
    transform(&AGX_OUT, transform(&AGX_IN, pixel).map(curve)).map(|value| value.max(0.0).powf(2.2))
}
