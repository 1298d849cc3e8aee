use super::catalog::Catalog;
use super::template::fill_in;
use super::*;

#[test]
fn a_text_is_translated_with_its_values_in_the_order_of_the_language() {
    let catalog = Catalog::read(
        r#"{"Layer": "Ebene", "Gloss": "Glanz", "{what} on {layer}": "Auf {layer}: {what}",
            "{file} has no layer.": "{file} hat keine Ebene."}"#,
    );
    assert_eq!(catalog.find_text("Layer"), Some("Ebene"));
    assert_eq!(catalog.find_text("Brush"), None);
    assert_eq!(catalog.translate_message("a.png has no layer."), "a.png hat keine Ebene.");
    assert_eq!(catalog.translate_message("a.png has no name."), "a.png has no name.");
    // “on” is too few letters to know a text by, unless a value is known.
    assert_eq!(catalog.translate_message("Shine on beard"), "Shine on beard");
    assert_eq!(catalog.translate_message("Gloss on beard"), "Auf beard: Glanz");
}

/// Messages as the lower floors compose them, and what becomes of them.
fn assert_translated(catalog: &Catalog, messages: &[(&str, &str)]) {
    for (message, text) in messages {
        assert_eq!(catalog.translate_message(message), *text, "{message}");
    }
}

#[test]
fn the_template_with_the_most_words_of_its_own_is_taken() {
    let catalog = Catalog::read(
        r#"{"{what} is {number}": "{what} ist {number}",
            "{what} is {number}; it must be less": "{what} ist {number}; kleiner muss es sein"}"#,
    );
    let message = "it is 3; it must be less";
    assert_eq!(catalog.translate_message(message), "it ist 3; kleiner muss es sein");
    // “is” alone is too little to know a text by, and “it” is not known either.
    assert_eq!(catalog.translate_message("it is 3"), "it is 3");
}

#[test]
fn a_cause_within_an_error_is_translated_too() {
    let catalog = Catalog::read(
        r#"{"{1}: cannot be read: {reason}": "{1}: nicht lesbar: {reason}",
            "the {format} data is damaged ({e})": "die {format}-Daten sind beschädigt ({e})",
            "is {number}; it must be between {least} and {most}":
                "ist {number}, muss aber zwischen {least} und {most} liegen",
            "{reason}; --force replaces it": "{reason}; --force ersetzt es",
            "it is read-only": "es ist schreibgeschützt",
            "There is no panel: {why}.": "Kein Panel: {why}."}"#,
    );
    assert_translated(
        &catalog,
        &[
            (
                "a: b.png: cannot be read: the PNG data is damaged (end)",
                "a: b.png: nicht lesbar: die PNG-Daten sind beschädigt (end)",
            ),
            (
                "rilievo: p.json: layers[0].opacity: is 2; it must be between 0 and 1",
                "rilievo: p.json: layers[0].opacity: ist 2, muss aber zwischen 0 und 1 liegen",
            ),
            (
                "a.png: it is read-only; --force replaces it",
                "a.png: es ist schreibgeschützt; --force ersetzt es",
            ),
            ("There is no panel: it is read-only.", "Kein Panel: es ist schreibgeschützt."),
            ("rilievo: a.png: no such thing", "rilievo: a.png: no such thing"),
        ],
    );
}

#[test]
fn several_sentences_are_translated_one_by_one() {
    let catalog = Catalog::read(
        r#"{"Nothing is selected.": "Nichts ist ausgewählt.", "Saved {1}": "{1} gesichert",
            "{why} Nothing was changed.": "{why} Nichts wurde geändert.",
            "it became pixels": "es wurde zu Pixeln"}"#,
    );
    assert_translated(
        &catalog,
        &[
            ("Nothing is selected. Try again.", "Nichts ist ausgewählt. Try again."),
            ("What? Nothing is selected.", "What? Nichts ist ausgewählt."),
            (
                "Nothing is selected. Nothing was changed.",
                "Nichts ist ausgewählt. Nichts wurde geändert.",
            ),
            (
                "“a”: it became pixels\n“b”: it became pixels",
                "“a”: es wurde zu Pixeln\n“b”: es wurde zu Pixeln",
            ),
            ("Saved a.b.png", "a.b.png gesichert"),
            ("Hello. World.", "Hello. World."),
        ],
    );
}

