//! JSON as it is written to be read: an object's fields a line each, what is short on one line, so
//! that a list of numbers takes a line and not one for each. Floor 5.

use serde_json::Value;

/// Longest line without its indent, characters.
const LINE: usize = 110;

/// Text being built. Long lists and objects are opened, filled piece by piece and closed, so that
/// they are never in memory as values.
#[derive(Default)]
pub struct Printer {
    text: String,
    /// For every object or list that is open, whether it holds something already.
    open: Vec<bool>,
}

impl Printer {
    /// Everything is closed, and the text ends with its line.
    pub fn into_text(mut self) -> String {
        self.text.push('\n');
        self.text
    }

    /// Begins an object, as a field of the one around it if it has a key.
    pub fn open_object(&mut self, key: Option<&str>) {
        self.begin(key);
        self.text.push('{');
        self.open.push(false);
    }

    /// Begins a list, in the same way.
    pub fn open_list(&mut self, key: Option<&str>) {
        self.begin(key);
        self.text.push('[');
        self.open.push(false);
    }

    /// Ends the object.
    pub fn close_object(&mut self) {
        self.close('}');
    }

    /// Ends the list.
    pub fn close_list(&mut self) {
        self.close(']');
    }

    /// A value, as a field of the object that is open, or without a key as an item of the list.
    pub fn value(&mut self, key: Option<&str>, value: &Value) {
        if let Some(line) = one_line(value) {
            self.begin(key);
            self.text.push_str(&line);
            return;
        }
        match value {
            Value::Object(fields) => {
                self.open_object(key);
                fields.iter().for_each(|(key, value)| self.value(Some(key), value));
                self.close_object();
            }
            Value::Array(items) => {
                self.open_list(key);
                items.iter().for_each(|item| self.value(None, item));
                self.close_list();
            }
            // A long text.
            _ => {
                self.begin(key);
                self.text.push_str(&value.to_string());
            }
        }
    }

    /// Starts a new line for what comes next.
    fn begin(&mut self, key: Option<&str>) {
        if let Some(holds) = self.open.last_mut() {
            self.text.push_str(if *holds { ",\n" } else { "\n" });
            *holds = true;
            self.indent();
        }
        if let Some(key) = key {
            self.text.push_str(&Value::from(key).to_string());
            self.text.push_str(": ");
        }
    }

    fn close(&mut self, bracket: char) {
        if self.open.pop() == Some(true) {
            self.text.push('\n');
            self.indent();
        }
        self.text.push(bracket);
    }

    fn indent(&mut self) {
        self.text.extend(std::iter::repeat_n("  ", self.open.len()));
    }
}

/// A value on one line; `None` where it is too long, or lists things that deserve a line each.
fn one_line(value: &Value) -> Option<String> {
    let holds_more = |value: &Value| value.is_object() || value.is_array();
    let lists_objects =
        value.as_array().is_some_and(|items| items.len() > 1 && items.iter().any(Value::is_object));
    let is_deep = match value {
        Value::Object(fields) => fields
            .values()
            .any(|v| v.is_object() || v.as_array().is_some_and(|v| v.iter().any(holds_more))),
        Value::Array(items) => items.iter().flat_map(children).any(holds_more),
        _ => false,
    };
    let mut line = String::new();
    (!lists_objects && !is_deep && put(&mut line, value)).then_some(line)
}

fn children(value: &Value) -> Vec<&Value> {
    match value {
        Value::Object(fields) => fields.values().collect(),
        Value::Array(items) => items.iter().collect(),
        _ => Vec::new(),
    }
}

/// Whether it fits; what is too long is given up early.
fn put(line: &mut String, value: &Value) -> bool {
    match value {
        Value::Object(fields) => {
            line.push_str("{ ");
            for (i, (key, value)) in fields.iter().enumerate() {
                line.push_str(if i > 0 { ", " } else { "" });
                line.push_str(&Value::from(key.as_str()).to_string());
                line.push_str(": ");
                if !put(line, value) {
                    return false;
                }
            }
            line.push_str(" }");
        }
        Value::Array(items) => {
            line.push('[');
            for (i, value) in items.iter().enumerate() {
                line.push_str(if i > 0 { ", " } else { "" });
                if !put(line, value) {
                    return false;
                }
            }
            line.push(']');
        }
        Value::String(text) if text.len() > LINE => return false,
        scalar => line.push_str(&scalar.to_string()),
    }
    line.len() <= LINE
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn printed(value: &Value) -> String {
        let mut printer = Printer::default();
        printer.value(None, value);
        printer.into_text()
    }

    #[test]
    fn short_things_take_a_line() {
        let value = json!({ "a": 1, "at": [1, 2.5], "b": { "c": [[1, 2], [3, 4]] }, "list": [{ "x": [1] }, {}] });
        let text = "{\n  \"a\": 1,\n  \"at\": [1, 2.5],\n  \
                    \"b\": {\n    \"c\": [[1, 2], [3, 4]]\n  },\n  \"list\": [\n    \
                    { \"x\": [1] },\n    {  }\n  ]\n}\n";
        assert_eq!(printed(&value), text);
    }

    #[test]
    fn what_is_printed_reads_back_whatever_its_length() {
        let rows: Vec<Value> = (0..50).map(|i| json!([i, i * 2, 0.5])).collect();
        let long = "x\"\n".repeat(100);
        let value = json!({ "rows": rows, "k\"ey": long, "none": [], "empty": {}, "deep": [[[[1]]]], "null": null });
        let text = printed(&value);
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
        assert!(text.lines().count() < 80, "a row takes a line: {text}");
    }

    #[test]
    fn what_is_printed_piece_by_piece_is_what_is_printed_at_once() {
        let value = json!({ "a": [[1, 2], { "b": { "c": {} } }], "d": "e" });
        let mut printer = Printer::default();
        printer.open_object(None);
        printer.open_list(Some("a"));
        printer.value(None, &value["a"][0]);
        printer.value(None, &value["a"][1]);
        printer.close_list();
        printer.value(Some("d"), &value["d"]);
        printer.close_object();
        assert_eq!(printer.into_text(), printed(&value));
    }
}
