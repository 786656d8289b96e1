//! `durer photo tour`.

use super::args::TourArgs;
use crate::Failure;

pub fn run(_args: &TourArgs) -> Result<(), Failure> {
    Err(crate::bad("later"))
}
