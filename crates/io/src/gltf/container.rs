//! What holds the JSON and the bytes: plain text, GLB chunks, `data:` URIs.
//!
//! GLB (glTF 2.0, section 4.4): 12 bytes of header `glTF`, version, length; then chunks of length, type and content,
//! `JSON` first, `BIN` after it.

/// JSON as text and, of a GLB, the bytes that follow it.
#[derive(Debug)]
pub(super) struct Container {
    pub(super) json: Vec<u8>,
    pub(super) binary: Option<Vec<u8>>,
}

const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Splits a file into its parts.
///
/// # Errors
/// If the file begins as a GLB and goes on otherwise: what is wrong with it.
pub(super) fn split(bytes: Vec<u8>) -> Result<Container, String> {
    if !bytes.starts_with(b"glTF") {
        return Ok(Container { json: bytes, binary: None });
    }
    let word = |at: usize| {
        let word = bytes.get(at..at + 4).and_then(|word| word.try_into().ok());
        word.map(u32::from_le_bytes).ok_or_else(|| format!("the file ends within the word at byte {at}"))
    };
    let version = word(4)?;
    if version != 2 {
        return Err(format!("the GLB is of version {version}; only 2 can be read"));
    }
    let length = word(8)? as usize;
    if length > bytes.len() {
        return Err(format!("the GLB says that it has {length} bytes, but there are {}", bytes.len()));
    }
    let (mut at, mut json, mut binary) = (12, None, None);
    while at < length {
        let (n_bytes, kind) = (word(at)? as usize, word(at + 4)?);
        let start = at + 8;
        let Some(content) = bytes[..length].get(start..start.saturating_add(n_bytes)) else {
            let left = length.saturating_sub(start);
            return Err(format!("the chunk at byte {at} has {n_bytes} bytes, but only {left} are left"));
        };
        match kind {
            JSON if json.is_none() && binary.is_none() => json = Some(content.to_vec()),
            BIN if json.is_some() && binary.is_none() => binary = Some(content.to_vec()),
            // Other chunks are for extensions to come.
            _ => {}
        }
        at = start + n_bytes;
    }
    match json {
        Some(json) => Ok(Container { json, binary }),
        None => Err("the GLB has no JSON chunk".to_owned()),
    }
}

/// The content of a `data:` URI; `None` if this is another URI.
///
/// # Errors
/// If it is not encoded as base64, or not well.
pub(super) fn data_uri(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let rest = uri.strip_prefix("data:")?;
    let Some((kind, content)) = rest.split_once(',') else {
        return Some(Err("the data: URI has no comma".to_owned()));
    };
    Some(if kind.ends_with(";base64") { base64(content) } else { percent_decoded(content) })
}

/// Bytes of text in which `%` and two digits stand for one.
fn percent_decoded(text: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let digits = tail.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let code = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        let Some(code) = code else {
            return Err("two hexadecimal digits must follow `%`".to_owned());
        };
        bytes.push(code);
        rest = &tail[2..];
    }
    Ok(bytes)
}

/// The file that a URI names, relative to the folder of the scene; like those of other formats it may lie elsewhere.
///
/// # Errors
/// If it has a scheme, is badly encoded or no text.
pub(super) fn file_of_uri(uri: &str) -> Result<String, String> {
    let scheme = uri.split_once(':').map(|(scheme, _)| scheme);
    // One letter is a drive of Windows.
    if let Some(scheme) = scheme.filter(|s| s.len() > 1 && s.bytes().all(|b| b.is_ascii_alphanumeric())) {
        return Err(format!("the URI has the scheme `{scheme}:`; only data: and names of files are read"));
    }
    let bytes = percent_decoded(uri)?;
    let path = String::from_utf8(bytes).map_err(|_| "the URI is no UTF-8 text".to_owned())?;
    if path.contains('\0') { Err("the URI holds a zero byte".to_owned()) } else { Ok(path) }
}

/// Base64 (RFC 4648) with or without padding; white space is skipped.
fn base64(text: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut n_bits) = (0_u32, 0);
    for letter in text.trim_end_matches('=').bytes() {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b' ' | b'\n' | b'\r' | b'\t' => continue,
            _ => return Err(format!("`{}` is no letter of base64", char::from(letter).escape_default())),
        };
        bits = bits << 6 | u32::from(value);
        n_bits += 6;
        if n_bits >= 8 {
            n_bits -= 8;
            bytes.push((bits >> n_bits) as u8);
        }
    }
    if n_bits >= 6 { Err("the base64 text ends within a byte".to_owned()) } else { Ok(bytes) }
}
