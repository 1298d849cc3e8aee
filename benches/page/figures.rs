//! The figures of one run of the benches: read from what they print, kept as a text, put into a
//! page.

use std::fmt::Write;

/// A row of numbers by the bench that printed it and by its name; the machine and the month of the
/// run.
#[derive(Debug, Default, PartialEq)]
pub struct Figures {
    machine: String,
    rows: Vec<Row>,
}

#[derive(Debug, PartialEq)]
struct Row {
    bench: String,
    name: String,
    values: Vec<String>,
}

impl Figures {
    /// From the output of `cargo bench`, where a line `Running benches/NAME.rs` begins each bench.
    ///
    /// Rows are those of tables: a name, two spaces or more, and numbers. Of divan's trees the
    /// median is taken, in ms; its name is that of all branches to it, such as `one_thread/unbent`.
    pub fn of_run(output: &str, machine: &str) -> Self {
        let (mut rows, mut bench, mut branches) = (Vec::new(), String::new(), Vec::<&str>::new());
        for line in output.lines() {
            if let Some((_, rest)) = line.split_once("Running benches/") {
                bench = rest.split('.').next().unwrap_or_default().to_owned();
                continue;
            }
            let found = match line.find(['├', '╰']) {
                Some(start) => tree_row(line, line[..start].chars().count() / 3, &mut branches),
                None => table_row(line),
            };
            rows.extend(found.map(|(name, values)| Row { bench: bench.clone(), name, values }));
        }
        Self { machine: machine.to_owned(), rows }
    }

    /// As [`Figures::print`] writes them: the machine, then `bench; name; value value …`.
    pub fn parse(text: &str) -> Self {
        let mut lines = text.lines();
        let machine = lines.next().unwrap_or_default().to_owned();
        let row = |line: &str| {
            let mut parts = line.split("; ").map(str::to_owned);
            let (bench, name) = (parts.next()?, parts.next()?);
            Some(Row { bench, name, values: parts.next()?.split(' ').map(str::to_owned).collect() })
        };
        Self { machine, rows: lines.filter_map(row).collect() }
    }

    /// With the rows of another run; those of benches that it does not hold stay.
    pub fn with_run(self, run: Figures) -> Self {
        let is_measured = |row: &Row| run.rows.iter().any(|other| other.bench == row.bench);
        let mut rows: Vec<Row> = self.rows.into_iter().filter(|row| !is_measured(row)).collect();
        rows.extend(run.rows);
        Self { machine: run.machine, rows }
    }

    pub fn print(&self) -> String {
        let mut text = format!("{}\n", self.machine);
        for Row { bench, name, values } in &self.rows {
            let _ = writeln!(text, "{bench}; {name}; {}", values.join(" "));
        }
        text
    }

    /// A page with the figures in the places that name them: `{{bench; name}}` is all values of a
    /// row, with a number behind, from 1 on, one of them, and `{{machine}}` the machine. What the
    /// run does not hold is a dash.
    pub fn fill(&self, template: &str) -> String {
        let mut parts = template.split("{{");
        let mut page = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let (place, rest) = part.split_once("}}").unwrap_or((part, ""));
            page += &self.value(place).unwrap_or_else(|| "–".to_owned());
            page += rest;
        }
        page
    }

    /// The rows of a bench whose names begin with a branch, such as `plain/8`: what follows it, and
    /// one of the columns, from 1 on.
    pub fn under(&self, bench: &str, branch: &str, column: usize) -> Vec<(&str, f64)> {
        let mut found = Vec::new();
        for row in self.rows.iter().filter(|row| row.bench == bench) {
            let value = row.values.get(column.saturating_sub(1)).and_then(|v| v.parse().ok());
            if let (Some((first, rest)), Some(value)) = (row.name.split_once('/'), value)
                && first == branch
            {
                found.push((rest, value));
            }
        }
        found
    }

    fn value(&self, place: &str) -> Option<String> {
        if place == "machine" {
            return Some(self.machine.clone());
        }
        let mut parts = place.split("; ");
        let (bench, name, column) = (parts.next()?, parts.next()?, parts.next());
        let row = self.rows.iter().find(|row| row.bench == bench && row.name == name)?;
        match column {
            None => Some(row.values.join(" ")),
            Some(column) => row.values.get(column.parse::<usize>().ok()?.checked_sub(1)?).cloned(),
        }
    }
}

/// A line of a divan tree at a depth: a branch, or a leaf with its median, the third of its
/// columns.
fn tree_row<'a>(
    line: &'a str,
    depth: usize,
    branches: &mut Vec<&'a str>,
) -> Option<(String, Vec<String>)> {
    let content = line.trim_start_matches(['│', ' ']).trim_start_matches(['├', '╰', '─', ' ']);
    let mut columns = content.split('│').map(str::trim);
    let first = columns.next()?;
    let (name, is_leaf) = match split_at_gap(first) {
        Some((name, _)) => (name, true),
        None => (first, false),
    };
    branches.truncate(depth);
    branches.push(name);
    let median = is_leaf.then(|| columns.nth(1)).flatten()?;
    Some((branches.join("/"), vec![in_ms(median)?]))
}

/// A row of a table: its name and its numbers, without a note behind them.
fn table_row(line: &str) -> Option<(String, Vec<String>)> {
    let (name, rest) = split_at_gap(line)?;
    let is_number = |word: &&str| word.parse::<f64>().is_ok() || *word == "–";
    let mut values: Vec<String> =
        rest.split_whitespace().take_while(is_number).map(str::to_owned).collect();
    // The number that a note begins with is not a column.
    if rest.split_whitespace().count() > values.len() {
        values.pop();
    }
    (!name.is_empty() && !line.starts_with(' ') && !values.is_empty())
        .then(|| (name.to_owned(), values))
}

/// What lies before the first two spaces, and after them.
fn split_at_gap(text: &str) -> Option<(&str, &str)> {
    text.split_once("  ").map(|(name, rest)| (name, rest.trim()))
}

/// `1.234 µs` in ms, with three digits.
fn in_ms(time: &str) -> Option<String> {
    let (number, unit) = time.split_once(' ')?;
    let factor = match unit {
        "ns" => 1e-6,
        "µs" => 1e-3,
        "ms" => 1.0,
        "s" => 1e3,
        _ => return None,
    };
    let ms = number.parse::<f64>().ok()? * factor;
    let decimals = (2 - ms.log10().floor() as i32).clamp(0, 6) as usize;
    Some(format!("{ms:.decimals$}"))
}
