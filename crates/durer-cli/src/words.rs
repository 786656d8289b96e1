//! Implements `durer words`, which prints the language reference.

mod topics;

use crate::failure::{Failure, invalid_input};
use crate::terminal::print_line;
use durer::diag::did_you_mean;
use durer::dialect::Dialect;
use durer::format::course::reference::{Chapter, Entry, FieldEntry, all_words, dialect_names, entries};
use topics::{SYNONYMS, example, topic};

/// Arguments of `durer words`.
#[derive(clap::Args)]
pub struct WordsArgs {
    /// Word of the language, or a term such as `glass` or `area light` [default: list every word
    /// that begins a block]
    #[arg(value_name = "WORD")]
    pub words: Vec<String>,
    /// Show only words of this dialect
    #[arg(long)]
    pub dialect: Option<String>,
    /// Describe every word with its fields, as a sheet to print
    #[arg(long, conflicts_with = "words")]
    pub all: bool,
}

/// Runs `durer words`.
pub fn run(args: &WordsArgs) -> Result<(), Failure> {
    let dialect = args.dialect.as_deref().map(dialect_by_name).transpose()?;
    let has = |set| dialect.is_none_or(|dialect: Dialect| dialect.is_in(set));
    let all: Vec<Entry> = entries().into_iter().filter(|entry| has(entry.dialects())).collect();
    if args.all {
        all.iter().for_each(|entry| print_line(&format!("{}\n", described(entry))));
        return Ok(());
    }
    if args.words.is_empty() {
        list(&all, dialect);
        return Ok(());
    }
    let word = &args.words.join(" ");
    // `point light` means `PointLight`.
    let joined = word.replace([' ', '-'], "");
    let is = |spelled: &str| spelled.eq_ignore_ascii_case(word) || spelled.eq_ignore_ascii_case(&joined);
    let begun: Vec<&Entry> = all.iter().filter(|entry| entry.keywords.iter().any(|k| has(k.1) && is(k.0))).collect();
    let is_field = |field: &&FieldEntry| field.words.iter().any(|spelled| has(spelled.1) && is(spelled.0));
    let in_blocks: Vec<(&Entry, &FieldEntry)> =
        all.iter().flat_map(|entry| entry.fields.iter().filter(is_field).map(move |field| (entry, field))).collect();
    if begun.is_empty() && in_blocks.is_empty() {
        let term = &with_spaces(word);
        let (found, usage) = (mentions(&all, term), topic(term));
        if let Some(usage) = usage {
            print_line(&format!("`{word}` is not a word of the language: {usage}."));
        }
        if !found.is_empty() {
            match usage {
                Some(_) => print_line("\nThese words are about it:"),
                None => print_line(&format!("`{word}` is not a word of the language. These words are about it:")),
            }
            found.iter().for_each(|row| print_line(row));
            if let Some(example) = example(term) {
                print_line(&format!("\nExample:\n  {example}"));
            }
            print_line("\n`durer words WORD` describes a word and its fields.");
        }
        if !found.is_empty() || usage.is_some() {
            return Ok(());
        }
        let place = dialect.map_or("the language".to_string(), |dialect| format!("the dialect `{}`", dialect.name()));
        let suggestion = did_you_mean(word, all_words());
        let suggestion =
            suggestion.map_or("`durer words` lists them all".to_string(), |near| format!("did you mean `{near}`?"));
        return Err(invalid_input(format!("`{word}` is not a word of {place}: {suggestion}")));
    }
    let mut parts: Vec<String> = begun.into_iter().map(described).collect();
    if !in_blocks.is_empty() {
        let rows = in_blocks.into_iter().map(|(entry, field)| format!("in {}\n{}", entry.name(), field_text(field)));
        parts.push(rows.collect::<Vec<_>>().join("\n"));
    }
    print_line(&parts.join("\n\n"));
    Ok(())
}

/// Splits a word such as `AreaLight` at its capital letters.
fn with_spaces(word: &str) -> String {
    let (mut spaced, mut was_small) = (String::new(), false);
    for letter in word.chars() {
        if was_small && letter.is_uppercase() {
            spaced.push(' ');
        }
        was_small = letter.is_lowercase();
        spaced.push(letter);
    }
    spaced
}

fn dialect_by_name(name: &str) -> Result<Dialect, Failure> {
    let known = || Dialect::ALL.map(Dialect::name).join(", ");
    Dialect::from_name(name)
        .ok_or_else(|| invalid_input(format!("`{name}` is not a dialect; known dialects: {}", known())))
}

