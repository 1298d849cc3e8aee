//! What a command may write over: an option of every subcommand that writes. Floor 7. Not here:
//! that no command writes over what it reads (`io::replace`).

use crate::io::{Overwrite, Terms};
use crate::{Error, Result};
use std::path::PathBuf;

/// Whether existing files may be replaced.
#[derive(clap::Args, Clone, Copy)]
pub struct Force {
    /// Replace existing files, also read-only ones; files that the command reads are never
    /// overwritten
    #[arg(long)]
    force: bool,
}

impl Force {
    /// For what is made of a document: no existing file is replaced without the option.
    pub fn export(self, reads: Vec<PathBuf>) -> Terms {
        Terms::export(self.or(Overwrite::Nothing), reads)
    }

    /// For a project: the same, and the previous version is kept next to it.
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
        Error::Changed { file, reason } => {
            Error::Changed { file, reason: format!("{reason}; --force replaces it") }
        }
        error => error,
    })
}
