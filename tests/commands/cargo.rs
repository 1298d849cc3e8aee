//! What `cargo` lines are resolved against: the packages of the workspace, their features, targets
//! and tests.

use super::tests_of::{TestName, bench_names, test_names};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Options that every command of cargo takes here; those that end in `=` take a value.
const EVERYWHERE: &str =
    "-p= --package= --features= --no-default-features --workspace --locked -q --quiet";

/// The commands of cargo that pages name, with their own options.
const COMMANDS: [(&str, &str); 10] = [
    ("bench", "--bench= --benches --no-run"),
    ("build", "--release --bin= --example= --all-targets"),
    ("clippy", "--release --all-targets --tests"),
    ("doc", "--no-deps --document-private-items --open"),
    ("fmt", "--check"),
    ("metadata", ""),
    ("package", "--list --no-verify --allow-dirty"),
    ("publish", "--dry-run"),
    ("run", "--release --bin= --example="),
    ("test", "--release --test= --lib --doc --bin= --example= --examples --no-run"),
];

/// Options of test programs, after `--`.
const OF_TESTS: &str = "--ignored --include-ignored --exact --nocapture --test-threads=";

pub struct Workspace {
    packages: Vec<Package>,
    root: PathBuf,
}

struct Package {
    name: String,
    is_default: bool,
    features: Vec<(String, Vec<String>)>,
    targets: Vec<Target>,
    /// The program that `cargo run` starts.
    default_run: Option<String>,
}

struct Target {
    name: String,
    kind: String,
    required: BTreeSet<String>,
    source: PathBuf,
}

/// A line, its options sorted out.
#[derive(Default)]
struct Parsed {
    command: String,
    /// Each option with its value, `""` where it takes none.
    options: Vec<(String, String)>,
    filters: Vec<String>,
    after: Vec<String>,
}

impl Parsed {
    fn has(&self, option: &str) -> bool {
        self.options.iter().any(|(name, _)| name == option)
    }

    fn values<'a>(&'a self, option: &'a str) -> impl Iterator<Item = &'a str> {
        self.options.iter().filter(move |(name, _)| name == option).map(|(_, value)| value.as_str())
    }
}

impl Workspace {
    /// As `cargo metadata` describes it, without a network.
    pub fn read(root: &Path) -> Self {
        let arguments = ["metadata", "--no-deps", "--offline", "--format-version", "1"];
        let done = Command::new(env!("CARGO")).args(arguments).current_dir(root).output().unwrap();
        let text = String::from_utf8(done.stdout).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        let texts = |value: &serde_json::Value| -> Vec<String> {
            value
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(|v| Some(v.as_str()?.to_owned()))
                .collect()
        };
        let target = |value: &serde_json::Value| Target {
            name: value["name"].as_str().unwrap().to_owned(),
            kind: texts(&value["kind"]).swap_remove(0),
            required: texts(&value["required-features"]).into_iter().collect(),
            source: value["src_path"].as_str().unwrap().into(),
        };
        let default = texts(&json["workspace_default_members"]);
        let package = |value: &serde_json::Value| Package {
            name: value["name"].as_str().unwrap().to_owned(),
            is_default: default.iter().any(|id| value["id"] == **id),
            features: value["features"]
                .as_object()
                .unwrap()
                .iter()
                .map(|(k, v)| (k.clone(), texts(v)))
                .collect(),
            targets: value["targets"].as_array().unwrap().iter().map(target).collect(),
            default_run: value["default_run"].as_str().map(str::to_owned),
        };
        let packages = json["packages"].as_array().unwrap().iter().map(package).collect();
        Self { packages, root: root.to_owned() }
    }

    /// What is wrong with the arguments of cargo, as a sentence; else the arguments of this program
    /// that it runs.
    pub fn resolve(&self, arguments: &[String]) -> Result<Option<Vec<String>>, String> {
        let arguments = match arguments {
            [first, rest @ ..] if first.starts_with('+') => rest,
            all => all,
        };
        match arguments {
            [fuzz, run, target, ..] if fuzz == "fuzz" && run == "run" => {
                return self.fuzz_target(target);
            }
            _ => {}
        }
        let line = parse(arguments)?;
        let packages = self.selected(&line)?;
        let enabled: Vec<BTreeSet<String>> =
            packages.iter().map(|package| package.enabled(&line)).collect();
        for feature in line.values("--features").flat_map(|list| list.split(',')) {
            if !packages
                .iter()
                .any(|package| package.features.iter().any(|(name, _)| name == feature))
            {
                return Err(format!("no package that is built has a feature {feature}"));
            }
        }
        let chosen = chosen(&line, &packages, &enabled)?;
        if line.command == "test" {
            check_filters(&line, &chosen, &enabled)?;
        }
        if line.command == "bench" {
            let names: Vec<String> =
                chosen.iter().flat_map(|(_, target)| bench_names(&target.source)).collect();
            if let Some(filter) =
                line.filters.iter().find(|f| !names.iter().any(|name| name.contains(*f)))
            {
                return Err(format!("no benchmark's name holds {filter}"));
            }
        }
        let runs_us =
            line.command == "run" && chosen.iter().any(|(_, target)| target.kind == "bin");
        Ok(runs_us.then_some(line.after))
    }

    fn fuzz_target(&self, name: &str) -> Result<Option<Vec<String>>, String> {
        let source = self.root.join("fuzz/fuzz_targets").join(format!("{name}.rs"));
        source.is_file().then_some(None).ok_or_else(|| format!("there is no fuzz target {name}"))
    }

