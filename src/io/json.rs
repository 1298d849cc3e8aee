//! JSON as documents use it: text checked before it is parsed, values read by fields that know
//! their own path, objects written without their defaults. Floor 5. Not here: what the fields mean
//! (`recipe`).

pub mod fields;
pub mod object;
pub mod print;
pub mod text;

pub use fields::{Fields, JsonNode};
pub use object::JsonObject;
pub use print::Printer;
pub use text::{is_utf16, parse, parse_foreign};
