//! What is wrong with the text of a formula.

use std::fmt;

/// A problem with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// Where, in characters from 1.
    pub column: usize,
    /// What is wrong, as one sentence without a full stop.
    pub message: String,
    /// A name that nothing has, if that is the problem.
    pub unknown: Option<String>,
    /// Names that might have been meant instead.
    pub known: Vec<String>,
}

impl ExpressionError {
    /// A problem at a byte of the text.
    pub(super) fn new(text: &str, offset: usize, message: impl Into<String>) -> Self {
        let column = text.char_indices().take_while(|(index, _)| *index < offset).count() + 1;
        Self { column, message: message.into(), unknown: None, known: Vec::new() }
    }
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "column {}: {}", self.column, self.message)
    }
}

impl std::error::Error for ExpressionError {}
