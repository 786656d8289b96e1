//! `cargo xtask prose`: finds unusual words and phrases in comments, messages and documents.
//!
//! Reads comments, messages (string literals of several words) and documents, joins the lines of
//! each paragraph, and searches for the phrases of `xtask/prose.txt`. Also checks that comments
//! have at most 100 columns.

use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Maximum number of columns of a comment.
const MAX_COLUMNS: usize = 100;
/// Marker for a line of code in which listed words are allowed.
const KEEP_MARKER: &str = "// prose: keep";

/// A phrase to avoid, from `xtask/prose.txt`, and what to write instead.
struct Rule {
    phrase: String,
    instead: String,
    /// True if the phrase is only forbidden at the start of a doc comment.
    begin: bool,
}

/// A paragraph of a comment or document, joined to one line so that phrases can be searched.
struct Paragraph {
    text: String,
    /// Byte offset at which each line starts, and the number of the line.
    lines: Vec<(usize, usize)>,
    /// True if the paragraph is the start of a doc comment.
    begins: bool,
}

impl Paragraph {
    fn line(&self, at: usize) -> usize {
        self.lines.iter().rev().find(|line| line.0 <= at).map_or(0, |line| line.1)
    }
}

/// A listed phrase, or a comment that is too wide, at a line of a file.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Finding {
    file: String,
    line: usize,
    message: String,
    /// Rule that is broken, with the words to write instead.
    rule: String,
}

/// Prints findings and counts. Fails if there are any findings.
pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let only: Vec<&String> = arguments.iter().filter(|argument| !argument.starts_with("--")).collect();
    let quiet = arguments.iter().any(|argument| argument == "--count");
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for Finding { file, line, message, rule } in findings(&crate::root()?)? {
        if !only.is_empty() && !only.iter().any(|part| file.contains(part.as_str())) {
            continue;
        }
        *counts.entry(rule).or_default() += 1;
        if !quiet {
            println!("{file}:{line}: {message}");
        }
    }
    let mut counts: Vec<(String, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|row| std::cmp::Reverse(row.1));
    counts.iter().for_each(|(rule, count)| println!("{count:6} {rule}"));
    let all: usize = counts.iter().map(|row| row.1).sum();
    println!("{all:6} in all");
    Ok(if all == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Searches all sources and documents of the repository.
fn findings(root: &Path) -> Result<Vec<Finding>> {
    let list = std::fs::read_to_string(root.join("xtask/prose.txt"))?;
    let rules = rules(&list).context("xtask/prose.txt")?;
    let mut findings = Vec::new();
    for path in sources(root)? {
        let file = path.strip_prefix(root)?.to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).with_context(|| file.clone())?;
        findings.extend(find_phrases(&file, &text, &rules));
    }
    Ok(findings)
}

fn rules(list: &str) -> Result<Vec<Rule>> {
    let (mut rules, mut begin) = (Vec::new(), None);
    for line in list.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')) {
        match line {
            "[begin]" => begin = Some(true),
            "[phrase]" => begin = Some(false),
            _ => {
                let (phrase, instead) = line.split_once('|').context("a row is `phrase | instead`")?;
                let begin = begin.context("a row must be below [begin] or [phrase]")?;
                rules.push(Rule { phrase: phrase.trim().to_lowercase(), instead: instead.trim().into(), begin });
            }
        }
    }
    Ok(rules)
}

/// Returns the paths of Rust sources and documents, sorted. Excludes hidden folders, build outputs
/// and npm packages.
fn sources(root: &Path) -> Result<Vec<PathBuf>> {
    let (mut all, mut folders) = (Vec::new(), vec![root.to_path_buf()]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && !name.starts_with('.') && name != "target" && name != "node_modules" {
                folders.push(path);
            } else if name.ends_with(".rs") || name.ends_with(".md") {
                all.push(path);
            }
        }
    }
    all.sort();
    Ok(all)
}

/// Returns the findings in the text of a file, in the order of its lines.
fn find_phrases(file: &str, text: &str, rules: &[Rule]) -> Vec<Finding> {
    let is_document = file.ends_with(".md");
    let mut all = Vec::new();
    let mut add = |line, message, rule| all.push(Finding { file: file.into(), line, message, rule });
    for (number, line) in text.lines().enumerate() {
        let is_comment = !is_document && line.trim_start().starts_with("//");
        if is_comment && line.chars().count() > MAX_COLUMNS && !line.contains("http") {
            let message = format!("{} columns", line.chars().count());
            add(number + 1, message, format!("more than {MAX_COLUMNS} columns"));
        }
    }
    let paragraphs = if is_document { document(text) } else { code(text) };
    for paragraph in &paragraphs {
        let lower = paragraph.text.to_lowercase();
        for rule in rules {
            for at in positions(&lower, rule, paragraph.begins) {
                let message = match rule.instead.as_str() {
                    "" => format!("`{}`", rule.phrase),
                    instead => format!("`{}`: write {instead}", rule.phrase),
                };
                let kind = if rule.begin { "begins: " } else { "" };
                add(paragraph.line(at), message, format!("{kind}{}", rule.phrase));
            }
        }
    }
    all.sort();
    all
}

