//! What Linux says about memory: free memory, the limits of the control groups around the process,
//! its address space. Floor 5. Other systems without these files tell nothing.

use std::fs;
use std::path::{Path, PathBuf};

/// The least that any account of the system leaves.
pub fn available_bytes() -> Option<u64> {
    least_available(Path::new("/"))
}

/// All memory, or the lowest limit around the process.
pub fn whole_bytes() -> Option<u64> {
    whole(Path::new("/"))
}

/// The process's resident set.
pub fn resident_bytes() -> Option<u64> {
    resident(&fs::read_to_string("/proc/self/status").ok()?)
}

/// The resident set in a status file.
fn resident(status: &str) -> Option<u64> {
    field(status, "VmRSS:")?.checked_mul(1024)
}

fn whole(root: &Path) -> Option<u64> {
    let read = |name: &str| fs::read_to_string(root.join(name)).ok();
    let memory = field(&read("proc/meminfo")?, "MemTotal:")? * 1024;
    let groups = read("proc/self/cgroup").unwrap_or_default();
    let limit = |group: &ControlGroup| {
        fs::read_to_string(group.folder.join(group.names[0])).ok()?.trim().parse().ok()
    };
    Some(groups_around(root, &groups).iter().filter_map(limit).fold(memory, u64::min))
}

/// The least of what each of Linux's accounts leaves; `None` on other systems. `root`: where its
/// folders hang.
fn least_available(root: &Path) -> Option<u64> {
    let read = |name: &str| fs::read_to_string(root.join(name)).ok();
    let free = field(&read("proc/meminfo")?, "MemAvailable:")? * 1024;
    let groups = read("proc/self/cgroup").unwrap_or_default();
    let left = [remaining_in_groups(root, &groups), remaining_addresses(&read)];
    Some(left.into_iter().flatten().fold(free, u64::min))
}

/// The number behind a name at the start of a line.
fn field(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse().ok()
}

/// A control group that reports memory.
struct ControlGroup {
    folder: PathBuf,
    /// The files of its limit and of what is used.
    names: [&'static str; 2],
    /// The line of `memory.stat` for files held in memory.
    cache: &'static str,
}

/// What is left under the limits of the process's groups, and of all groups around them.
fn remaining_in_groups(root: &Path, groups: &str) -> Option<u64> {
    groups_around(root, groups).iter().filter_map(remaining_in_group).min()
}

/// The process's groups, of version 2 and 1, and all groups around them.
fn groups_around(root: &Path, groups: &str) -> Vec<ControlGroup> {
    let line = |is: &dyn Fn(&str) -> bool| {
        groups.lines().find_map(|line| {
            let (controllers, path) = line.split_once(':')?.1.split_once(':')?;
            is(controllers).then(|| path.trim_start_matches('/').to_owned())
        })
    };
    let second = line(&|controllers| controllers.is_empty());
    let first = line(&|controllers| controllers.split(',').any(|c| c == "memory"));
    let second = second
        .map(|path| ("sys/fs/cgroup", path, ["memory.max", "memory.current"], "inactive_file"));
    let first = first.map(|path| {
        (
            "sys/fs/cgroup/memory",
            path,
            ["memory.limit_in_bytes", "memory.usage_in_bytes"],
            "total_inactive_file",
        )
    });
    let all = second.into_iter().chain(first).flat_map(|(mount, path, names, cache)| {
        let top = root.join(mount);
        let inner = top.join(path);
        // Within a container the path may be one of the world outside; its own group is then the
        // top.
        let around =
            inner.ancestors().take_while(|folder| folder.starts_with(&top)).map(Path::to_owned);
        around.map(|folder| ControlGroup { folder, names, cache }).collect::<Vec<_>>()
    });
    all.collect()
}

/// What is left in one group; files that it holds in memory count as free, since the system drops
/// them when needed.
fn remaining_in_group(group: &ControlGroup) -> Option<u64> {
    let ControlGroup { folder, names: [limit, used], cache } = group;
    let read = |name: &str| fs::read_to_string(folder.join(name)).ok();
    let number = |name: &str| read(name)?.trim().parse::<u64>().ok();
    let cache =
        read("memory.stat").and_then(|stat| field(&stat, &format!("{cache} "))).unwrap_or(0);
    Some(number(limit)?.saturating_sub(number(used)?.saturating_sub(cache)))
}

/// What is left of the process's address space (`ulimit -v`).
fn remaining_addresses(read: &impl Fn(&str) -> Option<String>) -> Option<u64> {
    let limit = field(&read("proc/self/limits")?, "Max address space")?;
    Some(limit.saturating_sub(field(&read("proc/self/status")?, "VmSize:")? * 1024))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A machine of 8 GB, 6 of them free, with more files of the system.
    fn machine(files: &[(&str, &str)]) -> Option<u64> {
        let root = tempfile::tempdir().unwrap();
        let meminfo = (
            "proc/meminfo",
            "MemTotal:  8000000 kB\nMemFree:  1000000 kB\nMemAvailable:  6000000 kB\n",
        );
        for (name, text) in files.iter().chain([&meminfo]) {
            let file = root.path().join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, text).unwrap();
        }
        least_available(root.path())
    }

    #[test]
    fn the_least_of_all_limits_counts() {
        assert_eq!(machine(&[]), Some(6_144_000_000));
        let unlimited =
            "Max address space         unlimited            unlimited            bytes\n";
        let limited = "Max address space         2000000000           unlimited            bytes\n";
        let status = ("proc/self/status", "VmSize:\t  500000 kB\n");
        assert_eq!(machine(&[("proc/self/limits", unlimited), status]), Some(6_144_000_000));
        assert_eq!(machine(&[("proc/self/limits", limited), status]), Some(1_488_000_000));
    }

    #[test]
    fn groups_count_with_all_around_them_and_their_cached_files_are_free() {
        let groups = ("proc/self/cgroup", "0::/user/app\n");
        let open = ("sys/fs/cgroup/user/app/memory.max", "max\n");
        let limit = ("sys/fs/cgroup/user/memory.max", "1000000000\n");
        let used = ("sys/fs/cgroup/user/memory.current", "700000000\n");
        let stat = ("sys/fs/cgroup/user/memory.stat", "anon 1\ninactive_file 200000000\n");
        assert_eq!(machine(&[groups, open, limit, used, stat]), Some(500_000_000));
        let old = [
            ("proc/self/cgroup", "3:cpu:/a\n2:memory:/elsewhere\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "900000000"),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "400000000"),
        ];
        assert_eq!(machine(&old), Some(500_000_000));
    }

    #[test]
    fn the_machine_is_as_large_as_its_lowest_limit() {
        let root = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            let file = root.path().join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, text).unwrap();
        };
        write("proc/meminfo", "MemTotal:  8000000 kB\nMemAvailable:  6000000 kB\n");
        assert_eq!(whole(root.path()), Some(8_192_000_000));
        write("proc/self/cgroup", "0::/user/app\n");
        write("sys/fs/cgroup/user/app/memory.max", "max\n");
        write("sys/fs/cgroup/user/memory.max", "1000000000\n");
        assert_eq!(whole(root.path()), Some(1_000_000_000));
    }

    #[test]
    fn the_resident_set_is_read_in_bytes() {
        assert_eq!(resident("Name:\tx\nVmRSS:\t    2048 kB\n"), Some(2 << 20));
        assert_eq!(resident("VmRSS: many kB"), None);
    }

    #[test]
    fn a_system_without_these_files_tells_nothing() {
        assert_eq!(least_available(Path::new("no such folder")), None);
        assert_eq!(whole(Path::new("no such folder")), None);
    }
}
