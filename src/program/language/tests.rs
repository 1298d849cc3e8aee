use super::catalog::Catalog;
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
    // “on” is too few letters to know a text by.
    assert_eq!(catalog.translate_message("Gloss on beard"), "Gloss on beard");
}

#[test]
fn values_that_are_missing_stay_as_they_are_written() {
    assert_eq!(catalog::fill_in("{a} of {b}, {c", &[("a", &1), ("b", &2.5)]), "1 of 2.5, {c");
    assert_eq!(catalog::fill_in("{a} of {b}", &[("b", &"two")]), "{a} of two");
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