#[test]
fn names_in_quotes_stay_as_users_gave_them() {
    let catalog = Catalog::read(
        r#"{"{name} on “{layer}”": "{name} auf „{layer}“", "{name} “{layer}”": "{name} „{layer}“",
            "Shadow": "Schatten", "Brush stroke": "Pinselstrich",
            "“{1}” is hidden. Show it.": "„{1}“ ist verborgen. Zeigen Sie es."}"#,
    );
    assert_translated(
        &catalog,
        &[
            ("Brush stroke on “Shadow”", "Pinselstrich auf „Shadow“"),
            ("Shadow “Shadow”", "Schatten „Shadow“"),
            ("“Shadow” is hidden. Show it.", "„Shadow“ ist verborgen. Zeigen Sie es."),
            // Not a step of the history.
            ("something on “Shadow”", "something on “Shadow”"),
        ],
    );
}

/// What is known is not searched for again, and thousands of rows cost no more than the few that
/// have a word of the message.
#[test]
fn a_message_is_found_among_thousands_of_templates() {
    let rows: Vec<String> = (0..3000)
        .map(|i| {
            format!(r#""{{a}} thing{i} of {{b}}, and some words": "{{b}}, Ding{i} von {{a}}""#)
        })
        .collect();
    let catalog = Catalog::read(&format!("{{{}}}", rows.join(",")));
    let began = std::time::Instant::now();
    for i in 0..3000 {
        let message = format!("the thing{i} of {i}, and some words");
        assert_eq!(catalog.translate_message(&message), format!("{i}, Ding{i} von the"));
    }
    let each = began.elapsed() / 3000;
    // Some microseconds, also on a machine that is busy.
    assert!(each.as_micros() < 1000, "{each:?} for each");
}

#[test]
fn a_message_without_end_is_translated_in_time() {
    let catalog = Catalog::read(r#"{"{a} and {b}": "{a} und {b}", "one": "eins"}"#);
    let long = "one and ".repeat(500) + "two. Three: four; five";
    assert!(catalog.translate_message(&long).starts_with("eins und "));
}

#[test]
fn values_that_are_missing_stay_as_they_are_written() {
    assert_eq!(fill_in("{a} of {b}, {c", &[("a", &1), ("b", &2.5)]), "1 of 2.5, {c");
    assert_eq!(fill_in("{a} of {b}", &[("b", &"two")]), "{a} of two");
    assert_eq!(tr!("{a} of {count}", a = 1, count = "two"), "1 of two");
    let a = 3;
    assert_eq!(tr!("{a} times", a), "3 times");
}

#[test]
fn a_locale_names_its_language() {
    assert_eq!(Language::from_locale("de_AT.UTF-8"), Some(Language::German));
    assert_eq!(Language::from_locale("zh-Hans-CN"), Some(Language::Chinese));
    assert_eq!(Language::from_locale("en"), Some(Language::English));
    assert_eq!(Language::from_locale("C.UTF-8"), None);
    assert_eq!(Language::from_locale(""), None);
}

#[test]
fn only_the_thread_that_asks_changes_its_language() {
    set_language(Language::German);
    assert_eq!(tr_number("1.50"), "1,50");
    let other = std::thread::spawn(language).join().unwrap();
    assert_eq!((language(), other), (Language::German, Language::English));
    set_language(Language::English);
    assert_eq!(tr_number("1.50"), "1.50");
}

#[test]
fn amounts_of_memory_are_written_as_the_language_does() {
    assert_eq!(Language::French.amount_text("1.4 GB").as_deref(), Some("1,4 Go"));
    assert_eq!(Language::German.amount_text("12.3 kB").as_deref(), Some("12,3 kB"));
    assert_eq!(Language::French.amount_text("312 layers"), None);
    assert_eq!(Language::French.amount_text("no MB"), None);
    set_language(Language::French);
    let within =
        tr_message("there is no memory for 4.0 GB more; close other programs").into_owned();
    set_language(Language::English);
    assert!(within.contains("4,0 Go"), "{within}");
}