    /// The packages that a line is about.
    fn selected(&self, line: &Parsed) -> Result<Vec<&Package>, String> {
        let names: Vec<&str> = line.values("-p").chain(line.values("--package")).collect();
        if let Some(lost) =
            names.iter().find(|name| !self.packages.iter().any(|package| package.name == **name))
        {
            return Err(format!("there is no package {lost}"));
        }
        let is_selected = |package: &&Package| match names.is_empty() {
            true => package.is_default || line.has("--workspace"),
            false => names.contains(&package.name.as_str()),
        };
        Ok(self.packages.iter().filter(is_selected).collect())
    }
}

impl Package {
    /// The features that a line turns on, those that they imply with them.
    fn enabled(&self, line: &Parsed) -> BTreeSet<String> {
        let asked = line.values("--features").flat_map(|list| list.split(',')).map(str::to_owned);
        let mut open: Vec<String> = asked.collect();
        if !line.has("--no-default-features") {
            open.push("default".to_owned());
        }
        let mut enabled = BTreeSet::new();
        while let Some(name) = open.pop() {
            if let Some((_, implied)) = self.features.iter().find(|(feature, _)| *feature == name) {
                open.extend(implied.iter().filter(|implied| !enabled.contains(*implied)).cloned());
                enabled.insert(name);
            }
        }
        enabled
    }
}

/// The options of a line, each known to its command.
fn parse(arguments: &[String]) -> Result<Parsed, String> {
    let mut words = arguments.iter();
    let command = words.next().ok_or("cargo does nothing")?.clone();
    let own = COMMANDS
        .iter()
        .find(|(name, _)| *name == command)
        .ok_or(format!("cargo has no command {command} here"))?;
    let known: Vec<&str> = EVERYWHERE.split(' ').chain(own.1.split(' ')).collect();
    let mut line = Parsed { command, ..Parsed::default() };
    while let Some(word) = words.next() {
        if word == "--" {
            line.after = words.by_ref().cloned().collect();
        } else if !word.starts_with('-') {
            line.filters.push(word.clone());
        } else if known.contains(&word.as_str()) {
            line.options.push((word.clone(), String::new()));
        } else if known.contains(&format!("{word}=").as_str()) {
            let value = words.next().ok_or(format!("{word} takes a value"))?;
            line.options.push((word.clone(), value.clone()));
        } else {
            return Err(format!("cargo {} has no option {word} here", line.command));
        }
    }
    let may_filter = line.command == "test" || line.command == "bench";
    match line.filters.len() {
        0 => Ok(line),
        1 if may_filter => Ok(line),
        _ => Err(format!("cargo {} takes no arguments {:?}", line.command, line.filters)),
    }
}

/// The targets that a line is about, each with the place of its package. Fails where one that it
/// names is missing or lacks its features, or where one would be left out without a word.
fn chosen<'a>(
    line: &Parsed,
    packages: &[&'a Package],
    enabled: &[BTreeSet<String>],
) -> Result<Vec<(usize, &'a Target)>, String> {
    let all = packages
        .iter()
        .enumerate()
        .flat_map(|(i, package)| package.targets.iter().map(move |target| (i, target)));
    let all: Vec<(usize, &Target)> = all.collect();
    let mut wanted = Vec::new();
    for kind in ["test", "bench", "bin", "example"] {
        for name in line.values(&format!("--{kind}")) {
            let found = all.iter().find(|(_, target)| target.kind == kind && target.name == name);
            wanted.push(*found.ok_or(format!("there is no {kind} {name}"))?);
        }
    }
    if line.has("--lib") {
        wanted.extend(all.iter().filter(|(_, target)| target.kind == "lib"));
    }
    if wanted.is_empty() {
        let is_wanted = |(i, target): &(usize, &Target)| match line.command.as_str() {
            "run" => {
                packages[*i].default_run.as_ref() == Some(&target.name) && target.kind == "bin"
            }
            "test" => ["lib", "bin", "test"].contains(&target.kind.as_str()),
            "bench" => target.kind == "bench",
            _ => false,
        };
        wanted = all.into_iter().filter(is_wanted).collect();
        if ["run", "test", "bench"].contains(&line.command.as_str()) && wanted.is_empty() {
            return Err(format!("there is nothing to {}", line.command));
        }
    }
    let lacks = |(i, target): &&(usize, &Target)| !target.required.is_subset(&enabled[*i]);
    match wanted.iter().find(lacks) {
        Some((_, target)) => {
            Err(format!("{} {} needs the features {:?}", target.kind, target.name, target.required))
        }
        None => Ok(wanted),
    }
}

/// Fails where a filter chooses no test.
fn check_filters(
    line: &Parsed,
    chosen: &[(usize, &Target)],
    enabled: &[BTreeSet<String>],
) -> Result<(), String> {
    let mut filters = line.filters.clone();
    for word in &line.after {
        let is_known =
            OF_TESTS.split(' ').any(|option| option.strip_suffix('=').unwrap_or(option) == word);
        match word.starts_with('-') {
            true if !is_known => return Err(format!("tests have no option {word}")),
            true => {}
            false => filters.push(word.clone()),
        }
    }
    let is_placeholder = |filter: &String| filter.chars().all(|c| c.is_uppercase());
    filters.retain(|filter| !is_placeholder(filter) && filter.parse::<u32>().is_err());
    if filters.is_empty() {
        return Ok(());
    }
    let ignored = line.after.iter().any(|word| word == "--ignored");
    let names = chosen.iter().flat_map(|(i, target)| test_names(&target.source, &enabled[*i]));
    let names: Vec<TestName> = names.filter(|test| !ignored || test.is_ignored).collect();
    match filters.iter().find(|filter| !names.iter().any(|test| test.path.contains(*filter))) {
        Some(filter) => Err(format!("no test's name holds {filter}")),
        None => Ok(()),
    }
}
