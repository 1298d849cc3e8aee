//! Texts of the window pass through `tr`: those that its own widgets get are translated there, and
//! the toolkit's get what `tr` returns.

use super::collect::{Source, callee, is_text, sources};
use super::tokens::{Token, tokens};

/// Functions of the toolkit that show a text.
const SHOW: &[&str] = &[
    "button",
    "colored_label",
    "heading",
    "hint_text",
    "hyperlink_to",
    "labeled",
    "label",
    "menu_button",
    "on_disabled_hover_text",
    "on_hover_text",
    "selectable_label",
    "selected_text",
    "set_accessible_name",
    "small",
    "small_button",
    "strong",
    "toggle_value",
    "weak",
];

/// The program's name, which is the same in every language.
const PROGRAM: &str = "Rilievo";

/// Types of the toolkit that are made of a text.
const MADE_OF: &[&str] = &["Button", "CollapsingHeader", "RichText", "Window"];

/// The texts of a source that a function of the toolkit gets without `tr`.
fn unwrapped_texts(source: &Source) -> Vec<String> {
    let tokens = &source.tokens;
    let mut open: Vec<bool> = Vec::new();
    let mut found = Vec::new();
    for (at, token) in tokens.iter().enumerate() {
        match token {
            Token::Mark('(' | '[' | '{') => {
                let callee = callee(tokens, at);
                let shows = match callee.as_str() {
                    // What stands in a macro or in brackets belongs to the function around it.
                    "format!" | "" if token.is_mark('(') => open.last().is_some_and(|shows| *shows),
                    "new" | "selectable" => {
                        let of = at.checked_sub(4).and_then(|at| tokens[at].word());
                        of.is_some_and(|of| MADE_OF.contains(&of))
                    }
                    _ => token.is_mark('(') && is_method_or_own(tokens, at, &callee),
                };
                open.push(shows);
            }
            Token::Mark(')' | ']' | '}') => drop(open.pop()),
            Token::Text(text)
                if open.last() == Some(&true) && is_text(text, false) && text != PROGRAM =>
            {
                found.push(text.clone());
            }
            _ => {}
        }
    }
    found
}

/// A method of the toolkit, or the function that names a widget.
fn is_method_or_own(tokens: &[Token], at: usize, callee: &str) -> bool {
    // `colors::button` is the window's own, which translates its name.
    let is_own = at >= 4 && tokens[at - 4].word() == Some("colors");
    let is_method = at >= 2 && (tokens[at - 2].is_mark('.') || tokens[at - 2].is_mark(':'));
    let is_method = is_method && !is_own;
    SHOW.contains(&callee) && (is_method || callee == "set_accessible_name")
}

#[test]
fn texts_of_the_window_pass_through_the_catalog() {
    let window = sources().iter().filter(|source| source.file.starts_with("src/window"));
    let found: Vec<String> = window
        .flat_map(|source| {
            let texts = unwrapped_texts(source);
            texts.into_iter().map(move |text| format!("{}: {text:?}", source.file))
        })
        .collect();
    assert!(found.is_empty(), "{} texts are shown without `tr`: {found:#?}", found.len());
}

#[test]
fn texts_without_the_catalog_are_found_however_they_are_shown() {
    let code = r#"ui.label("No one"); ui.label(tr("One two")); ui.weak(format!("No {a} two"));
        name(ui, "Its own"); RichText::new("No three").strong(); ui.label(if a { tr("A b") } else { "" });
        set_accessible_name(&button, &format!("No {four}")); ui.button("×"); ui.label(tr!("It {is}", is));"#;
    let source = Source { file: "src/window/a.rs".into(), tokens: tokens(code) };
    assert_eq!(unwrapped_texts(&source), ["No one", "No {a} two", "No three", "No {four}"]);
}
