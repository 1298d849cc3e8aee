//! The catalogs: complete, and each row a translation that can stand where its English text stands.

use super::collect::{shown_texts, values, without_values};
use rilievo_program::language::Language;
use std::collections::{BTreeMap, BTreeSet};

/// The rows of a language.
fn rows(language: Language) -> BTreeMap<&'static str, &'static str> {
    language.translated_texts().collect()
}

/// The languages that have catalogs.
fn languages() -> impl Iterator<Item = (Language, &'static str)> {
    Language::ALL.into_iter().filter(|(language, _)| *language != Language::English)
}

/// The first of a list, so that a new language does not print a book.
fn first_of(list: &[String]) -> String {
    const SHOWN: usize = 40;
    let more = list.len().saturating_sub(SHOWN);
    format!("{:#?}\nand {more} more", &list[..list.len().min(SHOWN)])
}

#[test]
fn every_text_is_a_row_of_every_catalog() {
    let shown = shown_texts();
    for (language, name) in languages() {
        let rows = rows(language);
        let missing = shown.iter().filter(|shown| !rows.contains_key(shown.text.as_str()));
        let missing: Vec<String> =
            missing.map(|shown| format!("{}: {:?}", shown.file, shown.text)).collect();
        assert!(
            missing.is_empty(),
            "add {} rows to src/program/language/{name}.json: {}",
            missing.len(),
            first_of(&missing)
        );
    }
}

#[test]
fn no_catalog_has_a_row_of_a_text_that_is_gone() {
    let shown: BTreeSet<&str> = shown_texts().iter().map(|shown| shown.text.as_str()).collect();
    for (language, name) in languages() {
        let gone = rows(language).into_keys().filter(|english| !shown.contains(english));
        let gone: Vec<String> = gone.map(str::to_owned).collect();
        assert!(
            gone.is_empty(),
            "remove {} rows of src/program/language/{name}.json: {}",
            gone.len(),
            first_of(&gone)
        );
    }
}

/// The marks at the end of a text, in ASCII and as Chinese and Japanese write them.
const ENDS: [(char, &[char]); 5] = [
    ('.', &['.', '。']),
    ('…', &['…']),
    (':', &[':', '：']),
    ('?', &['?', '？']),
    ('!', &['!', '！']),
];

/// The mark that a text ends with.
fn end_of(text: &str) -> Option<char> {
    let last = text.chars().last()?;
    ENDS.iter().find(|(_, marks)| marks.contains(&last)).map(|(mark, _)| *mark)
}

/// The width of a text in letters; one of Chinese or Japanese is as wide as two.
fn width_of(text: &str) -> usize {
    text.chars().map(|c| if is_wide(c) { 2 } else { 1 }).sum()
}

fn is_wide(c: char) -> bool {
    matches!(c, '\u{1100}'..='\u{115f}' | '\u{2e80}'..='\u{a4cf}' | '\u{ac00}'..='\u{d7a3}'
        | '\u{f900}'..='\u{faff}' | '\u{fe30}'..='\u{fe6f}' | '\u{ff00}'..='\u{ff60}')
}

/// Labels of at most so many letters stand where there is little room.
const LABEL: usize = 24;

/// What is wrong with a translation.
fn fault_of(english: &str, text: &str) -> Option<String> {
    if text.trim().is_empty() {
        return Some("is empty".into());
    }
    if english.trim() == english && text.trim() != text {
        return Some("begins or ends with a space".into());
    }
    let (wanted, found) = (values(english), values(text));
    if wanted != found {
        return Some(format!("has the values {found:?} instead of {wanted:?}"));
    }
    if text.matches('{').count() != text.matches('}').count() {
        return Some("has a brace that is not closed".into());
    }
    let (wanted, found) = (end_of(english), end_of(text));
    if wanted != found {
        return Some(format!("ends with {found:?} instead of {wanted:?}"));
    }
    let (own, translated) = (without_values(english), without_values(text));
    let (letters, width) = (own.chars().count(), width_of(&translated));
    let most = letters * 19 / 10 + 6;
    let is_too_wide = letters <= LABEL && wanted != Some('.') && width > most;
    is_too_wide.then(|| format!("is as wide as {width} letters; it may have {most}"))
}

#[test]
fn a_translation_can_stand_where_its_text_stands() {
    for (language, name) in languages() {
        let faults: Vec<String> = rows(language)
            .into_iter()
            .filter_map(|(english, text)| {
                let fault = fault_of(english, text)?;
                Some(format!("{english:?}: {text:?} {fault}"))
            })
            .collect();
        assert!(faults.is_empty(), "{name}: {} faults: {}", faults.len(), first_of(&faults));
    }
}

#[test]
fn faults_of_translations_are_found() {
    let good = [
        ("{a} of {b}", "{b} の {a}"),
        ("Save as…", "保存为…"),
        ("Is it?", "¿Lo es?"),
        ("It is.", "是的。"),
        ("Layer", "Ebene"),
    ];
    for (english, text) in good {
        assert_eq!(fault_of(english, text), None, "{english}");
    }
    let bad = [
        ("{a} of {b}", "{a} von {c}"),
        ("Save as…", "Sichern als"),
        ("Layer", "Ebene."),
        ("Layer", " Ebene"),
        ("Layer", ""),
        ("Layer", "Zeichenebenenschicht"),
        ("Layer", "图层图层图层图层"),
    ];
    for (english, text) in bad {
        assert!(fault_of(english, text).is_some(), "{english}: {text}");
    }
}

/// Where the window has fixed room, the widths are those of its font.
#[cfg(feature = "window-tests")]
#[test]
fn names_in_front_of_fields_fit() {
    use super::collect::{Room, Shown};
    use eframe::egui::{Color32, FontId};

    /// The size of letters in the window, and the room in front of a field and on a bar, points.
    const LETTER_PT: f32 = 12.5;
    const NAME_PT: f32 = 76.0;
    const BAR_PT: f32 = 140.0;
    let shown: Vec<&Shown> = shown_texts().iter().filter(|shown| shown.room.is_some()).collect();
    let mut faults = Vec::new();
    egui_kittest::Harness::new_ui(|ui| {
        let width_pt = |text: &str| {
            let (wide, narrow): (String, String) = text.chars().partition(|c| is_wide(*c));
            let font = FontId::proportional(LETTER_PT);
            let galley = ui.painter().layout_no_wrap(narrow, font, Color32::WHITE);
            galley.size().x + LETTER_PT * wide.chars().count() as f32
        };
        faults.clear();
        for (language, name) in Language::ALL {
            let rows = rows(language);
            for shown in &shown {
                let english = shown.text.as_str();
                let text = match language {
                    Language::English => english,
                    _ => rows.get(english).copied().unwrap_or_default(),
                };
                let most_pt = match shown.room {
                    Some(Room::Name) => NAME_PT,
                    _ => BAR_PT,
                };
                let width_pt = width_pt(text);
                if width_pt > most_pt {
                    faults.push(format!("{name}: {english:?}: {text:?}: {width_pt} of {most_pt}"));
                }
            }
        }
    })
    .run();
    assert!(faults.is_empty(), "{} names are too wide: {faults:#?}", faults.len());
}
