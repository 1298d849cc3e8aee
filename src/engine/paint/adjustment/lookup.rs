//! The adjustment that looks colors up in a table. Floor 3.

use super::parameters::{ParameterVisitor, Parameters, parameter_name};
use super::table::ColorTable;

/// A table that is applied.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ColorLookup {
    /// Without one nothing changes.
    pub table: Option<ColorTable>,
}

impl Parameters for ColorLookup {
    fn visit(&mut self, v: &mut dyn ParameterVisitor) {
        v.table(parameter_name("table", "Table", "A .cube file"), &mut self.table);
    }
}
