//! Commands for those who build Dürer.

mod course;
mod solids;

use std::process::ExitCode;

const USAGE: &str = "Commands:
  cargo xtask course [--guess] [--only TEXT] [--keep FOLDER]
      Render every row of the course's reference pictures through `durer course`, and compare.
      --guess: do not name the program, so that the dialect is guessed. --only: rows that contain TEXT.
      --keep: leave our pictures there, with pictures of the differences.
  cargo xtask solids
      A million random points against the Boolean of the parts of random solids, and the cost of rays at solids of a
      thousand parts beside that at the same parts as plain objects.
The course is found in ../shared, or where DURER_CORPUS says.";

fn main() -> anyhow::Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.first().map(String::as_str) {
        Some("course") => course::run(&arguments[1..]),
        Some("solids") => solids::run(),
        _ => {
            println!("{USAGE}");
            Ok(ExitCode::from(2))
        }
    }
}
