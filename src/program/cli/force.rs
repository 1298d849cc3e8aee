//! What a command may write over, as every subcommand that writes takes it.
//! Floor 7. That no command writes over what it reads is `io::replace`'s.

use crate::io::{Overwrite, Terms};
use crate::{Error, Result};
use std::path::PathBuf;

/// Whether files that are there already may be replaced.
#[derive(clap::Args, Clone, Copy)]
pub struct Force {
    /// Replace files that are there already, read-only ones too; what the command reads is never written over
    #[arg(long)]
    force: bool,
}

impl Force {
    /// For what is made of a document: nothing that is there is replaced unasked.
    pub fn export(self, reads: Vec<PathBuf>) -> Terms {
        Terms::export(self.or(Overwrite::Nothing), reads)
    }
    /// For a project: the same, and the previous version is kept beside it.
    pub fn project(self, reads: Vec<PathBuf>) -> Terms {
        Terms { keeps_previous: true, ..self.export(reads) }
    }
    pub fn or(self, usual: Overwrite) -> Overwrite {
        if self.force { Overwrite::Forced } else { usual }
    }
}

/// A refusal that the flag would overrule says so.
pub fn naming_the_flag(done: Result<()>) -> Result<()> {
    done.map_err(|error| match error {
        Error::Changed { file, reason } => Error::Changed { file, reason: reason + "; --force replaces it" },
        error => error,
    })
}
