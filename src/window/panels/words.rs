//! Labels of the window within its sentences, and the names of what comes with the program. Floor 7.

use crate::io::recipe::{BrushPreset, PresetGroup};
use crate::language::{Language, language, tr};
use std::borrow::Cow;

/// A label, in the language of the window, as it stands within a sentence: English writes it small,
/// other languages as it stands alone.
pub fn translate_within(label: &str) -> Cow<'_, str> {
    match language() {
        Language::English => Cow::Owned(label.to_lowercase()),
        _ => Cow::Borrowed(tr(label)),
    }
}

/// What a preset is called: the program's own in the language of the window.
pub fn preset_name(preset: &BrushPreset) -> &str {
    match preset.group {
        PresetGroup::Imported => &preset.name,
        _ => tr(&preset.name),
    }
}

/// What is said about a preset.
pub fn preset_about(preset: &BrushPreset) -> &str {
    match preset.group {
        PresetGroup::Imported => &preset.about,
        _ => tr(&preset.about),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::set_language;

    #[test]
    fn only_english_writes_a_label_small_within_a_sentence() {
        assert_eq!(translate_within("Drop shadow"), "drop shadow");
        set_language(Language::German);
        assert_eq!(translate_within("Drop shadow"), tr("Drop shadow"));
        assert_eq!(translate_within("No such label"), "No such label");
        set_language(Language::English);
    }
}
