use anyhow::{Result, bail};

/// The most memory this process has held so far, in bytes; `None` where the system does not tell.
pub(crate) fn peak_bytes() -> Option<u64> {
    kilobytes(&std::fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Refuses work that would take more memory than there is: better now than killed after minutes. `what`, in the plural,
/// is what needs it, `instead` what to ask for.
pub(crate) fn check_room(needed: u64, what: &str, instead: &str) -> Result<()> {
    let free = std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| kilobytes(&text, "MemAvailable:"));
    if let Some(free) = free.filter(|&free| needed > free) {
        let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
        bail!(
            "{what} need about {:.1} GiB of memory, but only {:.1} GiB are free; choose {instead}",
            gib(needed),
            gib(free)
        );
    }
    Ok(())
}

/// The value behind `key` in one of the system's tables, in bytes.
fn kilobytes(table: &str, key: &str) -> Option<u64> {
    let value = table.lines().find_map(|line| line.strip_prefix(key))?;
    value.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_systems_tables_are_read_and_odd_ones_are_not() {
        let table = "VmPeak:\t  9 kB\nVmHWM:\t  1234 kB\n";
        assert_eq!(kilobytes(table, "VmHWM:"), Some(1234 * 1024));
        assert_eq!(kilobytes(table, "VmRSS:"), None);
        assert_eq!(kilobytes("VmHWM: many", "VmHWM:"), None);
    }

    #[test]
    fn work_larger_than_any_memory_is_refused_with_figures() {
        assert!(check_room(1, "tiny pictures", "").is_ok());
        if std::path::Path::new("/proc/meminfo").exists() {
            let error = check_room(1 << 60, "huge pictures", "smaller ones").unwrap_err().to_string();
            assert!(error.starts_with("huge pictures need about 1073741824.0 GiB of memory, but only "), "{error}");
            assert!(error.ends_with(" GiB are free; choose smaller ones"), "{error}");
        }
    }
}
