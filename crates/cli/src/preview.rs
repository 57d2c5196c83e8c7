//! Pictures in the terminal.
//!
//! | protocol | terminals | by |
//! |---|---|---|
//! | kitty's graphics | kitty, Ghostty, Konsole | PNG in base64 |
//! | iTerm2's inline images | iTerm2, WezTerm, VS Code, mintty | PNG in base64 |
//! | sixel | foot, mlterm, contour, xterm with `TERM=xterm-sixel` | 252 colours |
//! | half blocks | all others with 24-bit colour | two pixels for each letter `▀` |
//!
//! Which one is told by the environment: asking the terminal itself would need its raw mode. Inside of tmux and screen, which
//! swallow pictures, there are half blocks.

mod encode;

use std::io::{IsTerminal, Write};

use etendue::image::tonemap::{Operator, apply, automatic_exposure};
use etendue::image::{Image, box_downsample};

use crate::args::PreviewArgument;

/// Middle grey, which the log-average luminance of a preview becomes.
const MIDDLE_GREY: f32 = 0.18;
/// Most pixels across and down of a preview by a protocol of pixels.
const MOST_PIXELS: [usize; 2] = [1024, 768];
/// Letters across of a terminal that does not tell.
const COLUMNS: usize = 80;
/// Rows of letters that a preview takes at most.
const MOST_ROWS: usize = 40;

/// How a terminal takes pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Protocol {
    Kitty,
    Iterm,
    Sixel,
    Blocks,
}

/// Shows radiance as `tonemap --operator agx` would.
pub(crate) fn show_radiance(image: &Image, wish: PreviewArgument) {
    let Ok(operator) = Operator::named("agx", &[]) else { return };
    show(&apply(image, operator, automatic_exposure(image, MIDDLE_GREY)), wish);
}

/// Shows a picture in linear light of [0, 1] where standard output is a terminal, or where the protocol is named. A terminal that
/// went away loses the preview and nothing else.
pub(crate) fn show(picture: &Image, wish: PreviewArgument) {
    let Some(protocol) = protocol(wish, std::io::stdout().is_terminal(), |name| std::env::var(name).ok())
    else {
        return;
    };
    let size = terminal_size::terminal_size();
    let columns = size.map_or(COLUMNS, |(width, _)| usize::from(width.0)).max(1);
    let Some(text) = encoded(picture, protocol, columns) else { return };
    let mut out = std::io::stdout();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// The protocol that was asked for, or that the environment tells of.
fn protocol(
    wish: PreviewArgument,
    is_terminal: bool,
    variable: impl Fn(&str) -> Option<String>,
) -> Option<Protocol> {
    match wish {
        PreviewArgument::Kitty => return Some(Protocol::Kitty),
        PreviewArgument::Iterm => return Some(Protocol::Iterm),
        PreviewArgument::Sixel => return Some(Protocol::Sixel),
        PreviewArgument::Blocks => return Some(Protocol::Blocks),
        PreviewArgument::Auto => {}
    }
    let value = |name: &str| variable(name).unwrap_or_default();
    let (term, program) = (value("TERM"), value("TERM_PROGRAM"));
    if !is_terminal || term == "dumb" || term == "linux" {
        return None;
    }
    let is_multiplexed = variable("TMUX").is_some()
        || variable("STY").is_some()
        || term.starts_with("screen")
        || term.starts_with("tmux");
    if is_multiplexed {
        return Some(Protocol::Blocks);
    }
    let is_set = |name: &str| variable(name).is_some_and(|value| !value.is_empty());
    if is_set("KITTY_WINDOW_ID")
        || is_set("KONSOLE_VERSION")
        || term.contains("kitty")
        || program == "ghostty"
    {
        return Some(Protocol::Kitty);
    }
    let knows_iterm = ["iTerm.app", "WezTerm", "vscode", "mintty"].contains(&program.as_str());
    if knows_iterm || value("LC_TERMINAL") == "iTerm2" {
        return Some(Protocol::Iterm);
    }
    let knows_sixel = ["foot", "mlterm", "contour", "sixel"].iter().any(|name| term.contains(name));
    Some(if knows_sixel { Protocol::Sixel } else { Protocol::Blocks })
}

/// What to send to the terminal; `None` for a picture without colour.
fn encoded(picture: &Image, protocol: Protocol, columns: usize) -> Option<String> {
    let small = match protocol {
        Protocol::Blocks => fitting(picture, [columns, 2 * MOST_ROWS]),
        _ => fitting(picture, MOST_PIXELS),
    };
    match protocol {
        Protocol::Kitty => encode::kitty(&small),
        Protocol::Iterm => encode::iterm(&small),
        Protocol::Sixel => encode::sixel(&small),
        Protocol::Blocks => encode::blocks(&small),
    }
}

/// The picture with whole blocks averaged until it has at most so many pixels across and down.
fn fitting(picture: &Image, most: [usize; 2]) -> Image {
    let mut small = Image::new(picture.width, picture.height);
    if let Some(pixels) = picture.rgb_pixels() {
        small.set_rgb("", &pixels);
    }
    let factor = picture.width.div_ceil(most[0]).max(picture.height.div_ceil(most[1]));
    if factor > 1 { box_downsample(&small, factor) } else { small }
}

#[cfg(test)]
mod tests;
