//! The table of operators: their names in documents, their numbers with ranges and defaults.
//! Floor 2. Readers, writers, panels and replay use it; a new operator is a row, its numbers a line each.

use super::Operator;
use crate::math::{Range, range::clamp_to_range};

/// A number of an operator.
#[derive(Debug, PartialEq)]
pub struct OperatorNumber {
    /// Its name in documents.
    pub key: &'static str,
    /// What people call it: in sentences and next to its slider.
    pub label: &'static str,
    /// What a document may hold.
    pub range: Range,
    /// What a slider offers: beyond it pictures hardly change, or fall apart.
    pub useful: Range,
}

/// e^20 is half a thousand million: a stronger bend only loses digits.
static GAMMA: OperatorNumber =
    OperatorNumber { key: "gamma", label: "Strength", range: 0.0..=20.0, useful: 0.0..=4.0 };
static ALPHA: OperatorNumber =
    OperatorNumber { key: "alpha", label: "Strength", range: -100.0..=100.0, useful: -1.5..=1.5 };
static BETA: OperatorNumber =
    OperatorNumber { key: "beta", label: "Edge", range: 0.0..=50.0, useful: 0.0..=5.0 };
static DETAIL: OperatorNumber =
    OperatorNumber { key: "detail", label: "Detail", range: 0.0..=100.0, useful: 0.0..=2.0 };
static AMOUNT: OperatorNumber =
    OperatorNumber { key: "amount", label: "Amount", range: 0.0..=2.0, useful: 0.0..=2.0 };
static SMOOTH: OperatorNumber =
    OperatorNumber { key: "smooth", label: "Smooth", range: 0.0..=1000.0, useful: 0.0..=50.0 };

/// Magnitudes beyond this are pulled in, so that no product of distances leaves f32.
const MAX_MAGNITUDE: f32 = 1e5;

impl Operator {
    /// Every kind: its name in documents, and the operator that a document means by the name alone.
    pub const KINDS: [(Operator, &'static str); 5] = [
        (Operator::None, "none"),
        (Operator::Depth { gamma: 1.0 }, "depth"),
        (Operator::Normal { alpha: 0.5, beta: 1.5, detail: 0.0 }, "normal"),
        (Operator::Reflection { alpha: 0.5, detail: 0.0 }, "reflection"),
        (Operator::Surface { amount: 1.0, smooth: 0.0 }, "surface"),
    ];

    /// Its numbers, to be changed in place.
    fn slots(&mut self) -> Vec<(&'static OperatorNumber, &mut f32)> {
        match self {
            Operator::None => vec![],
            Operator::Depth { gamma } => vec![(&GAMMA, gamma)],
            Operator::Normal { alpha, beta, detail } => {
                vec![(&ALPHA, alpha), (&BETA, beta), (&DETAIL, detail)]
            }
            Operator::Reflection { alpha, detail } => vec![(&ALPHA, alpha), (&DETAIL, detail)],
            Operator::Surface { amount, smooth } => vec![(&AMOUNT, amount), (&SMOOTH, smooth)],
        }
    }

    /// Its numbers in the order in which they are shown and written.
    pub fn numbers(mut self) -> Vec<(&'static OperatorNumber, f32)> {
        self.slots().into_iter().map(|(number, value)| (number, *value)).collect()
    }

    /// The same kind with other numbers; the first refusal ends it.
    pub fn try_map<E>(
        mut self,
        mut to: impl FnMut(&'static OperatorNumber, f32) -> Result<f32, E>,
    ) -> Result<Self, E> {
        for (number, value) in self.slots() {
            *value = to(number, *value)?;
        }
        Ok(self)
    }

    /// The same kind with other numbers.
    pub fn map(mut self, mut to: impl FnMut(&'static OperatorNumber, f32) -> f32) -> Self {
        self.slots().into_iter().for_each(|(number, value)| *value = to(number, *value));
        self
    }

    /// Its row of the table: its kind with the numbers of the name alone, and the name.
    pub fn row(self) -> (Operator, &'static str) {
        let is_same = |(kind, _): &&(Operator, &str)| kind.is_like(self);
        Self::KINDS.iter().find(is_same).copied().unwrap_or(Self::KINDS[0])
    }

    /// Both are of one kind, whatever their numbers.
    pub fn is_like(self, other: Operator) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }

    /// With the nearest numbers that a document may hold.
    pub fn clamp_to_ranges(self) -> Self {
        self.map(|number, value| clamp_to_range(value, &number.range))
    }

    /// The operator with parameters that are finite and not absurd: what is not a number counts as
    /// 0.
    pub fn finite(self) -> Self {
        self.map(|_, v| if v.is_finite() { v.clamp(-MAX_MAGNITUDE, MAX_MAGNITUDE) } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_a_row_whose_numbers_are_in_range() {
        for (operator, name) in Operator::KINDS {
            assert_eq!(operator.row(), (operator, name));
            assert_eq!(operator.clamp_to_ranges(), operator);
            for (number, value) in operator.numbers() {
                assert!(
                    number.range.contains(&value) && number.useful.contains(&value),
                    "{name}: {}",
                    number.key
                );
                assert!(
                    number.range.contains(number.useful.start())
                        && number.range.contains(number.useful.end())
                );
            }
        }
    }

    #[test]
    fn numbers_are_changed_in_place() {
        let doubled = Operator::Normal { alpha: 0.5, beta: 1.0, detail: 2.0 }
            .map(|n, v| if n.key == "beta" { v } else { 2.0 * v });
        assert_eq!(doubled, Operator::Normal { alpha: 1.0, beta: 1.0, detail: 4.0 });
        let nan = Operator::Surface { amount: f32::NAN, smooth: f32::INFINITY };
        assert_eq!(nan.finite(), Operator::Surface { amount: 0.0, smooth: 0.0 });
        assert_eq!(
            Operator::Depth { gamma: 99.0 }.clamp_to_ranges(),
            Operator::Depth { gamma: 20.0 }
        );
        let refused = Operator::Depth { gamma: 1.0 }.try_map(|n, _| Err::<f32, _>(n.key));
        assert_eq!(refused, Err("gamma"));
    }
}
