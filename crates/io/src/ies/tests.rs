//! Photometric files of every kind, right and wrong.

use etendue_math::{Rng, Vector3};

use super::*;

/// A file with these words after TILT=NONE.
fn file(header: &str, numbers: &str) -> String {
    format!("{header}[TEST] none\n[MANUFAC] a maker with a comma, and an umlaut ü\nTILT=NONE\n{numbers}")
}

/// One lamp, two vertical and one horizontal angle, type C, metres.
const SMALL: &str = "1 1000 2 2 1 1 2 0 0 0\n0.5 1 60\n0 90\n0\n100 40\n";

fn down(photometry: &Photometry) -> f32 {
    photometry.intensity(Vector3::new(0.0, 0.0, -1.0))
}

#[test]
fn files_of_all_editions_are_read() {
    for header in ["", "IESNA91\r\n", "IESNA:LM-63-1995\n", "IESNA:LM-63-2002\n", "IES:LM-63-2019\n"] {
        // Multiplier 2, ballast factor 0.5.
        assert_eq!(down(&read_ies(file(header, SMALL).as_bytes()).expect("it is a file")), 100.0);
    }
    let windows = file("IESNA91\n", SMALL).replace('\n', "\r\n");
    assert_eq!(down(&read_ies(windows.as_bytes()).expect("it is a file")), 100.0);
    let commas = file("", "1,1000,2,2,1,1,2,0,0,0\n0.5,1,60\n0,90\n0\n100,40\u{1a}");
    assert_eq!(down(&read_ies(commas.as_bytes()).expect("it is a file")), 100.0);
    let tilted = format!("TILT=INCLUDE\n1\n3\n0 45 90\n1 .9 .8\n{SMALL}");
    assert_eq!(down(&read_ies(tilted.as_bytes()).expect("it is a file")), 100.0);
    // Type B looks ahead.
    let flood = file("", "1 -1 1 3 2 2 1 0 0 0 1 1 60 -90 0 90 0 90 0 7 0 0 0 0");
    let flood = read_ies(flood.as_bytes()).expect("it is a file");
    assert_eq!(flood.intensity(Vector3::new(1.0, 0.0, 0.0)), 7.0);
}

#[track_caller]
fn check_error(text: &str, line: usize, part: &str) {
    let error = read_ies(text.as_bytes()).expect_err("the file is wrong");
    assert!(error.line == line && error.reason.contains(part), "{error}");
}

#[test]
fn impossible_files_are_refused_with_their_line() {
    check_error("", 1, "TILT=");
    check_error("IESNA91\n[TEST]\n", 2, "TILT=");
    check_error("TILT=lamp.tlt\n1 2 3", 1, "lamp.tlt");
    check_error("TILT=NONE\n", 2, "the file ends before the number of lamps");
    let with = |from: &str, to: &str| file("", &SMALL.replacen(from, to, 1));
    check_error(&with("2 2 1 1", "2 1e9 1 1"), 4, "more than the file holds");
    check_error(&with("2 2 1 1", "2 2 -3 1"), 4, "whole number");
    check_error(&with("2 2 1 1", "2 2.5 1 1"), 4, "whole number");
    check_error(&with("2 2 1 1", "2 9 9 1"), 4, "more candela values than the file holds");
    check_error(&with("2 2 1 1 2", "2 2 1 4 2"), 4, "photometric type");
    check_error(&with("2 2 1 1 2", "2 2 1 1 3"), 4, "type of units");
    check_error(&with("0.5 1 60", "-0.5 1 60"), 5, "negative");
    check_error(&with("0 90\n", "90 0\n"), 6, "not above the one before");
    check_error(&with("0 90\n", "0 NaN\n"), 6, "should be a number");
    check_error(&with("100 40", "100 inf"), 8, "should be a number");
    check_error(&with("100 40", "100 -40"), 8, "at least 0");
    check_error(&with("100 40", "100 1e300"), 8, "in range");
    check_error(&with("100 40", "100"), 9, "the file ends before a candela value");
    check_error(&with("0\n100", "25\n100"), 7, "horizontal angles of type C");
    check_error(&with("0.5 1 60", "0.5 1 sixty"), 5, "\"sixty\"");
}

#[test]
fn damaged_files_never_panic() {
    let whole = file("IESNA:LM-63-2002\n", SMALL).into_bytes();
    let mut rng = Rng::new(63, 1);
    for _ in 0..3000 {
        let mut bytes = whole.clone();
        bytes.truncate(1 + rng.next_below(whole.len() as u32) as usize);
        for _ in 0..rng.next_below(4) {
            let at = rng.next_below(bytes.len() as u32) as usize;
            bytes[at] = rng.next_below(256) as u8;
        }
        let _ = read_ies(&bytes);
    }
}
