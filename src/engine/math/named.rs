//! Enums whose choices have names in documents: the choices and their names stand once.
//! Floor 0.

/// Declares an enum of plain choices together with their names: `ALL`, `name` and `from_name`.
#[doc(hidden)]
#[macro_export]
macro_rules! named {
    ($(#[$meta:meta])* $vis:vis enum $type:ident { $($(#[$row:meta])* $choice:ident = $name:literal),+ $(,)? }) => {
        $(#[$meta])*
        $vis enum $type { $($(#[$row])* $choice),+ }
        #[allow(dead_code)]
        impl $type {
            /// Every choice with its name.
            pub const ALL: [($type, &'static str); [$($name),+].len()] = [$(($type::$choice, $name)),+];
            pub const fn name(self) -> &'static str {
                match self { $($type::$choice => $name),+ }
            }
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().find(|(_, known)| *known == name).map(|(choice, _)| *choice)
            }
        }
    };
}
