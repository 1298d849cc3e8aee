//! What commands print to standard error besides errors. Floor 7.

use crate::language::tr_message;
use std::io::Write;
use std::path::Path;

/// What could not be converted goes to standard error: it is no failure, but the user must see it.
pub fn print_notes(file: &Path, notes: &[String]) {
    for note in notes {
        // A note that repeats an error already names its file.
        let named = format!("{}", file.display());
        let sentence =
            if note.starts_with(&named) { note.clone() } else { format!("{named}: {note}") };
        print_line(&format!("rilievo: {sentence}"));
    }
}

/// A line on standard error in the user's language, in which a name cannot control the terminal.
/// Nobody may be left to read it.
pub fn print_line(line: &str) {
    let _ = writeln!(std::io::stderr(), "{}", super::printable(&tr_message(line)));
}
