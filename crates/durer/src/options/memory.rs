//! Memory limits: bytes, or a share of the machine.

use sysinfo::System;

/// A limit of memory. The default is 80 percent of the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Memory {
    /// Bytes.
    Bytes(u64),
    /// Percent of the memory of the machine, or of the control group of the process.
    Percent(f64),
}

impl Default for Memory {
    fn default() -> Self {
        Memory::Percent(80.0)
    }
}

impl Memory {
    /// Reads `80%`, `8G`, `512M`, or a number of bytes.
    ///
    /// # Errors
    ///
    /// A sentence, for any other text.
    pub fn parse(text: &str) -> Result<Self, String> {
        let wrong = || "expected a size or percentage, for example 8G, 512M or 80%".to_string();
        if let Some(percent) = text.strip_suffix('%') {
            let percent = percent.trim().parse().ok().filter(|p: &f64| *p > 0.0 && *p <= 100.0).ok_or_else(wrong)?;
            return Ok(Memory::Percent(percent));
        }
        let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let shift = match text[number.len()..].to_ascii_uppercase().as_str() {
            "" | "B" => 0,
            "K" | "KB" | "KIB" => 10,
            "M" | "MB" | "MIB" => 20,
            "G" | "GB" | "GIB" => 30,
            "T" | "TB" | "TIB" => 40,
            _ => return Err(wrong()),
        };
        let number = number.trim().parse().ok().filter(|n: &f64| *n > 0.0).ok_or_else(wrong)?;
        Ok(Memory::Bytes((number * (1_u64 << shift) as f64) as u64))
    }

    /// Returns the limit in bytes; `None` if the size of the machine's memory is unknown.
    pub fn bytes(self) -> Option<u64> {
        let percent = match self {
            Memory::Bytes(bytes) => return Some(bytes),
            Memory::Percent(percent) => percent,
        };
        let mut system = System::new();
        system.refresh_memory();
        // Without /proc the size is unknown, and asking for control groups would fail.
        let machine = Some(system.total_memory()).filter(|&bytes| bytes > 0)?;
        let of_group = system.cgroup_limits().map(|limits| limits.total_memory).filter(|&bytes| bytes > 0);
        let all = of_group.unwrap_or(machine).min(machine);
        Some((all as f64 * percent / 100.0) as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        assert_eq!(Memory::parse("512M"), Ok(Memory::Bytes(512 << 20)));
        assert_eq!(Memory::parse("1.5GiB"), Ok(Memory::Bytes(3 << 29)));
        assert_eq!(Memory::parse("1000"), Ok(Memory::Bytes(1000)));
        assert_eq!(Memory::parse("80%"), Ok(Memory::Percent(80.0)));
        assert!(["", "0", "-1G", "G", "12Q", "0%", "101%", "nan", "x%"].map(Memory::parse).iter().all(Result::is_err));
        assert!(Memory::Percent(80.0).bytes() < Memory::Percent(100.0).bytes());
    }
}
