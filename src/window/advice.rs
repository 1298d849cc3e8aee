//! Errors as the window shows them: the sentence, and what the user can do about it in the window.
//! Floor 7. Not here: the advice of the command line (`cli`).

use crate::language::{tr, tr_message};
use crate::{Error, Remedy};

/// The sentence of an error in the language of the window, with the menu or control that would help.
pub fn with_advice(error: &Error) -> String {
    let advice = match error.remedy() {
        Some(Remedy::LongerSides | Remedy::MorePixels) => {
            tr("A smaller version of the picture can be opened")
        }
        Some(Remedy::MoreMemory) => tr("Close other drawings (File, Close) and programs"),
        Some(Remedy::Background) => tr("Tick “Lay it on white” in File, Export…"),
        None => return tr_message(&error.to_string()).into_owned(),
    };
    format!("{}. {advice}", tr_message(&error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::Budget;
    use std::path::Path;

    #[test]
    fn the_window_names_its_own_controls_and_no_options_of_the_command_line() {
        let too_large = Budget::default().size(Path::new("a.png"), 1 << 20, 1).unwrap_err();
        let transparent =
            Error::unsupported_file("a.jpg", "it is transparent").with_remedy(Remedy::Background);
        for (error, help) in [(too_large, "smaller version"), (transparent, "Lay it on white")] {
            let said = with_advice(&error);
            assert!(said.contains(help) && !said.contains("--"), "{said}");
        }
    }
}
