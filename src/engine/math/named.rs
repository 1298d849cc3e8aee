//! Enums whose choices have names in documents: choices and names in one place. Floor 0.

/// Names and keys that documents of version 0.1 spell otherwise, and their spelling now.
const FORMER_NAMES: [(&str, &str); 5] = [
    ("grey", "gray"),
    ("posterise", "posterize"),
    ("curvature-grey", "curvature-gray"),
    ("watercolour-wash", "watercolor-wash"),
    ("watercolour-pool", "watercolor-pool"),
];

/// How a name is spelled now, if documents of version 0.1 spell it otherwise; else the name.
pub fn current_name(name: &str) -> &str {
    FORMER_NAMES.iter().find(|(former, _)| *former == name).map_or(name, |(_, current)| current)
}

/// How documents of version 0.1 spell a name, if they spell it otherwise.
pub fn former_name(name: &str) -> Option<&'static str> {
    FORMER_NAMES.iter().find(|(_, current)| *current == name).map(|(former, _)| *former)
}

/// Declares an enum of plain choices together with their names: `ALL`, `name` and `from_name`. If
/// the window has other names for them, `label` (and `LABELS`), and if it explains them, `hint`:
///
/// ```
/// rilievo_engine::named! {
///     /// The aspect of a frame.
///     #[derive(Clone, Copy, Debug, PartialEq)]
///     pub enum Aspect {
///         Free = "free" => ("Free", "As it is dragged"),
///         Square = "1:1" => ("1 : 1", "As wide as it is high"),
///     }
/// }
/// assert_eq!(Aspect::from_name("1:1"), Some(Aspect::Square));
/// assert_eq!((Aspect::Square.label(), Aspect::Free.hint()), ("1 : 1", "As it is dragged"));
/// ```
#[macro_export]
macro_rules! named {
    ($(#[$meta:meta])* $vis:vis enum $type:ident {
        $($(#[$row:meta])* $choice:ident = $name:literal => ($label:literal, $hint:literal $(,)?)),+ $(,)?
    }) => {
        $crate::named! {
            $(#[$meta])* $vis enum $type { $($(#[$row])* $choice = $name => $label),+ }
        }

        impl $type {
            /// What it is or does, for tooltips.
            pub const fn hint(self) -> &'static str {
                match self { $($type::$choice => $hint),+ }
            }
        }
    };
    ($(#[$meta:meta])* $vis:vis enum $type:ident {
        $($(#[$row:meta])* $choice:ident = $name:literal => $label:literal),+ $(,)?
    }) => {
        $crate::named! { $(#[$meta])* $vis enum $type { $($(#[$row])* $choice = $name),+ } }
        impl $type {
            /// Every choice with its name in the window.
            pub const LABELS: [($type, &'static str); [$($name),+].len()] = [$(($type::$choice, $label)),+];
            /// Its name in the window.
            pub const fn label(self) -> &'static str {
                match self { $($type::$choice => $label),+ }
            }
        }
    };
    ($(#[$meta:meta])* $vis:vis enum $type:ident { $($(#[$row:meta])* $choice:ident = $name:literal),+ $(,)? }) => {
        $(#[$meta])*
        $vis enum $type {
            $(
                $(#[$row])*
                #[doc = ""]
                #[doc = concat!("`", $name, "` in files.")]
                $choice
            ),+
        }
        impl $type {
            /// Every choice with its name.
            pub const ALL: [($type, &'static str); [$($name),+].len()] = [$(($type::$choice, $name)),+];
            /// Its name in files.
            pub const fn name(self) -> &'static str {
                match self { $($type::$choice => $name),+ }
            }

            /// The choice of a name, which may be spelled as it was in version 0.1; `None` if there
            /// is none of it.
            pub fn from_name(name: &str) -> Option<Self> {
                let name = $crate::math::named::current_name(name);
                Self::ALL.iter().find(|(_, known)| *known == name).map(|(choice, _)| *choice)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_former_name_leads_to_the_current_one_and_back() {
        for (former, current) in FORMER_NAMES {
            assert_eq!((current_name(former), former_name(current)), (current, Some(former)));
            assert_eq!((current_name(current), former_name(former)), (current, None));
        }
    }
}