/// Returns the byte offsets at which a rule matches whole words in a lower-case text.
fn positions(lower: &str, rule: &Rule, begins: bool) -> Vec<usize> {
    let (phrase, open) = rule.phrase.strip_suffix('*').map_or((rule.phrase.as_str(), false), |phrase| (phrase, true));
    let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    let whole = |&at: &usize| {
        let end = at + phrase.len();
        !is_word(lower[..at].chars().next_back()) && (open || !is_word(lower[end..].chars().next()))
    };
    if rule.begin {
        return if begins && lower.starts_with(phrase) && whole(&0) { vec![0] } else { Vec::new() };
    }
    lower.match_indices(phrase).map(|found| found.0).filter(whole).collect()
}

/// Returns the paragraphs of a document, without code blocks and code spans.
fn document(text: &str) -> Vec<Paragraph> {
    let (mut all, mut fenced) = (vec![Paragraph::empty(false)], false);
    for (number, line) in text.lines().enumerate() {
        fenced ^= line.trim_start().starts_with("```");
        if fenced || line.trim().is_empty() || line.starts_with("    ") || line.trim_start().starts_with("```") {
            all.push(Paragraph::empty(false));
        } else if let Some(last) = all.last_mut() {
            last.push(number + 1, &without_code(line));
        }
    }
    all
}

/// Returns the comments and messages of Rust code as paragraphs.
fn code(text: &str) -> Vec<Paragraph> {
    let mut all: Vec<Paragraph> = Vec::new();
    // `None` if the previous line is not a comment; otherwise true for a doc comment.
    let mut before = None;
    for (number, line) in text.lines().enumerate() {
        let trimmed = line.trim_start();
        if trimmed.starts_with("//") {
            let is_doc = trimmed.starts_with("///") || trimmed.starts_with("//!");
            let content = trimmed.trim_start_matches(['/', '!']).trim();
            if before != Some(is_doc) || content.is_empty() {
                all.push(Paragraph::empty(is_doc && before != Some(true)));
            }
            if let Some(last) = all.last_mut() {
                last.push(number + 1, &without_code(content));
            }
            before = Some(is_doc);
            continue;
        }
        before = None;
        if line.ends_with(KEEP_MARKER) {
            continue;
        }
        for literal in literals(line).into_iter().filter(|literal| literal.trim().contains(' ')) {
            let mut paragraph = Paragraph::empty(false);
            paragraph.push(number + 1, &without_code(&literal));
            all.push(paragraph);
        }
    }
    all
}

impl Paragraph {
    fn empty(begins: bool) -> Self {
        Paragraph { text: String::new(), lines: Vec::new(), begins }
    }

    fn push(&mut self, number: usize, line: &str) {
        if !self.text.is_empty() {
            self.text.push(' ');
        }
        self.lines.push((self.text.len(), number));
        self.text.push_str(line.trim());
    }
}

/// Replaces code spans and format placeholders with a mark.
fn without_code(line: &str) -> String {
    let text: String = line.split('`').enumerate().map(|(i, part)| if i % 2 == 0 { part } else { "§" }).collect();
    let mut parts = text.split('{');
    let first = parts.next().unwrap_or_default().to_string();
    parts.fold(first, |all, part| match part.split_once('}') {
        Some((_, rest)) => all + "§" + rest,
        None => all + "{" + part,
    })
}

/// Returns the contents of the string literals that start or continue on a line, based on this line
/// alone.
fn literals(line: &str) -> Vec<String> {
    let (mut all, mut current, mut escaped) = (Vec::new(), None::<String>, false);
    for c in line.chars() {
        match (&mut current, c) {
            (None, '"') => current = Some(String::new()),
            (None, _) => {}
            (Some(_), '"') if !escaped => all.extend(current.take()),
            (Some(text), _) => text.push(c),
        }
        escaped = c == '\\' && !escaped;
    }
    // If a literal continues on the next line, keep the part on this line.
    all.extend(current);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str, is_document: bool) -> Vec<(usize, String)> {
        let rules =
            rules("[begin]\nwhat | a noun\n[phrase]\nno number | NaN\nlamp | light\nreckon* | compute").unwrap();
        let file = if is_document { "a.md" } else { "a.rs" };
        find_phrases(file, text, &rules).into_iter().map(|finding| (finding.line, finding.rule)).collect()
    }

    #[test]
    fn repository_has_no_listed_phrases() {
        let found = findings(&crate::root().unwrap()).unwrap();
        let lines: Vec<String> =
            found.iter().map(|Finding { file, line, message, .. }| format!("{file}:{line}: {message}")).collect();
        assert!(lines.is_empty(), "{}", lines.join("\n"));
    }

    #[test]
    fn beginnings_of_doc_comments_are_found() {
        assert_eq!(messages("/// What it is.\nfn a() {}\n// What follows.\n", false), [(1, "begins: what".into())]);
        assert_eq!(messages("/// A thing.\n///\n/// What else.\n", false), []);
    }

    #[test]
    fn phrases_are_found_across_lines_and_in_messages() {
        assert_eq!(messages("// It is no\n// number.\n", false), [(1, "no number".into())]); // prose: keep
        assert_eq!(messages("let a = say(\"two lamp posts\"); // x\n", false), [(1, "lamp".into())]); // prose: keep
        assert_eq!(messages("let lamp = \"lamp\"; // `lamp`\n", false), []); // prose: keep
        assert_eq!(messages("A lamp.\n\n    lamp\n\n```\nlamp\n```\nIt reckons.\n", true).len(), 2); // prose: keep
        assert_eq!(messages("let a = \"a lamp here\"; // prose: keep\n", false), []); // prose: keep
    }

    #[test]
    fn long_comments_are_found() {
        let long = format!("// {}\n", "a ".repeat(60));
        assert_eq!(messages(&long, false), [(1, "more than 100 columns".into())]);
    }
}
