use super::{SpdError, read_spd};

/// A measured spectrum is a table of wavelength and value, with comments.
#[test]
fn tables_are_read() {
    let text = "\u{feff}# measured \u{fc}\r\n400 0.5\r\n\n 500.5\t1e-2 # peak\n600,3";
    assert_eq!(read_spd(text.as_bytes()), Ok(vec![[400.0, 0.5], [500.5, 0.01], [600.0, 3.0]]));
    assert_eq!(read_spd(b"# caf\xe9\n400 1"), Ok(vec![[400.0, 1.0]]));
}

/// A table that is damaged names its line.
#[test]
fn damaged_tables() {
    assert_eq!(read_spd(b"400 1\n500"), Err(SpdError::Line(2)));
    assert_eq!(read_spd(b"400 1 2"), Err(SpdError::Line(1)));
    assert_eq!(read_spd(b"400 x"), Err(SpdError::Line(1)));
    assert_eq!(read_spd(b"400 nan"), Err(SpdError::Line(1)));
    assert_eq!(read_spd(b"400 1\n400 2"), Err(SpdError::Order(2)));
    assert_eq!(read_spd(b"# nothing"), Err(SpdError::Empty));
    assert_eq!(read_spd(b"\xff\xfe\0"), Err(SpdError::Line(1)));
}
