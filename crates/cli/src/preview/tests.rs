use super::*;

fn protocol_in(variables: &[(&str, &str)]) -> Option<Protocol> {
    protocol(PreviewArgument::Auto, true, |name| {
        variables.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned())
    })
}

/// Terminals are known by their environment; multiplexers hide what is outside.
#[test]
fn detection() {
    assert_eq!(protocol_in(&[("TERM", "xterm-kitty")]), Some(Protocol::Kitty));
    assert_eq!(protocol_in(&[("TERM", "xterm-256color"), ("KITTY_WINDOW_ID", "1")]), Some(Protocol::Kitty));
    assert_eq!(protocol_in(&[("TERM_PROGRAM", "iTerm.app")]), Some(Protocol::Iterm));
    assert_eq!(
        protocol_in(&[("TERM_PROGRAM", "WezTerm"), ("TERM", "xterm-256color")]),
        Some(Protocol::Iterm)
    );
    assert_eq!(protocol_in(&[("TERM", "foot")]), Some(Protocol::Sixel));
    assert_eq!(protocol_in(&[("TERM", "xterm-sixel")]), Some(Protocol::Sixel));
    assert_eq!(protocol_in(&[("TERM", "xterm-256color")]), Some(Protocol::Blocks));
    assert_eq!(protocol_in(&[("TERM", "tmux-256color"), ("KITTY_WINDOW_ID", "1")]), Some(Protocol::Blocks));
    assert_eq!(protocol_in(&[("TERM", "dumb")]), None);
    let nothing = protocol(PreviewArgument::Auto, false, |_| Some("xterm-kitty".to_owned()));
    assert_eq!(nothing, None);
    assert_eq!(protocol(PreviewArgument::Sixel, false, |_| None), Some(Protocol::Sixel));
}

fn two_rows() -> Image {
    Image::rgb(2, 2, vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]])
}

/// Two pixels for each letter; a last row that is alone has no colour below.
#[test]
fn half_blocks() {
    let text = encoded(&two_rows(), Protocol::Blocks, 80).expect("colour");
    let expected = "\x1b[38;2;255;0;0m\x1b[48;2;0;0;255m▀\x1b[38;2;0;255;0m\x1b[48;2;255;255;255m▀\x1b[0m\n";
    assert_eq!(text, expected);
    let one = encoded(&Image::rgb(1, 1, vec![[1.0; 3]]), Protocol::Blocks, 80).expect("colour");
    assert_eq!(one, "\x1b[38;2;255;255;255m▀\x1b[0m\n");
}

/// Sixels of pure colours have no dithering: a palette, then for each colour its bits, 63 added.
#[test]
fn sixels() {
    let text = encoded(&two_rows(), Protocol::Sixel, 80).expect("colour");
    assert!(text.starts_with("\x1bP0;1;0q\"1;1;2;2#0;2;0;0;0#1;2;0;0;20"), "{}", &text[..60]);
    let blue = 5;
    let (green, red, white) = (6 * 6, 5 * 7 * 6, 251);
    let band = format!("#{blue}A?$#{green}?@$#{red}@?$#{white}?A$-\x1b\\\n");
    assert!(text.ends_with(&band), "{}", &text[text.len() - 60..]);
    let flat = encoded(&Image::rgb(9, 6, vec![[1.0; 3]; 54]), Protocol::Sixel, 80).expect("colour");
    assert!(flat.ends_with("#251!9~$-\x1b\\\n"));
}

/// PNG in base64, for kitty in pieces of 4096 letters.
#[test]
fn pictures_in_base64() {
    let text = encoded(&two_rows(), Protocol::Kitty, 80).expect("colour");
    // The signature of PNG.
    assert!(text.starts_with("\x1b_Ga=T,f=100,q=2,m=0;iVBORw0KGgo"), "{text}");
    assert!(text.ends_with("\x1b\\\n"));
    let noise =
        |x: usize, y: usize| [0, 7, 13].map(|s| ((x * 7919 + y * 104_729) >> s) as f32 % 256.0 / 255.0);
    let large = Image::from_fn(200, 200, noise);
    let text = encoded(&large, Protocol::Kitty, 80).expect("colour");
    let pieces: Vec<&str> = text.trim_end().split_terminator("\x1b\\").collect();
    assert!(pieces.len() > 2);
    assert!(pieces[1..pieces.len() - 1].iter().all(|p| p.starts_with("\x1b_Gm=1;") && p.len() == 4096 + 7));
    assert!(pieces[pieces.len() - 1].starts_with("\x1b_Gm=0;"));
    let text = encoded(&two_rows(), Protocol::Iterm, 80).expect("colour");
    assert!(text.starts_with("\x1b]1337;File=inline=1;size="), "{text}");
    assert!(text.contains(";width=2px;height=2px:iVBORw0KGgo") && text.ends_with("\x07\n"));
}

/// Previews fit the terminal and keep the shape of the picture.
#[test]
fn sizes() {
    let wide = Image::rgb(1000, 100, vec![[0.5; 3]; 100_000]);
    let small = fitting(&wide, [80, 80]);
    assert!(small.width <= 80 && small.width > 40 && small.height == 8);
    assert_eq!(encoded(&Image::new(4, 4), Protocol::Blocks, 80), None);
}
