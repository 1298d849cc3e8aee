//! `rilievo replay`: repeats recorded actions without the window.
//! Floor 7.

mod piped;

use super::force::Force;
use super::limits::MemoryLimit;
use super::print;
use crate::io::files::read_file;
use crate::io::{Budget, Overwrite};
use crate::session::{Autosave, Session, is_same};
use crate::{Error, Result};
use std::path::PathBuf;

/// Run a script: a file of actions, one JSON object per line, as docs/SCRIPTING.md describes
///
/// With “-” the actions come from standard input, and each is answered with a line of JSON as soon
/// as it is done.
#[derive(clap::Args)]
pub struct ReplayArgs {
    /// The script; - reads it from standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Keep recovery logs in this folder as the window does, and print every step once it is logged
    #[arg(long, value_name = "FOLDER")]
    recover_in: Option<PathBuf>,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    memory: MemoryLimit,
}

pub fn run(args: &ReplayArgs) -> Result<()> {
    args.memory.set();
    let mut session = Session::default();
    session.replaces_unasked = args.force.or(Overwrite::Nothing) == Overwrite::Forced;
    session.autosave = args.recover_in.clone().map(Autosave::new);
    if args.file.as_os_str() == "-" {
        return piped::run(session);
    }
    let text = read_file(&args.file, Budget::of_this_machine().json_bytes)?;
    let text = String::from_utf8_lossy(&text);
    let (mut steps, mut last) = (0, None);
    session.replay_with_progress(&args.file, &text, |session| {
        let Session { autosave: Some(autosave), open_documents, tool, .. } = session else {
            return Ok(());
        };
        if let Some(trouble) = autosave.follow(open_documents, *tool) {
            return Err(Error::unsupported_file(&args.file, trouble));
        }
        let now = session.active().map(|open| open.document().clone());
        if last.as_ref().zip(now.as_ref()).is_some_and(|(last, now)| !is_same(last, now)) {
            steps += 1;
            session.autosave.iter().for_each(Autosave::wait_until_written);
            print(&format!("{steps} steps\n"))?;
        }
        last = now;
        Ok(())
    })?;
    session.close();
    // What was refused, and what was detected in files.
    super::messages::print_notes(&args.file, &session.notes);
    Ok(())
}
