use super::*;

fn events(word: &str) -> Vec<Event> {
    word.chars()
        .map(|letter| match letter {
            'D' => Event::Diffuse,
            'S' => Event::Specular,
            's' => Event::SharpGlossy,
            'd' => Event::WideGlossy,
            'V' => Event::Volume,
            other => panic!("no event {other}"),
        })
        .collect()
}

#[track_caller]
fn check(expression: &str, matching: &[&str], others: &[&str]) {
    let compiled = PathExpression::new(expression).expect("a good expression");
    for word in matching {
        assert!(compiled.matches(&events(word)), "{expression} should match L{word}E");
    }
    for word in others {
        assert!(!compiled.matches(&events(word)), "{expression} should not match L{word}E");
    }
}

/// The operators of LPE-2 select the paths of the literature's classes (LPE-3).
#[test]
fn classes_of_the_literature() {
    check("LD?E", &["", "D"], &["S", "DD", "SD"]);
    check("LD*E", &["", "D", "DDDD"], &["S", "DSD"]);
    check("LD?S*E", &["", "D", "DS", "DSSS", "S"], &["SD", "DDS"]);
    check("LS+DE", &["SD", "SSSD"], &["D", "DD", "SDD", "DSD"]);
    check("LDD+E", &["DD", "DDD"], &["D", "SD"]);
    check("L(S|D)*SDS+E", &["SDS", "DSDSS"], &["SD", "DS", "DDS"]);
    check("L(S|D)+DE", &["SD", "DD", "SSD"], &["D", "S"]);
    check("L[SD]{2}E", &["SD", "DD", "SS"], &["D", "SDS"]);
    check("L.{1}E", &["S", "D", "V", "s"], &["", "SS"]);
}

/// Words are read from the light to the eye although a path finds them backwards.
#[test]
fn direction_matters() {
    check("LSDE", &["SD"], &["DS"]);
}

/// Glossy events divide between S and D by their width unless the expression speaks of G.
#[test]
fn glossy_events() {
    check("LSE", &["S", "s"], &["D", "d"]);
    check("LDE", &["D", "d"], &["S", "s"]);
    check("LGE", &["s", "d"], &["S", "D"]);
    check("L(S|G)E", &["S", "s", "d"], &["D"]);
    check("L[DG]E", &["D", "s", "d"], &["S"]);
    check("L(S|D)*E", &["", "sdSD", "ddss"], &["V"]);
    assert_eq!(Event::glossy(0.05, SHARP_ALPHA), Event::SharpGlossy);
    assert_eq!(Event::glossy(0.5, SHARP_ALPHA), Event::WideGlossy);
}

/// Slips are refused with a reason.
#[test]
fn refusals() {
    for bad in ["LXE", "L(DE", "LD*", "D*E", "L[SE", "L{E", "LD**)E"] {
        assert!(PathExpression::new(bad).is_err(), "{bad}");
    }
    let twice = [("a".to_owned(), "LE".to_owned()), ("a".to_owned(), "LDE".to_owned())];
    assert!(PathExpressions::new(&twice).is_err());
    let no_word = [("a b".to_owned(), "LE".to_owned())];
    assert!(PathExpressions::new(&no_word).is_err());
}

/// A recorder puts each contribution into every layer whose expression selects it, and into no other.
#[test]
fn recorder_routes_light() {
    let named: Vec<(String, String)> = [("all", "L(S|D)*E"), ("direct", "LDE"), ("caustic", "LS+DE")]
        .map(|(n, e)| (n.to_owned(), e.to_owned()))
        .to_vec();
    let expressions = PathExpressions::new(&named).expect("good expressions");
    let mut recorder = expressions.recorder();
    recorder.emit(Sampled::splat(1.0));
    recorder.emit_through(Event::Diffuse, Sampled::splat(2.0));
    recorder.scatter(Event::Diffuse);
    recorder.emit(Sampled::splat(4.0));
    recorder.scatter(Event::Specular);
    recorder.emit(Sampled::splat(8.0));
    assert_eq!(recorder.radiance(), [15.0, 6.0, 8.0].map(Sampled::splat));
}
