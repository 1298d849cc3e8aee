//! Rust sources as words, marks and literals, without comments and tests: what it takes to find the
//! texts in them.

/// A piece of a source.
#[derive(Clone, Debug, PartialEq)]
pub enum Token {
    /// A name, a keyword or a number.
    Word(String),
    /// A string literal, as the program has it.
    Text(String),
    /// Bytes, a character: a literal that is no text.
    Other,
    Mark(char),
}

impl Token {
    pub fn is_mark(&self, mark: char) -> bool {
        *self == Self::Mark(mark)
    }

    pub fn word(&self) -> Option<&str> {
        match self {
            Self::Word(word) => Some(word),
            _ => None,
        }
    }
}

/// The pieces of a source.
pub fn tokens(source: &str) -> Vec<Token> {
    let mut found = Vec::new();
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let (token, len) = next(rest, first);
        found.extend(token);
        rest = &rest[len..];
    }
    found
}

/// The token at the beginning, if it counts, and its length.
fn next(rest: &str, first: char) -> (Option<Token>, usize) {
    if rest.starts_with("//") {
        return (None, rest.find('\n').unwrap_or(rest.len()));
    }
    if rest.starts_with("/*") {
        return (None, block_comment(rest));
    }
    let is_literal = matches!(first, 'b' | 'c' | 'r' | '"');
    let prefixes =
        [("br", false), ("cr", false), ("r", true), ("b", false), ("c", false), ("", true)];
    for (prefix, is_text) in prefixes.into_iter().filter(|_| is_literal) {
        let Some(after) = rest.strip_prefix(prefix) else { continue };
        let hashes = after.len() - after.trim_start_matches('#').len();
        let is_raw = prefix.ends_with('r');
        if !after[hashes..].starts_with('"') || (hashes > 0 && !is_raw) {
            continue;
        }
        let begin = prefix.len() + hashes + 1;
        let (text, len) = match is_raw {
            true => raw(&rest[begin..], hashes),
            false => escaped(&rest[begin..]),
        };
        return (Some(if is_text { Token::Text(text) } else { Token::Other }), begin + len);
    }
    if first == '\'' {
        return match character(rest) {
            Some(len) => (Some(Token::Other), len),
            None => (None, 1),
        };
    }
    if first.is_alphanumeric() || first == '_' {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        let len = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
        return (Some(Token::Word(rest[..len].to_owned())), len);
    }
    let token = (!first.is_whitespace()).then_some(Token::Mark(first));
    (token, first.len_utf8())
}

fn block_comment(rest: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        let (step, change) = match &rest.as_bytes()[at..] {
            [b'/', b'*', ..] => (2, 1),
            [b'*', b'/', ..] => (2, -1),
            _ => (1, 0),
        };
        at += step;
        depth += change;
        if depth == 0 {
            break;
        }
    }
    at
}

/// A raw literal after its quote, and its length with the closing one.
fn raw(rest: &str, hashes: usize) -> (String, usize) {
    let end = format!("\"{}", "#".repeat(hashes));
    let len = rest.find(&end).expect("a raw literal ends");
    (rest[..len].to_owned(), len + end.len())
}

/// A literal after its quote, and its length with the closing one.
fn escaped(rest: &str) -> (String, usize) {
    let mut text = String::new();
    let mut at = 0;
    loop {
        let c = rest[at..].chars().next().expect("a literal ends");
        at += c.len_utf8();
        match c {
            '"' => return (text, at),
            '\\' => at += escape(&rest[at..], &mut text),
            _ => text.push(c),
        }
    }
}

