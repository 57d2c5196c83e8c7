use etendue_math::Rng;

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
    for taken in ["variance", "halfA", "halfB", "Albedo"] {
        let error = PathExpressions::new(&[(taken.to_owned(), "LE".to_owned())]).expect_err(taken);
        assert!(error.to_string().contains("another layer"), "{error}");
    }
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

/// An expression as a tree, matched by what its text means and nothing else.
enum Reference {
    /// One of these letters; all others if the class is negated.
    Class(Vec<char>, bool),
    Any,
    Sequence(Vec<Reference>),
    Choice(Vec<Reference>),
    Repeated(Box<Reference>, u32, Option<u32>),
}

fn below(rng: &mut Rng, n: u32) -> u32 {
    (rng.next_f64() * f64::from(n)) as u32
}

impl Reference {
    fn random(rng: &mut Rng, letters: &[char], depth: u32) -> Self {
        let parts =
            |rng: &mut Rng| (0..2 + below(rng, 2)).map(|_| Self::random(rng, letters, depth - 1)).collect();
        let letter = |rng: &mut Rng| letters[below(rng, letters.len() as u32) as usize];
        match below(rng, if depth == 0 { 4 } else { 10 }) {
            0 | 1 => Self::Class(vec![letter(rng)], false),
            2 => Self::Class(vec![letter(rng), letter(rng)], below(rng, 2) == 0),
            3 => Self::Any,
            4 | 5 => Self::Sequence(parts(rng)),
            6 | 7 => Self::Choice(parts(rng)),
            _ => {
                let least = below(rng, 3);
                let most = (below(rng, 2) == 0).then(|| least + below(rng, 3));
                Self::Repeated(Box::new(Self::random(rng, letters, depth - 1)), least, most)
            }
        }
    }

    fn text(&self) -> String {
        let texts = |parts: &[Self]| parts.iter().map(Self::text).collect::<Vec<_>>();
        match self {
            Self::Class(letters, false) if letters.len() == 1 => letters[0].to_string(),
            Self::Class(letters, is_negated) => {
                format!("[{}{}]", if *is_negated { "^" } else { "" }, String::from_iter(letters))
            }
            Self::Any => ".".to_owned(),
            Self::Sequence(parts) => format!("({})", texts(parts).concat()),
            Self::Choice(parts) => format!("({})", texts(parts).join("|")),
            Self::Repeated(part, least, most) => {
                let part = part.text();
                match (least, most) {
                    (0, None) => format!("({part})*"),
                    (1, None) => format!("({part})+"),
                    (0, Some(1)) => format!("({part})?"),
                    (least, None) => format!("({part}){{{least},}}"),
                    (least, Some(most)) if least == most => format!("({part}){{{least}}}"),
                    (least, Some(most)) => format!("({part}){{{least},{most}}}"),
                }
            }
        }
    }

    /// Where it may end, as bits, if it starts at one of these places of a word.
    fn ends(&self, word: &[Event], has_glossy: bool, starts: u32) -> u32 {
        let after = |part: &Self, starts| part.ends(word, has_glossy, starts);
        let step = |fits: &dyn Fn(Event) -> bool| {
            let fitting = (0..word.len()).filter(|i| starts >> i & 1 == 1 && fits(word[*i]));
            fitting.fold(0, |ends, i| ends | 1 << (i + 1))
        };
        match self {
            Self::Class(letters, is_negated) => {
                step(&|event| letters.iter().any(|l| is_letter(*l, event, has_glossy)) != *is_negated)
            }
            Self::Any => step(&|_| true),
            Self::Sequence(parts) => parts.iter().fold(starts, |starts, part| after(part, starts)),
            Self::Choice(parts) => parts.iter().fold(0, |ends, part| ends | after(part, starts)),
            Self::Repeated(part, least, most) => {
                let mut last = (0..*least).fold(starts, |starts, _| after(part, starts));
                let mut ends = last;
                for _ in 0..most.map_or(word.len() as u32, |most| most - least) {
                    last = after(part, last);
                    ends |= last;
                }
                ends
            }
        }
    }
}

/// Whether an event counts as a letter: glossy ones are `G` where the expression speaks of it, else `S` or `D` by their width.
fn is_letter(letter: char, event: Event, has_glossy: bool) -> bool {
    match event {
        Event::Diffuse => letter == 'D',
        Event::Specular => letter == 'S',
        Event::Volume => letter == 'V',
        Event::SharpGlossy => letter == if has_glossy { 'G' } else { 'S' },
        Event::WideGlossy => letter == if has_glossy { 'G' } else { 'D' },
    }
}

/// Automata select what a search through the expression's tree selects, on random expressions and random words (LPE-4).
#[test]
fn automata_agree_with_a_reference_matcher() {
    const EVENTS: [Event; 5] =
        [Event::Diffuse, Event::SharpGlossy, Event::WideGlossy, Event::Specular, Event::Volume];
    let mut rng = Rng::new(4, 0);
    let mut counts = [0_u32; 2];
    for index in 0..400 {
        let letters: &[char] = if index % 2 == 0 { &['D', 'S', 'V'] } else { &['D', 'S', 'G', 'V'] };
        let reference = Reference::random(&mut rng, letters, 3);
        let text = format!("L{}E", reference.text());
        let has_glossy = text.contains('G');
        let compiled = PathExpression::new(&text).expect("a good expression");
        for _ in 0..100 {
            let word: Vec<Event> =
                (0..below(&mut rng, 8)).map(|_| EVENTS[below(&mut rng, 5) as usize]).collect();
            let expected = reference.ends(&word, has_glossy, 1) >> word.len() & 1 == 1;
            assert_eq!(compiled.matches(&word), expected, "{text} and {word:?}");
            counts[usize::from(expected)] += 1;
        }
    }
    assert!(counts.iter().all(|n| *n > 2000), "{counts:?} did not match and matched");
}
