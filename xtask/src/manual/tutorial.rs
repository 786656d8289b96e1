//! Pictures of the tutorial, rendered from the scenes and commands on its pages.

use anyhow::{Context, Result, ensure};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Renders every picture that a page of the tutorial shows, next to the page.
pub fn render_pictures(durer: &Path, folder: &Path) -> Result<()> {
    for entry in fs::read_dir(folder)? {
        let page = entry?.path();
        if page.extension().is_none_or(|extension| extension != "md") {
            continue;
        }
        let text = fs::read_to_string(&page)?;
        let scratch = tempfile::tempdir()?;
        for (name, scene) in scenes(&text) {
            fs::write(scratch.path().join(name), scene)?;
        }
        for (command, picture) in shown(&text) {
            let words = command.split_whitespace();
            let output = Command::new(durer).args(words).current_dir(scratch.path()).output()?;
            let errors = String::from_utf8_lossy(&output.stderr);
            ensure!(output.status.success(), "{}: durer {command}: {errors}", page.display());
            fs::copy(scratch.path().join(picture), folder.join(picture)).context("the picture was not written")?;
        }
    }
    println!("wrote {}", folder.display());
    Ok(())
}

/// Returns the scenes on a page: fenced blocks that begin with a comment that names their file.
fn scenes(text: &str) -> Vec<(&str, &str)> {
    let blocks = text.split("\n```\n").skip(1).step_by(2);
    let name = |block: &'_ str| -> Option<usize> {
        block.lines().next()?.strip_prefix("# ").filter(|name| name.ends_with(".txt")).map(str::len)
    };
    blocks.filter_map(|block| name(block).map(|length| (&block[2..2 + length], block))).collect()
}

/// Returns the commands that write a picture that the page shows, and the names of the pictures.
fn shown(text: &str) -> Vec<(&str, &str)> {
    let commands = text.lines().filter_map(|line| line.strip_prefix("    durer "));
    let written = |command: &'_ str| -> Option<usize> {
        let start = command.find(" -o ")? + 4;
        Some(start).filter(|start| {
            let name = command[*start..].split(' ').next().unwrap_or_default();
            text.contains(&format!("]({name})"))
        })
    };
    let rows = commands.filter_map(|command| written(command).map(|start| (command, &command[start..])));
    rows.map(|(command, rest)| (command, rest.split(' ').next().unwrap_or_default())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_and_commands_of_a_page() {
        let text = "# Page\n\n```\n# a.txt\nGroup { }\n```\n\n    durer render a.txt -o a.png --size 8x8\n    durer \
                    render a.txt -o b.png\n\n![A](a.png)\n";
        assert_eq!(scenes(text), [("a.txt", "# a.txt\nGroup { }")]);
        assert_eq!(shown(text), [("render a.txt -o a.png --size 8x8", "a.png")]);
    }
}
