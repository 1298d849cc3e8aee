//! Recipes with a value out of place, or damaged.

use super::*;
use proptest::prelude::*;

/// Every value of a document, by its path.
fn pointers(value: &Value, at: &str, out: &mut Vec<String>) {
    out.push(at.to_owned());
    match value {
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, v)| pointers(v, &format!("{at}/{i}"), out))
        }
        Value::Object(map) => map.iter().for_each(|(k, v)| pointers(v, &format!("{at}/{k}"), out)),
        _ => {}
    }
}

fn odd_value() -> impl Strategy<Value = Value> {
    prop_oneof![
        Just(Value::Null),
        Just(json!([])),
        Just(json!({})),
        Just(json!("")),
        Just(json!("none")),
        Just(json!(true)),
        any::<i64>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        Just(json!(1e300)),
        Just(json!([0, 0])),
        Just(json!([[0, 0], [0, 0]])),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]
    /// Any value at any place gives a document or a sentence; a document that was read is written
    /// and read again.
    #[test]
    fn a_value_out_of_place_is_read_or_refused(pick in any::<prop::sample::Index>(), value in odd_value()) {
        let mut recipe = everything();
        let mut all = Vec::new();
        pointers(&recipe, "", &mut all);
        *recipe.pointer_mut(&all[pick.index(all.len())]).unwrap() = value;
        match read(&recipe) {
            Ok(document) => {
                let written = recipe::write(&document);
                prop_assert_eq!(&recipe::write(&read(&written).unwrap()), &written);
            }
            Err(said) => prop_assert!(said.to_string().starts_with("r.json: ")),
        }
    }

    #[test]
    fn a_damaged_text_is_read_or_refused(
        at in any::<prop::sample::Index>(), byte in any::<u8>(), cut in any::<prop::sample::Index>()
    ) {
        let mut text = everything().to_string().into_bytes();
        let i = at.index(text.len());
        text[i] = byte;
        for text in [&text[..], &text[..cut.index(text.len())]] {
            let (files, budget) = (files(), Budget::default());
            let source = RecipeSource { file: Path::new("r.json"), files: &files, budget: &budget, onto: None };
            if let Err(said) = recipe::read(text, source) {
                prop_assert!(said.to_string().starts_with("r.json: "));
            }
        }
    }
}
