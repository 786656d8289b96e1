//! Memory limits, in bytes or as a percentage of the memory that is available to the process.

use std::path::{Path, PathBuf};
use sysinfo::System;

/// Memory limit of a render, in bytes or as a percentage. The default is 80 percent of the memory
/// that is available to the process.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Memory {
    /// Bytes.
    Bytes(u64),
    /// Percentage of the memory that is available to the process. The available memory is the
    /// minimum of the memory of the machine, the limits of the control groups of the process, and
    /// its remaining address space.
    Percent(f64),
}

impl Default for Memory {
    fn default() -> Self {
        Memory::Percent(80.0)
    }
}

impl Memory {
    /// Parses `80%`, `8G`, `512M`, or a number of bytes.
    ///
    /// # Errors
    ///
    /// Returns a message for any other text.
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

    /// Returns the limit in bytes, or the largest number if the memory size of the machine is
    /// unknown.
    pub fn limit(self) -> u64 {
        self.bytes().unwrap_or(u64::MAX)
    }

    /// Returns the limit in bytes, or `None` if the memory size of the machine is unknown.
    pub fn bytes(self) -> Option<u64> {
        let percent = match self {
            Memory::Bytes(bytes) => return Some(bytes),
            Memory::Percent(percent) => percent,
        };
        let mut system = System::new();
        system.refresh_memory();
        // Without `/proc`, the size of the memory is unknown, and control groups cannot be read.
        let machine = Some(system.total_memory()).filter(|&bytes| bytes > 0)?;
        let all = [of_groups(), address_space()].into_iter().flatten().fold(machine, u64::min);
        Some((all as f64 * percent / 100.0) as u64)
    }
}

/// Returns the lowest memory limit of the control groups that contain this process. Containers and
/// Slurm set such limits.
fn of_groups() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let limit = |file: &PathBuf| std::fs::read_to_string(file).ok()?.trim().parse().ok();
    limit_files(&groups, Path::new("/sys/fs/cgroup")).iter().filter_map(limit).filter(|&bytes| bytes > 0).min()
}

/// Returns the files that can limit memory, given the text of `/proc/self/cgroup`. These are the
/// files of each group and of all enclosing groups. In a container, the paths can refer to the
/// host, and then only the root exists.
///
/// Source: *Control Group v2* and *Memory Resource Controller*, Linux kernel documentation.
fn limit_files(groups: &str, root: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for line in groups.lines() {
        let mut fields = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (fields.next(), fields.next()) else { continue };
        let (root, file) = match controllers {
            "" => (root.to_path_buf(), "memory.max"),
            v1 if v1.split(',').any(|name| name == "memory") => (root.join("memory"), "memory.limit_in_bytes"),
            _ => continue,
        };
        let group = root.join(path.trim_start_matches('/'));
        files.extend(group.ancestors().take_while(|folder| folder.starts_with(&root)).map(|folder| folder.join(file)));
    }
    files
}

/// Address space in bytes that a thread reserves for its stack and for small allocations, although
/// it uses little of it.
const THREAD_SPACE: u64 = 64 << 20;

/// Address space in bytes that any command needs in addition.
const COMMAND_SPACE: u64 = 128 << 20;

/// Checks that the address space, which `ulimit -v` can limit, suffices for the threads and a small
/// scene. Failed allocations of a few bytes end a program without a message.
///
/// # Errors
///
/// Returns a message that states the remaining and the necessary size.
pub fn check_address_space() -> Result<(), String> {
    let Some(left) = remaining_address_space().filter(|left| *left < COMMAND_SPACE + threads_space()) else {
        return Ok(());
    };
    let needed = (COMMAND_SPACE + threads_space()) >> 20;
    let left = left >> 20;
    Err(format!("only {left} MiB of address space are left (`ulimit -v`), but {needed} MiB are needed"))
}

/// Returns the address space that the threads of a render reserve.
fn threads_space() -> u64 {
    let of_rayon =
        std::env::var("RAYON_NUM_THREADS").ok().and_then(|count| count.parse().ok()).filter(|&count| count > 0);
    let of_machine = || std::thread::available_parallelism().map_or(1, |count| count.get() as u64);
    THREAD_SPACE * of_rayon.unwrap_or_else(of_machine)
}

/// Returns the remaining address space for a render if it is limited.
fn address_space() -> Option<u64> {
    remaining_address_space().map(|left| left.saturating_sub(threads_space()))
}

/// Returns the remaining address space if it is limited, for example by `ulimit -v`.
#[cfg(unix)]
fn remaining_address_space() -> Option<u64> {
    let limit = rustix::process::getrlimit(rustix::process::Resource::As).current?;
    // The first number is the size of the address space in pages.
    let sizes = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages: u64 = sizes.split_whitespace().next().and_then(|pages| pages.parse().ok()).unwrap_or(0);
    Some(limit.saturating_sub(pages * rustix::param::page_size() as u64))
}

#[cfg(not(unix))]
fn remaining_address_space() -> Option<u64> {
    None
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

    #[test]
    fn parent_groups_limit_memory_too() {
        let limits_of = |text: &str| -> Vec<String> {
            limit_files(text, Path::new("/c")).iter().map(|file| file.display().to_string()).collect()
        };
        let slurm = ["/c/slurm/job_1/memory.max", "/c/slurm/memory.max", "/c/memory.max"];
        assert_eq!(limits_of("0::/slurm/job_1\n"), slurm);
        assert_eq!(limits_of("0::/\n"), ["/c/memory.max"]);
        let old = "12:cpu,cpuacct:/a\n9:memory:/docker/x\n0::/\nrubbish\n";
        let limit = "memory.limit_in_bytes";
        let old_files =
            ["/c/memory/docker/x", "/c/memory/docker", "/c/memory"].map(|folder| format!("{folder}/{limit}"));
        assert_eq!(limits_of(old), [&old_files[..], &["/c/memory.max".to_string()]].concat());
    }
}