/// Returns a row for each word whose documentation mentions a term or one of its synonyms. Words
/// whose name contains the term come first.
fn mentions(all: &[Entry], term: &str) -> Vec<String> {
    let term = term.to_lowercase();
    if term.len() < 3 {
        return Vec::new();
    }
    let synonyms = SYNONYMS.iter().find(|(word, _)| *word == term).map_or(&[][..], |(_, synonyms)| synonyms);
    let terms: Vec<&str> = std::iter::once(term.as_str()).chain(synonyms.iter().copied()).collect();
    // In a text, a term is the beginning of a word; in a name such as `AreaLight`, it can also
    // stand inside.
    let is_named = |name: &str| terms.iter().any(|term| name.to_lowercase().contains(term));
    let is_mentioned = |text: &str| {
        let text = text.to_lowercase();
        let begins = |at: usize| !text[..at].ends_with(char::is_alphanumeric);
        // `softshadow` means `soft shadow`.
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).collect();
        let is_pair = |term: &str| {
            words.windows(2).any(|pair| {
                term.strip_prefix(pair[0])
                    .is_some_and(|rest| pair[0].len() > 2 && !rest.is_empty() && pair[1].starts_with(rest))
            })
        };
        terms.iter().any(|term| is_pair(term) || text.match_indices(term).any(|(at, _)| begins(at)))
    };
    // Words with exactly the name come first, then those whose name contains it.
    let rank = |name: &str| match terms.contains(&&*name.to_lowercase()) {
        true => 0,
        false if is_named(name) => 1,
        false => 2,
    };
    let mut rows: Vec<(u32, String, String)> = Vec::new();
    for entry in all {
        let name = entry.keywords[0].0;
        if is_named(name) || is_mentioned(&entry.doc) {
            rows.push((rank(name), name.into(), first_sentence(&entry.doc).into()));
        }
        for field in &entry.fields {
            let Some((word, _)) = field.words.first() else { continue };
            if is_named(word) || is_mentioned(&field.doc) {
                rows.push((rank(word), format!("{name}: {word}"), first_sentence(&field.doc).into()));
            }
        }
    }
    rows.sort_by_key(|(rank, ..)| *rank);
    rows.truncate(24);
    let width = rows.iter().map(|(_, name, _)| name.chars().count()).max().unwrap_or(0);
    rows.into_iter().map(|(_, name, doc)| format!("  {name:<width$}  {doc}")).collect()
}

fn first_sentence(doc: &str) -> &str {
    doc.split_inclusive(". ").next().unwrap_or_default().trim()
}

fn list(all: &[Entry], dialect: Option<Dialect>) {
    for chapter in Chapter::ALL {
        let of_chapter: Vec<&Entry> = all.iter().filter(|entry| entry.chapter == chapter).collect();
        if of_chapter.is_empty() {
            continue;
        }
        print_line(chapter.title());
        for (i, entry) in of_chapter.iter().enumerate() {
            // A word can begin different blocks, which `durer words WORD` describes together.
            if of_chapter[..i].iter().any(|earlier| earlier.name() == entry.name()) {
                continue;
            }
            let own = entry.keywords.iter().find(|keyword| dialect.is_none_or(|dialect| dialect.is_in(keyword.1)));
            let first = first_sentence(&entry.doc);
            print_line(&format!("  {:<22}{first}", own.unwrap_or(&entry.keywords[0]).0));
        }
    }
    print_line("\n`durer words WORD` describes a word and its fields.");
}

fn described(entry: &Entry) -> String {
    let spelled: Vec<String> =
        entry.keywords.iter().map(|&(word, dialects)| format!("{word} ({})", dialect_names(dialects))).collect();
    let mut text = format!("{}\n  {}", spelled.join(", "), entry.doc);
    if !entry.values.is_empty() {
        text += &format!("\n\n  {} {}", entry.name(), entry.values);
    }
    if !entry.fields.is_empty() {
        let fields: Vec<String> = entry.fields.iter().map(field_text).collect();
        text += &format!("\n\n{}", fields.join("\n"));
    }
    text += &format!("\n\n  Example:\n    {}", entry.example);
    text
}

fn field_text(field: &FieldEntry) -> String {
    let words = field.words.iter().filter(|spelled| spelled.1 != 0);
    let words: Vec<String> = words.map(|&(word, dialects)| format!("{word} ({})", dialect_names(dialects))).collect();
    let given = match (&field.default, field.required) {
        (Some(default), _) => format!("; default {default}"),
        (None, true) => "; required".into(),
        (None, false) => String::new(),
    };
    format!("  {}\n      {}{given}\n      {}", words.join(", "), field.value.replace('`', ""), field.doc)
}
