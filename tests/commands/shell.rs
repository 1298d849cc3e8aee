//! The `cargo` and `rilievo` lines of a page of Markdown: blocks of `sh`, indented lines, and code
//! within sentences.

/// One command of a page.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandLine {
    pub words: Vec<String>,
    /// It stands in a block and can be pasted as it is; within a sentence it may lack arguments.
    pub is_whole: bool,
}

/// Every command of a page that begins with `cargo` or `rilievo`, in the order of blocks, then
/// sentences.
pub fn commands(page: &str) -> Vec<CommandLine> {
    let (blocks, prose) = parted(page);
    let spans = prose.split('`').skip(1).step_by(2).map(|span| (span.replace('\n', " "), false));
    let lines = blocks.into_iter().map(|block| (block, true));
    let split = |(text, is_whole): (String, bool)| {
        split_commands(&text).into_iter().map(move |words| CommandLine { words, is_whole })
    };
    let is_ours = |line: &CommandLine| {
        line.words.first().is_some_and(|word| word == "cargo" || word == "rilievo")
    };
    lines.chain(spans).flat_map(split).filter(is_ours).collect()
}

/// The shell's blocks and the indented lines of a page, and everything outside of blocks.
fn parted(page: &str) -> (Vec<String>, String) {
    let (mut blocks, mut prose) = (Vec::new(), String::new());
    let mut open: Option<(bool, String)> = None;
    for line in page.lines() {
        match (&mut open, line.trim_start().strip_prefix("```")) {
            (None, Some(language)) => open = Some((language == "sh", String::new())),
            (Some(_), Some(_)) => {
                blocks.extend(open.take().filter(|(is_shell, _)| *is_shell).map(|(_, text)| text))
            }
            (Some((_, text)), None) => *text += &format!("{line}\n"),
            (None, None) if line.starts_with("    ") && !line.contains('`') => {
                blocks.push(line.trim().to_owned())
            }
            (None, None) => prose += &format!("{line}\n"),
        }
    }
    (blocks, prose)
}

/// The commands of a shell's text as words, without the variables set before them. Substitutions
/// stay as written.
fn split_commands(text: &str) -> Vec<Vec<String>> {
    let mut commands = vec![Vec::new()];
    let mut word: Option<String> = None;
    let mut quote: Option<char> = None;
    let mut depth = 0;
    let text = text.replace("2>&1", "");
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '(' if word.as_ref().is_some_and(|w| w.ends_with('$')) => depth += 1,
            ')' if depth > 0 => depth -= 1,
            '\'' | '"' if depth == 0 && quote.is_none_or(|q| q == c) => {
                quote = if quote.is_some() { None } else { Some(c) };
                word.get_or_insert_default();
                continue;
            }
            '\\' if chars.peek() == Some(&'\n') => {
                chars.next();
                continue;
            }
            '#' if word.is_none() && quote.is_none() => {
                while chars.next_if(|c| *c != '\n').is_some() {}
                continue;
            }
            c if depth == 0
                && quote.is_none()
                && (c.is_whitespace() || matches!(c, ';' | '&' | '|')) =>
            {
                let last = commands.last_mut().expect("there is always one");
                last.extend(word.take());
                if !matches!(c, ' ' | '\t') {
                    commands.push(Vec::new());
                }
                continue;
            }
            _ => {}
        }
        word.get_or_insert_default().push(c);
    }
    commands.last_mut().expect("there is always one").extend(word);
    let is_before = |word: &String| {
        word == "do" || word.split_once('=').is_some_and(|(name, _)| is_variable(name))
    };
    for words in &mut commands {
        let before = words.iter().take_while(|word| is_before(word)).count();
        words.drain(..before);
    }
    commands
}

fn is_variable(name: &str) -> bool {
    !name.is_empty()
        && name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_')
}

#[test]
fn commands_are_found_in_blocks_and_sentences() {
    let block = "```sh\nfor r in *.json; do rilievo render \"$r\" -o \"$(basename \"$r\" .json).png\"; done  # all\n\
                 rilievo view a \\\n    --layer 'γ 2'\n```\n";
    let page = format!(
        "Run `cargo test`, or\n`UPDATE=1 cargo test --test\nprogram`; never `rm`.\n\n    rilievo info FILE\n\n\
         {block}\n```json\ncargo nothing\n```\n"
    );
    let found: Vec<(String, bool)> =
        commands(&page).into_iter().map(|line| (line.words.join("|"), line.is_whole)).collect();
    let expected = [
        ("rilievo|info|FILE", true),
        ("rilievo|render|$r|-o|$(basename \"$r\" .json).png", true),
        ("rilievo|view|a|--layer|γ 2", true),
        ("cargo|test", false),
        ("cargo|test|--test|program", false),
    ];
    assert_eq!(found, expected.map(|(words, is_whole)| (words.to_owned(), is_whole)));
}
