//! The `durer` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(durer_cli::run(std::env::args_os().collect()))
}
