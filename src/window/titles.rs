//! The names of documents as the window shows them. Floor 7.

use crate::language::tr_message;
use crate::session::OpenDocument;

/// The name of its file; of one that has none a name in the language of the window.
pub fn title_of(open: &OpenDocument) -> String {
    match open.file {
        Some(_) => open.title(),
        None => tr_message(&open.title()).into_owned(),
    }
}

/// The name with a dot before it if there are unsaved changes.
pub fn marked_title(open: &OpenDocument) -> String {
    format!("{}{}", if open.is_dirty() { "• " } else { "" }, title_of(open))
}
