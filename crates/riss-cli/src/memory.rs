//! Runs that need more memory than there is are refused before they start, with the numbers.

use riss::analysis::RunSize;
use std::path::Path;

/// How much memory a run may ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MemoryLimit {
    /// What the machine has free.
    Free,
    /// So many bytes.
    Bytes(f64),
    /// Any.
    None,
}

impl MemoryLimit {
    /// `12GB`, `500MB`, `free` or `none`.
    pub fn parse(text: &str) -> Result<Self, String> {
        match text {
            "free" => return Ok(Self::Free),
            "none" => return Ok(Self::None),
            _ => {}
        }
        let bad = || "it must be a size such as 12GB or 500MB, or `free`, or `none`".to_string();
        let at = text.find(|c: char| !c.is_ascii_digit() && c != '.').ok_or_else(bad)?;
        let (number, unit) = text.split_at(at);
        let number: f64 = number.parse().map_err(|_| bad())?;
        let unit = match unit.trim() {
            "kB" | "KB" => 1e3,
            "MB" => 1e6,
            "GB" => 1e9,
            "TB" => 1e12,
            _ => return Err(bad()),
        };
        if number > 0.0 { Ok(Self::Bytes(number * unit)) } else { Err(bad()) }
    }

    /// Why a run of this size shall not start, if it shall not.
    pub fn refusal(self, size: &RunSize) -> Option<String> {
        let (limit, whose) = match self {
            Self::Free => (free_bytes()?, "are free"),
            Self::Bytes(bytes) => (bytes, "are allowed"),
            Self::None => return None,
        };
        // Also if the number of nodes is not finite.
        let fits = size.bytes <= limit;
        (!fits).then(|| {
            format!(
                "the case asks for about {} nodes, which need about {} of memory, and {} {whose}; choose a larger spacing \
                 of nodes, or let it run all the same with --memory-limit none",
                count(size.n_nodes),
                amount(size.bytes),
                amount(limit)
            )
        })
    }
}

/// A number of nodes with as many digits as mean something.
fn count(n: f64) -> String {
    match n {
        n if n < 1e3 => format!("{n:.0}"),
        n if n < 1e6 => format!("{:.0}00", n / 100.0),
        _ => format!("{n:.1e}"),
    }
}

fn amount(bytes: f64) -> String {
    if bytes < 0.95e9 { format!("{:.0} MB", bytes / 1e6) } else { format!("{:.1} GB", bytes / 1e9) }
}

/// Memory that the system would give now, where it tells: what is free on the machine, and within the control group if
/// there is one [bytes].
fn free_bytes() -> Option<f64> {
    let machine = std::fs::read_to_string("/proc/meminfo").ok().as_deref().and_then(available);
    let number = |name: &str| -> Option<f64> {
        std::fs::read_to_string(Path::new("/sys/fs/cgroup").join(name)).ok()?.trim().parse().ok()
    };
    let group = number("memory.max").zip(number("memory.current")).map(|(most, used)| most - used);
    match (machine, group) {
        (Some(machine), Some(group)) => Some(machine.min(group)),
        (machine, group) => machine.or(group),
    }
}

/// `MemAvailable` of `/proc/meminfo` [bytes].
fn available(meminfo: &str) -> Option<f64> {
    let line = meminfo.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * kibibytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_sizes_or_words() {
        assert_eq!(MemoryLimit::parse("12GB"), Ok(MemoryLimit::Bytes(12e9)));
        assert_eq!(MemoryLimit::parse("1.5 MB"), Ok(MemoryLimit::Bytes(1.5e6)));
        assert_eq!(MemoryLimit::parse("none"), Ok(MemoryLimit::None));
        for text in ["12", "GB", "-1GB", "0GB", "1XB", ""] {
            assert!(MemoryLimit::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused_with_the_numbers() {
        let size = RunSize { n_nodes: 123_456.0, bytes: 4.3e9 };
        let message = MemoryLimit::Bytes(2e9).refusal(&size).unwrap();
        assert!(
            message.contains("123500 nodes") && message.contains("4.3 GB") && message.contains("2.0 GB are allowed")
        );
        assert_eq!(MemoryLimit::Bytes(5e9).refusal(&size), None);
        assert_eq!(MemoryLimit::None.refusal(&RunSize { n_nodes: f64::INFINITY, bytes: f64::INFINITY }), None);
        assert!(MemoryLimit::Bytes(5e9).refusal(&RunSize { n_nodes: f64::NAN, bytes: f64::NAN }).is_some());
    }

    #[test]
    fn the_system_says_how_much_is_free() {
        assert_eq!(available("MemTotal: 9 kB\nMemAvailable:    2 kB\n"), Some(2048.0));
        assert_eq!(available("MemTotal: 9 kB\n"), None);
    }
}