/// What stands after a backslash; its length.
fn escape(rest: &str, text: &mut String) -> usize {
    let c = rest.chars().next().expect("an escape has a letter");
    match c {
        '\n' => return rest.len() - rest.trim_start().len(),
        'u' => {
            let end = rest.find('}').expect("a code ends");
            let code = u32::from_str_radix(&rest[2..end], 16).expect("a code is a number");
            text.extend(char::from_u32(code));
            return end + 1;
        }
        'x' => {
            text.push(u8::from_str_radix(&rest[1..3], 16).expect("two digits").into());
            return 3;
        }
        'n' => text.push('\n'),
        't' => text.push('\t'),
        'r' => text.push('\r'),
        '0' => text.push('\0'),
        other => text.push(other),
    }
    c.len_utf8()
}

/// The length of a character literal; `None` is a lifetime.
fn character(rest: &str) -> Option<usize> {
    let inner = rest.strip_prefix('\'')?;
    if inner.starts_with('\\') {
        return Some(inner[2..].find('\'')? + 4);
    }
    let c = inner.chars().next()?;
    inner[c.len_utf8()..].starts_with('\'').then_some(c.len_utf8() + 2)
}

/// The tokens without attributes (but for the sentences of errors) and without what is only built
/// for tests; and the modules of tests that are files of their own.
pub fn without_tests(tokens: &[Token]) -> (Vec<Token>, Vec<String>) {
    let (mut kept, mut modules) = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < tokens.len() {
        let Some(end) = attribute_end(tokens, at) else {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        };
        let inner = &tokens[at..end];
        let has = |name: &str| inner.iter().any(|token| token.word() == Some(name));
        at = end;
        if inner.iter().filter_map(Token::word).next() == Some("error") {
            kept.extend(inner.iter().cloned());
        } else if has("cfg") && has("test") && !has("not") {
            let begin = at;
            at = item_end(tokens, at);
            let item = &tokens[begin..at];
            if let [.., Token::Word(word), Token::Word(name), Token::Mark(';')] = item
                && word == "mod"
            {
                modules.push(name.clone());
            }
        }
    }
    (kept, modules)
}

/// The end of the attribute that begins here.
fn attribute_end(tokens: &[Token], at: usize) -> Option<usize> {
    if !tokens[at].is_mark('#') {
        return None;
    }
    let bracket = at + 1 + usize::from(tokens.get(at + 1)?.is_mark('!'));
    tokens.get(bracket)?.is_mark('[').then(|| group_end(tokens, bracket))
}

/// After the group that begins here.
fn group_end(tokens: &[Token], at: usize) -> usize {
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate().skip(at) {
        match token {
            Token::Mark('(' | '[' | '{') => depth += 1,
            Token::Mark(')' | ']' | '}') => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return i + 1;
        }
    }
    tokens.len()
}

/// After the item that begins here, be it a function, a module or a statement.
fn item_end(tokens: &[Token], mut at: usize) -> usize {
    while at < tokens.len() {
        match &tokens[at] {
            Token::Mark(';' | ',') => return at + 1,
            Token::Mark('{') => return group_end(tokens, at),
            Token::Mark('}' | ')') => return at,
            Token::Mark('(' | '[') => at = group_end(tokens, at),
            _ => at += 1,
        }
    }
    at
}

#[test]
fn literals_are_read_as_the_program_has_them() {
    let source = "let a = \"x \\\"y\\\"\\u{2026}\\\n   z\"; // \"no\"\n\
                  /* \"no\" */ b\"no\" r#\"raw \"q\"\"# '\"' &'a str";
    let texts: Vec<Token> =
        tokens(source).into_iter().filter(|token| matches!(token, Token::Text(_))).collect();
    assert_eq!(texts, [Token::Text("x \"y\"…z".into()), Token::Text("raw \"q\"".into())]);
}

#[test]
fn what_is_built_for_tests_alone_is_left_out() {
    let source = "#[derive(A)] struct A; #[cfg(test)] mod tests; #[cfg(test)] mod b { fn c() {} } #[error(\"e\")] D";
    let (kept, modules) = without_tests(&tokens(source));
    let words: Vec<&str> = kept.iter().filter_map(Token::word).collect();
    assert_eq!((words, modules), (vec!["struct", "A", "error", "D"], vec!["tests".to_owned()]));
}
