use super::{Json, Kind};

/// Values are what RFC 8259 says, with the bytes they occupy.
#[test]
fn values() {
    let text = r#" {"a": [1, -2.5e1, true, null], "b/c": {"d": "x\n\u00e9\ud83d\ude00"}} "#;
    let json = Json::parse(text).expect("valid");
    let a = json.get("a").expect("there").items();
    assert_eq!(a[0].kind, Kind::Number(1.0));
    assert_eq!(a[1].kind, Kind::Number(-25.0));
    assert_eq!(&text[a[1].start as usize..a[1].end as usize], "-2.5e1");
    let d = json.get("b/c").and_then(|b| b.get("d")).expect("there");
    assert_eq!(d.kind, Kind::String("x\né😀".into()));
    assert_eq!(json.pointer(d.start), "/b~1c/d");
    assert_eq!(json.pointer(a[1].start), "/a/1");
    assert!(json.get("a").and_then(|a| a.get("b")).is_none());
}

/// Broken syntax is an error at its byte.
#[test]
fn errors() {
    let check = |text: &str, at: u32, part: &str| {
        let error = Json::parse(text).expect_err(text);
        assert_eq!(error.at, at, "{text}: {error}");
        assert!(error.message.contains(part), "{text}: {error}");
    };
    check("", 0, "ends");
    check("{\"a\" 1}", 5, "`:`");
    check("[1 2]", 3, "`]`");
    check("[1,]", 3, "value");
    check("{,}", 1, "name");
    check("\"abc", 0, "no end");
    check("\"\\q\"", 2, "escape");
    check("\"\\u12g4\"", 3, "hexadecimal");
    check("01", 1, "goes on");
    check("-", 1, "digit");
    check("tru", 0, "value");
    check(&"[".repeat(100_000), 129, "inside of each other");
    check("\"\\ud800\\u", 9, "hexadecimal");
}
