//! `rilievo manual`: manual pages and completions of this command line, for those who package it.
//! Floor 7.

use crate::{Error, Result};
use clap_complete::Shell;
use std::path::PathBuf;

/// Write manual pages and shell completions, for packages
///
/// One page for each command (rilievo.1, rilievo-render.1, …), and completions for bash, fish, zsh
/// and PowerShell. Files of these names in FOLDER are replaced.
#[derive(clap::Args)]
pub struct ManualArgs {
    /// The folder to write them to; created if it does not exist
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
}

const SHELLS: [Shell; 4] = [Shell::Bash, Shell::Fish, Shell::PowerShell, Shell::Zsh];

pub fn run(args: &ManualArgs) -> Result<()> {
    let write = || -> std::io::Result<()> {
        std::fs::create_dir_all(&args.folder)?;
        clap_mangen::generate_to(super::command(), &args.folder)?;
        for shell in SHELLS {
            clap_complete::generate_to(shell, &mut super::command(), "rilievo", &args.folder)?;
        }
        Ok(())
    };
    write().map_err(|e| Error::io(&args.folder, e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_gets_a_page_and_every_shell_its_completions() {
        let folder = tempfile::tempdir().unwrap();
        run(&ManualArgs { folder: folder.path().join("new") }).unwrap();
        let read = |name: &str| std::fs::read_to_string(folder.path().join("new").join(name));
        for command in crate::cli::command().get_subcommands() {
            let page = read(&format!("rilievo-{}.1", command.get_name())).unwrap();
            assert!(page.contains(".SH SYNOPSIS"), "{page}");
        }
        for name in ["rilievo.bash", "rilievo.fish", "_rilievo", "_rilievo.ps1"] {
            assert!(read(name).unwrap().contains("thumbnail"), "{name}");
        }
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let refusal = run(&ManualArgs { folder: file.path().join("in a file") }).unwrap_err();
        assert!(refusal.to_string().contains("in a file"), "{refusal}");
    }
}
