//! How a command can end other than well.

/// Why a command did not succeed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Something failed while running: exit code 1.
    Running(String),
    /// The command line or a file on it is wrong: exit code 2.
    Usage(String),
    /// The scene is wrong, as already reported: exit code 2.
    Scene,
    /// The user interrupted; what was finished is written: exit code 130.
    Interrupted,
    /// The user interrupted before anything was finished: the same code.
    InterruptedEarly,
}

impl Failure {
    /// The exit code of the process.
    #[must_use]
    pub(crate) const fn exit_code(&self) -> u8 {
        match self {
            Self::Running(_) => 1,
            Self::Usage(_) | Self::Scene => 2,
            Self::Interrupted | Self::InterruptedEarly => 130,
        }
    }

    /// What is still to be said.
    #[must_use]
    pub(crate) fn message(&self) -> Option<&str> {
        match self {
            Self::Running(message) | Self::Usage(message) => Some(message),
            Self::Scene => None,
            Self::Interrupted => Some("interrupted; what was finished is written"),
            Self::InterruptedEarly => Some("interrupted before anything was finished; no image is written"),
        }
    }
}

/// The result of a command.
pub(crate) type Result<T> = std::result::Result<T, Failure>;
