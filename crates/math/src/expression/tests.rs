use super::nodes::{Binary, Nodes};
use super::number::Number;
use super::*;
use crate::Rng;

fn parse(text: &str) -> Expression {
    let mut parameter = |name: &str| (name == "r").then_some(0.75);
    Expression::parse(text, &["x", "y", "z"], &mut parameter)
        .unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn error(text: &str) -> ExpressionError {
    Expression::parse(text, &["x", "y", "z"], &mut |_| None).expect_err(text)
}

/// Formulas that use all that there is, smooth and not, defined everywhere and not.
const FORMULAS: &[&str] = &[
    "x^2 + y^2 - z",
    "(x^2+y^2+z^2+r^2-0.1)^2 - 4*r^2*(x^2+y^2)",
    "sin(3*x)*cos(2*y) + sin(y)*cos(z) - cos(x)",
    "exp(-x*x) - log(y+2) * sqrt(z+1.5)",
    "min(length(x,y,z)-1, max(abs(x)-0.5, abs(y)-r, z))",
    "tan(x) / (y - 0.3)",
    "asin(x) + acos(y) * atan(z)",
    "atan2(y, x) - z",
    "sinh(x) - cosh(y) + tanh(z)",
    "pow(x+1.2, y) - z^-3 + x^5",
    "mod(x, 0.3) + floor(2*y) * z + sign(x-y)",
    "clamp(x, -0.2, 0.5) + mix(x, y, z) + smoothstep(-0.5, 0.5, x+y)",
    "if(x < y, x*z, y + 1) + (x >= 0 && y <= 0.2) - (!(z > 0) || x == y) + (x != z)",
    "(x^2 + 2.25*y^2 + z^2 - 1)^3 - x^2*z^3 - 0.1125*y^2*z^3",
    "x^0.5 + abs(y)^1.7",
    "if(sqrt(x) >= 0, 1, z)",
    "z + (sqrt(x) < 2) + sign(log(y))",
    "if(!(log(x) < y), z, -z) + (sqrt(y) && z) - (asin(2*x) || sqrt(z) == 1)",
    "min(sqrt(x), y) + max(z, log(y)) + pow(sqrt(z), 0 * x) + if(x < sqrt(y), 1, 2)",
    "cos(1e3*x) + sin(20*y+z)",
];

#[test]
fn values_follow_the_usual_rules() {
    let check = |text: &str, expected: f64| {
        let value = parse(text).value([2.0, 3.0, 5.0]);
        assert!((value - expected).abs() <= 1e-12 * expected.abs(), "{text} is {value}, not {expected}");
    };
    check("x + y * z", 17.0);
    check("(x + y) * z", 25.0);
    check("-x^2", -4.0);
    check("2^-x", 0.25);
    check("2^3^2", 512.0);
    check("x - y - z", -6.0);
    check("x / y / z", 2.0 / 15.0);
    check("--x + +y", 5.0);
    check("1.5e1 + .5 + 2e-1", 15.7);
    check("2*e + 3e0", 2.0 * std::f64::consts::E + 3.0);
    check("pi * tau / r", std::f64::consts::PI * std::f64::consts::TAU / 0.75);
    check("mod(-x, y)", 1.0);
    check("min(z, y, x) + max(x, y, z) * 10", 52.0);
    check("length(y, 4)", 5.0);
    check("if(x < y && !(z <= y), 7, 8)", 7.0);
    check("mix(x, z, 0.5) + clamp(9, 0, x) + smoothstep(0, 2, 1)", 6.0);
    check("1 < 2 == 1", 1.0);
    assert!(parse("log(-x)").value([1.0; 3]).is_nan());
    assert_eq!(parse("2*pi - tau").constant(), Some(0.0));
    // Equal parts are computed once.
    assert_eq!(parse("(x+y)*(y+x) + (x+y)").n_steps(), 5);
}

/// Every problem has its column and says what was expected or meant.
#[test]
fn errors_are_located() {
    let check = |text: &str, column: usize, message: &str| {
        let error = error(text);
        assert!(error.column == column && error.message.contains(message), "{text}: {error}");
    };
    check("", 1, "found the end");
    check("x + ", 5, "found the end");
    check("x + * y", 5, "found '*'");
    check("(x + y", 7, "expected \")\"");
    check("x + y)", 6, "found ')'");
    check("x y", 3, "expected an operator");
    check("2x", 2, "expected an operator");
    check("é + 1", 1, "unknown name");
    check("x + 1.2.3", 5, "not a number");
    check("1e999", 1, "not a number");
    check("sin", 1, "needs arguments");
    check("1 + sin()", 5, "takes 1 arguments, not 0");
    check("min()", 1, "takes 1 to 16 arguments");
    check("sin(x, y)", 1, "takes 1 arguments, not 2");
    check("sin(x; y)", 6, "expected \",\" or \")\"");
    check("x @ y", 3, "found '@'");
    let unknown = error("x + sni(y)");
    assert_eq!((unknown.column, unknown.unknown.as_deref()), (5, Some("sni")));
    assert!(unknown.known.iter().any(|name| name == "sin"));
    assert!(error("x + w").known.iter().any(|name| name == "z"));
}

/// Long and deep formulas end in an error, quickly, not in the stack.
#[test]
fn size_is_bounded() {
    assert!(error(&"x+".repeat(500_000)).message.contains("bytes"));
    assert!(error(&"(".repeat(60_000)).message.contains("deep"));
    assert!(error(&"-".repeat(60_000)).message.contains("deep"));
    assert!(error(&"2^".repeat(30_000)).message.contains("deep"));
    assert!(error(&"sin(".repeat(10_000)).message.contains("deep"));
    assert!(error(&"w".repeat(60_000)).message.len() < 100);
    let many: String = (0..11_000).map(|i| format!("x*{i}+")).collect();
    assert!(error(&format!("{many}1")[..]).message.contains("bytes"), "too long");
    let many: String = (0..6000).map(|i| format!("x^{i}.5+")).collect();
    assert!(error(&many[..many.len() - 1]).message.contains("steps"));
    // Without an operator in the outermost call: each argument of each call has many steps.
    let mut number = 0;
    let mut calls = |n: usize| {
        let call = |_| {
            number += 1;
            format!("smoothstep(x,y,{number})")
        };
        (0..n).map(call).collect::<Vec<_>>().join(",")
    };
    let rows: Vec<String> = (0..16).map(|_| format!("min({})", calls(16))).collect();
    let square = |rows: &[String]| format!("max({})", rows.join(","));
    let below = parse(&square(&rows)).n_steps();
    assert!(below < Nodes::MAX, "{below}");
    let more: Vec<String> =
        (0..8).map(|_| square(&(0..16).map(|_| format!("min({})", calls(16))).collect::<Vec<_>>())).collect();
    assert!(error(&square(&more)).message.contains("steps"));
    let sum = format!("{}1", "x+".repeat(10_000));
    assert_eq!(parse(&sum).value([1.0; 3]), 10_001.0);
}

fn boxes(rng: &mut Rng) -> ([Interval; 3], Vec<[f64; 3]>) {
    let size = [2.0, 0.3, 0.01, 0.0][rng.next_u32() as usize % 4];
    let sides: [Interval; 3] = std::array::from_fn(|_| {
        let middle = f64::from(rng.next_f32()) * 3.0 - 1.5;
        let half = size * f64::from(rng.next_f32());
        Interval::new(middle - half, middle + half)
    });
    let inside = (0..20)
        .map(|_| {
            std::array::from_fn(|i| {
                let Interval { low, high } = sides[i];
                (low + (high - low) * f64::from(rng.next_f32())).clamp(low, high)
            })
        })
        .collect();
    (sides, inside)
}

/// Intervals hold all values and all slopes in a box.
#[test]
fn intervals_hold_all_values() {
    for (seed, text) in FORMULAS.iter().enumerate() {
        let formula = parse(text);
        let mut rng = Rng::new(3, seed as u64);
        for _ in 0..2000 {
            let (sides, inside) = boxes(&mut rng);
            let range = formula.range(sides);
            let (value_range, slopes) = formula.gradient_range(sides);
            for p in inside {
                let (value, gradient) = formula.gradient(p);
                assert!(value.is_nan() && formula.value(p).is_nan() || value == formula.value(p), "{text}");
                if value.is_nan() {
                    continue;
                }
                assert!(
                    range.contains(value) && value_range.contains(value),
                    "{text}: {value} {range:?} {sides:?}"
                );
                for (slope, range) in gradient.iter().zip(slopes) {
                    assert!(
                        slope.is_nan() || range.contains(*slope),
                        "{text} at {p:?}: {slope} {range:?} {sides:?}"
                    );
                }
            }
        }
    }
}

/// What is not defined does not become so by a comparison: intervals, which leave such points out, would not hold the value.
#[test]
fn comparisons_of_nothing_give_nothing() {
    for text in [
        "if(sqrt(x) >= 0, 1, z)",
        "z + (sqrt(x) < 2)",
        "z + (sqrt(x) != 2)",
        "!log(x)",
        "log(x) || 1",
        "0 && log(x)",
        "sign(sqrt(x))",
        "min(sqrt(x), z)",
        "pow(1, sqrt(x))",
        "pow(sqrt(x), z - z)",
        "if(sqrt(x - 5), y, z)",
        "if(sqrt(-1), y, z)",
    ] {
        let formula = parse(text);
        let at = [-1.0, 0.5, 0.25];
        assert!(formula.value(at).is_nan() && formula.gradient(at).0.is_nan(), "{text}");
        assert!(formula.range(at.map(Interval::point)).is_empty(), "{text}");
        assert!(formula.gradient_range(at.map(Interval::point)).0.is_empty(), "{text}");
    }
    assert_eq!(parse("z + (sqrt(x) < 2)").value([1.0, 0.0, 0.25]), 1.25);
}

/// Differences between points of a box are within the slopes: jumps and kinks included.
#[test]
fn slopes_bound_differences() {
    for (seed, text) in FORMULAS.iter().enumerate() {
        let formula = parse(text);
        let mut rng = Rng::new(5, seed as u64);
        for _ in 0..1000 {
            let (sides, inside) = boxes(&mut rng);
            let (range, slopes) = formula.gradient_range(sides);
            for pair in inside.windows(2) {
                let change = formula.value(pair[1]) - formula.value(pair[0]);
                // Only where the formula is defined all over, or the line between may leave its domain.
                if change.is_nan() || !range.low.is_finite() || !range.high.is_finite() {
                    continue;
                }
                let mut bound = Interval::point(0.0);
                for i in 0..3 {
                    let step = Interval::point(pair[1][i] - pair[0][i]);
                    let part = Interval::binary(Binary::Mul, slopes[i], step);
                    bound = Interval::binary(Binary::Add, bound, part);
                }
                let slack = 1e-12 * (1.0 + range.magnitude());
                assert!(
                    bound.low - slack <= change && change <= bound.high + slack,
                    "{text}: {change} {bound:?} {sides:?}"
                );
            }
        }
    }
}

/// Gradients agree with differences.
#[test]
fn gradients_are_those_of_differences() {
    for (seed, text) in FORMULAS.iter().enumerate() {
        let formula = parse(text);
        let mut rng = Rng::new(7, seed as u64);
        let (mut n_good, mut n) = (0, 0);
        for _ in 0..500 {
            let p: [f64; 3] = std::array::from_fn(|_| f64::from(rng.next_f32()) * 2.0 - 1.0);
            let (value, gradient) = formula.gradient(p);
            for axis in 0..3 {
                let h = 1e-6;
                let at = |step: f64| {
                    let mut p = p;
                    p[axis] += step;
                    formula.value(p)
                };
                let expected = (at(h) - at(-h)) / (2.0 * h);
                if value.is_nan() || expected.is_nan() {
                    continue;
                }
                n += 1;
                let error = (gradient[axis] - expected).abs() / (1.0 + expected.abs());
                n_good += usize::from(error < 1e-3);
            }
        }
        // Jumps, kinks and poles may lie within the difference.
        assert!(n > 100 && n_good * 1000 >= n * 995, "{text}: {n_good} of {n}");
    }
}

/// Along a line, the slope is the gradient times the direction.
#[test]
fn slopes_along_lines_hold_the_gradient() {
    let mut rng = Rng::new(9, 0);
    for text in FORMULAS {
        let formula = parse(text);
        for _ in 0..300 {
            let (sides, inside) = boxes(&mut rng);
            let speeds: [f64; 3] = std::array::from_fn(|_| f64::from(rng.next_f32()) * 2.0 - 1.0);
            let (range, slope) = formula.slope_range(sides, speeds);
            for p in inside {
                let (value, gradient) = formula.gradient(p);
                let along: f64 = (0..3).map(|i| gradient[i] * speeds[i]).sum();
                if !value.is_nan() && along.is_finite() {
                    let slack = 1e-13 * gradient.iter().map(|g| g.abs()).sum::<f64>();
                    assert!(range.contains(value), "{text}");
                    assert!(
                        slope.low - slack <= along && along <= slope.high + slack,
                        "{text}: {along} {slope:?}"
                    );
                }
            }
        }
    }
}
