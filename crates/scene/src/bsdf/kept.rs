//! Tables that live as long as the process.
//!
//! A BSDF is a small value that is copied along paths and holds no counted reference, so what it looks up is never freed:
//! one table for each different content, which never changes.

use std::fmt;
use std::sync::{Mutex, PoisonError};

/// The tables of a kind.
pub(super) struct Kept<T: 'static>(Mutex<Vec<&'static T>>);

impl<T> Kept<T> {
    /// None yet.
    pub(super) const fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// The table that is the wanted one, or else a new one.
    pub(super) fn find_or_keep(
        &self,
        is_wanted: impl Fn(&T) -> bool,
        make: impl FnOnce() -> T,
    ) -> &'static T {
        let mut tables = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = tables.iter().find(|known| is_wanted(known)) {
            return known;
        }
        let table = Box::leak(Box::new(make()));
        tables.push(table);
        table
    }
}

impl<T> fmt::Debug for Kept<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Kept")
    }
}
