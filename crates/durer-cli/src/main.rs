//! Entry point of the `durer` program.

use std::process::ExitCode;

/// This function runs before Rust's runtime, which replaces a closed standard output with a device
/// that discards everything.
#[cfg(unix)]
#[ctor::ctor(unsafe)]
fn before_main() {
    durer_cli::check_standard_output();
}

fn main() -> ExitCode {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        // Do not print panics of image decoders because they are converted to errors.
        if !durer::panics::are_expected() {
            print(panic);
        }
    }));
    ExitCode::from(durer_cli::run(std::env::args_os().collect(), end))
}

fn end(code: u8) -> ! {
    std::process::exit(i32::from(code))
}
