//! The file dialogs of a browser's page.
//! Floor 7.

use super::FileAnswer;
use crate::file_purpose::FilePurpose;
use crate::io::platform::{self, DOCUMENTS};
use std::path::Path;

/// Asks with the browser's dialog. A file that is opened is read into the page's folder of
/// documents; one that is saved goes from there to where the user chose, or to the downloads.
pub fn system_dialog(purpose: FilePurpose, name: &str) -> FileAnswer {
    let endings: Vec<String> = purpose
        .filters()
        .into_iter()
        .flat_map(|(_, extensions)| extensions)
        .map(|extension| format!(".{extension}"))
        .collect();
    let question = if purpose.is_saving() { "file to save" } else { "file to open" };
    let details = format!("{name}\n{}", endings.join(","));
    let answer = platform::ask(question, &details, &[]);
    let Some(name) = answer.text.filter(|name| !name.is_empty()) else {
        return FileAnswer::Canceled;
    };
    let file = Path::new(DOCUMENTS).join(name);
    if purpose.is_saving() {
        let _ = platform::files::create_dir_all(DOCUMENTS);
    } else {
        platform::files::put(&file, answer.bytes);
    }
    FileAnswer::File(file)
}
