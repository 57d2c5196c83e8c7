//! The word of a photon's path: the events between the light and where it is (SPEC LPE-1, LPE-4).

use crate::lpe::Event;

/// Bits of a letter.
const LETTER_BITS: u32 = 3;
/// Letters that a word holds; the length has the bits above them.
const MAX_LETTERS: u32 = 20;
const LENGTH_SHIFT: u32 = MAX_LETTERS * LETTER_BITS;
const LETTER_MASK: u64 = (1 << LETTER_BITS) - 1;

/// Stands in the last place for any further events: all of them sharp, or not. The bits of the former are in the latter.
const MORE_SHARP: u64 = 6;
const MORE: u64 = 7;

const fn is_sharp(event: Event) -> bool {
    matches!(event, Event::Specular | Event::SharpGlossy)
}

/// The events of a photon since it left the light, the first of them in the lowest bits. Beyond 15 events it only notes that
/// there were more, and whether these were sharp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Trail(u64);

impl Trail {
    /// Longest word that is kept whole.
    pub const MAX_LEN: usize = 15;

    /// The word of a path that has had no event yet.
    pub const EMPTY: Self = Self(0);

    /// The word, continued by an event.
    #[inline]
    #[must_use]
    pub const fn with(self, event: Event) -> Self {
        let n = self.0 >> LENGTH_SHIFT;
        if n as usize >= Self::MAX_LEN {
            // The length stays; the letters no longer tell the whole, but whether all the others were sharp.
            let more = if is_sharp(event) { MORE_SHARP } else { MORE };
            return Self(self.0 | more << (Self::MAX_LEN as u32 * LETTER_BITS));
        }
        let letter = match event {
            Event::Diffuse => 1,
            Event::SharpGlossy => 2,
            Event::WideGlossy => 3,
            Event::Specular => 4,
            Event::Volume => 5,
        };
        let letters = self.0 | letter << (n * LETTER_BITS as u64);
        Self(letters + (1 << LENGTH_SHIFT))
    }

    /// Number of events that are known.
    #[inline]
    #[must_use]
    pub const fn len(self) -> usize {
        (self.0 >> LENGTH_SHIFT) as usize
    }

    /// True at the light.
    #[inline]
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// False if there were more events than the word holds.
    #[inline]
    #[must_use]
    pub const fn is_whole(self) -> bool {
        self.more() == 0
    }

    /// What is known of events beyond those that the word holds.
    const fn more(self) -> u64 {
        self.0 >> (Self::MAX_LEN as u32 * LETTER_BITS) & LETTER_MASK
    }

    /// The events from the light on.
    pub fn events(self) -> impl DoubleEndedIterator<Item = Event> + ExactSizeIterator + Clone {
        (0..self.len()).map(move |i| match self.0 >> (i as u32 * LETTER_BITS) & LETTER_MASK {
            1 => Event::Diffuse,
            2 => Event::SharpGlossy,
            3 => Event::WideGlossy,
            4 => Event::Specular,
            _ => Event::Volume,
        })
    }

    /// The last event.
    #[must_use]
    pub fn last(self) -> Option<Event> {
        self.events().next_back()
    }

    /// `LS+`: light that came through sharp reflection or refraction alone makes caustics.
    #[must_use]
    pub fn is_caustic(self) -> bool {
        !self.is_empty() && self.more() != MORE && self.events().all(is_sharp)
    }

    /// The word as bits, to be stored.
    #[must_use]
    pub const fn bits(self) -> u64 {
        self.0
    }

    /// A word from stored bits; `None` if no path has it.
    #[must_use]
    pub fn from_bits(bits: u64) -> Option<Self> {
        let trail = Self(bits);
        let n = trail.len();
        let letter = |i: usize| bits >> (i as u32 * LETTER_BITS) & LETTER_MASK;
        let is_valid = n <= Self::MAX_LEN
            && (0..n).all(|i| (1..=5).contains(&letter(i)))
            && (n..MAX_LETTERS as usize)
                .all(|i| letter(i) == 0 || n == Self::MAX_LEN && i == n && letter(i) >= MORE_SHARP);
        is_valid.then_some(trail)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LETTERS: [Event; 5] =
        [Event::Diffuse, Event::SharpGlossy, Event::WideGlossy, Event::Specular, Event::Volume];

    #[test]
    fn words_keep_their_letters() {
        let mut trail = Trail::EMPTY;
        assert!(trail.is_empty() && trail.last().is_none());
        for n in 0..Trail::MAX_LEN {
            trail = trail.with(LETTERS[n % 5]);
            assert_eq!(trail.len(), n + 1);
            assert_eq!(trail.last(), Some(LETTERS[n % 5]));
            assert_eq!(Trail::from_bits(trail.bits()), Some(trail));
        }
        assert!(trail.events().eq((0..Trail::MAX_LEN).map(|n| LETTERS[n % 5])));
        assert!(trail.is_whole());
        let longer = trail.with(Event::Diffuse);
        assert!(!longer.is_whole() && longer.len() == Trail::MAX_LEN && longer != trail);
        assert_eq!(longer.with(Event::Specular), longer);
        assert_eq!(Trail::from_bits(longer.bits()), Some(longer));
    }

    #[test]
    fn caustics_come_through_sharp_events_alone() {
        let word = |events: &[Event]| events.iter().fold(Trail::EMPTY, |trail, event| trail.with(*event));
        assert!(!word(&[]).is_caustic());
        assert!(word(&[Event::Specular, Event::SharpGlossy]).is_caustic());
        assert!(!word(&[Event::Specular, Event::Diffuse, Event::Specular]).is_caustic());
        assert!(!word(&[Event::WideGlossy]).is_caustic());
        let long = word(&[Event::Specular; 40]);
        assert!(long.is_caustic() && !long.is_whole());
        assert_eq!(Trail::from_bits(long.bits()), Some(long));
        assert!(!long.with(Event::Diffuse).with(Event::Specular).is_caustic());
    }

    #[test]
    fn other_bits_are_no_words() {
        for bits in [1, 6 | 1 << LENGTH_SHIFT, 2 << LENGTH_SHIFT, u64::MAX, 9 | 1 << LENGTH_SHIFT] {
            assert_eq!(Trail::from_bits(bits), None, "{bits:x}");
        }
    }
}
