//! Compares light with known answers, in tables for lighting engineers: docs/validation.md.

mod cases;
mod measure;
mod sampling;

use anyhow::{Result, bail};
use std::fmt::Write as _;
use std::process::ExitCode;

/// Default samples of each case.
const SAMPLES: u32 = 1 << 18;

/// A growing table, and the number of its wrong rows.
#[derive(Default)]
struct Table {
    text: String,
    wrong: u32,
}

impl Table {
    fn head(&mut self, title: &str, text: &str, columns: &str) {
        let rule: String =
            columns.split('|').map(|column| if column.starts_with('>') { "| ---: " } else { "| --- " }).collect();
        let names: String = columns.split('|').map(|column| format!("| {} ", column.trim_start_matches('>'))).collect();
        println!("\n{title}");
        self.text += &format!("\n## {title}\n\n{text}\n\n{names}|\n{rule}|\n");
    }

    fn row(&mut self, row: &str, right: bool) {
        println!("{row}{}", if right { "" } else { "  WRONG" });
        self.wrong += u32::from(!right);
        let _ = writeln!(self.text, "{row}");
    }
}

pub fn run(arguments: &[String]) -> Result<ExitCode> {
    let samples = match arguments {
        [] => SAMPLES,
        [flag, number] if flag == "--samples" => number.parse()?,
        _ => bail!("usage: cargo xtask validate [--samples N]"),
    };
    let mut table =
        Table { text: "# Light against answers that are known\n\nMade by `cargo xtask validate`.\n".into(), wrong: 0 };
    measure::light(&mut table, samples)?;
    sampling::furnaces(&mut table);
    sampling::densities(&mut table)?;
    if table.wrong > 0 {
        println!("{} rows are wrong", table.wrong);
        return Ok(ExitCode::FAILURE);
    }
    std::fs::write("docs/validation.md", table.text)?;
    println!("wrote docs/validation.md");
    Ok(ExitCode::SUCCESS)
}
