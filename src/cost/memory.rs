//! Memory: what the process has held, and what it can still be given.

use crate::error::Error;
use crate::words::describe_bytes;
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// Lets [`peak_memory`] count from now on, where the system can.
pub fn forget_peak_memory() {
    // Refused, the peak stays that of the process.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Largest memory that the process has held, bytes; `None` where the system does not tell.
pub fn peak_memory() -> Option<u64> {
    status("VmHWM")
}

/// A size that Linux tells of the process, bytes.
fn status(key: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix(key)?.strip_prefix(':'))?;
    let kib: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kib * 1024)
}

/// Refuses what takes more than `needed` bytes where there is less; `parts` says what takes them.
///
/// # Errors
/// [`Error::Memory`].
pub(crate) fn require(needed: f64, parts: impl Fn() -> String) -> Result<(), Error> {
    // What the process holds already is part of what is needed.
    let held = status("VmRSS").unwrap_or(0);
    let fits = available().is_none_or(|available| needed <= (available + held) as f64);
    if fits { Ok(()) } else { Err(refuse(needed, parts())) }
}

/// How many of what takes `each` bytes there is memory for; `None` where the system does not tell.
pub(crate) fn how_many_fit(each: f64) -> Option<usize> {
    available().map(|bytes| (bytes as f64 / each.max(1.0)) as usize)
}

/// The error that there is less memory than `needed`, bytes.
pub(crate) fn refuse(needed: f64, parts: String) -> Error {
    let available = available().map_or("less".into(), |bytes| describe_bytes(bytes as f64));
    Error::Memory { needed: describe_bytes(needed), available, parts }
}

/// Memory that the process can still be given, bytes: of the machine, of its control group, of its limit on addresses,
/// whichever is least. `None` where the system does not tell.
fn available() -> Option<u64> {
    let memory = RefreshKind::nothing().with_memory(MemoryRefreshKind::everything());
    let system = System::new_with_specifics(memory);
    let machine = Some(system.available_memory()).filter(|bytes| *bytes > 0).map(|bytes| bytes + system.free_swap());
    // What a group keeps of files it gives back when asked, and is not counted.
    let group = system.cgroup_limits().map(|limits| limits.total_memory.saturating_sub(limits.rss));
    [machine, group, addresses()].into_iter().flatten().min()
}

/// What `ulimit -v` leaves.
#[cfg(target_os = "linux")]
fn addresses() -> Option<u64> {
    let limit = rlimit::Resource::AS.get_soft().ok().filter(|limit| *limit != rlimit::INFINITY)?;
    Some(limit.saturating_sub(status("VmSize")?))
}

#[cfg(not(target_os = "linux"))]
fn addresses() -> Option<u64> {
    None
}
