//! Runs `lib.rs` as a native program. Prints a hash for each part or, with the argument `time`, the
//! time for one million rays.

#[path = "lib.rs"]
mod module;

use std::time::Instant;

fn main() {
    if std::env::args().nth(1).as_deref() == Some("time") {
        module::prepare(1_000_000);
        for _ in 0..5 {
            let start = Instant::now();
            let hits = module::shoot();
            println!("{:.0} ms, {hits} hits", 1e3 * start.elapsed().as_secs_f64());
        }
        return;
    }
    for (name, hash) in module::PARTS {
        println!("{name} {:016x}", hash());
    }
}
