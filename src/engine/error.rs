//! The one error type: what went wrong, in which file, at which field, as a sentence.
//! Floor 0. Shown once, by the window or by the command line; library code passes it on.

#![warn(missing_docs)]

use crate::memory::OutOfMemory;
use std::path::{Path, PathBuf};

/// What the library gives back, or why it cannot.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// A failure that the user can act on. `Display` is one sentence that names the file and, if there
/// is one, the field.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the fields are what the sentence names")]
pub enum Error {
    /// The operating system refused.
    #[error("{}: {source}", file.display())]
    Io { file: PathBuf, source: std::io::Error },
    /// The bytes are not what their format promises.
    #[error("{}: cannot be read: {reason}", file.display())]
    Decode { file: PathBuf, reason: String },
    /// Well formed, but a feature this program or the format does not have.
    #[error("{}: not supported: {reason}", file.display())]
    Unsupported { file: PathBuf, reason: String, remedy: Option<Remedy> },
    /// A value out of its range or of the wrong kind; `field` is a path such as
    /// `layers[2].operator.gamma`.
    #[error("{}: {field}: {reason}", file.display())]
    Invalid { file: PathBuf, field: String, reason: String },
    /// Larger than the budget allows; the sentence says which limit it exceeds.
    #[error("{}: too large: {reason}", file.display())]
    TooLarge { file: PathBuf, reason: String, remedy: Option<Remedy> },
    /// The file on disk is not the expected one and would be lost; the sentence says what is there
    /// instead.
    #[error("{}: not replaced: {reason}", file.display())]
    Changed { file: PathBuf, reason: String },
    /// A file that a field of a document names cannot be read.
    #[error("{}: {field}: {error}", file.display())]
    At { file: PathBuf, field: String, error: Box<Error> },
}

/// What would make the same call succeed. The command line and the window each say how it is done
/// there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// A higher limit for the sides of a picture.
    LongerSides,
    /// A higher limit for the pixels of a picture.
    MorePixels,
    /// More memory than is free.
    MoreMemory,
    /// A background color behind transparent parts.
    Background,
}

impl Error {
    /// The operating system refused a file.
    pub fn io(file: impl AsRef<Path>, source: std::io::Error) -> Self {
        Self::Io { file: file.as_ref().into(), source }
    }

    /// The bytes of a file are not what their format promises.
    pub fn decode(file: impl AsRef<Path>, reason: impl ToString) -> Self {
        Self::Decode { file: file.as_ref().into(), reason: reason.to_string() }
    }

    /// A file uses what this program does not have.
    pub fn unsupported_file(file: impl AsRef<Path>, reason: impl ToString) -> Self {
        Self::Unsupported { file: file.as_ref().into(), reason: reason.to_string(), remedy: None }
    }

    /// A field of a file has a value that it cannot have.
    pub fn invalid(file: impl AsRef<Path>, field: impl ToString, reason: impl ToString) -> Self {
        Self::Invalid {
            file: file.as_ref().into(),
            field: field.to_string(),
            reason: reason.to_string(),
        }
    }

    /// A file is larger than the budget allows.
    pub fn too_large(file: impl AsRef<Path>, reason: impl ToString) -> Self {
        Self::TooLarge { file: file.as_ref().into(), reason: reason.to_string(), remedy: None }
    }

    /// The same error with a remedy, if its kind can have one.
    pub fn with_remedy(mut self, with: Remedy) -> Self {
        if let Self::TooLarge { remedy, .. } | Self::Unsupported { remedy, .. } = &mut self {
            *remedy = Some(with);
        }
        self
    }

    /// What would make the same call succeed, if that is known.
    pub fn remedy(&self) -> Option<Remedy> {
        match self {
            Self::TooLarge { remedy, .. } | Self::Unsupported { remedy, .. } => *remedy,
            Self::At { error, .. } => error.remedy(),
            _ => None,
        }
    }

    /// The allocator itself refused.
    pub fn out_of_memory(file: impl AsRef<Path>, refused: OutOfMemory) -> Self {
        Self::too_large(file, refused).with_remedy(Remedy::MoreMemory)
    }
}
