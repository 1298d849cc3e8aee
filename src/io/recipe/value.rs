//! Values that are read the same way everywhere: in recipes, in projects and in the lines of
//! replays. Floor 5. Each is read and written in the file of its subject.

use crate::json::JsonNode;
use crate::{Error, Result};
use serde_json::Value;

/// A value with a form of its own in JSON.
pub trait RecipeValue: Sized {
    /// The value as recipes write it.
    fn to_json(&self) -> Value;
    /// Reads it; fails with a sentence that names the field.
    fn from_json(node: &JsonNode) -> Result<Self>;

    /// Reads a value that is not from a file, its numbers in their ranges or not; a refusal is the
    /// rest of a sentence that begins with its name.
    fn from_value(value: &Value) -> Result<Self, String> {
        let node = JsonNode::without_range(value);
        Self::from_json(&node).map_err(|error| match error {
            Error::Invalid { field, reason, .. } if node.is_at(&field) => reason,
            Error::Invalid { field, reason, .. } => format!("{field}: {reason}"),
            Error::TooLarge { reason, .. } => format!("is too large: {reason}"),
            other => other.to_string(),
        })
    }
}
