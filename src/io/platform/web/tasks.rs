//! Threads: workers of the page that wait for work. Floor 5.
//!
//! A worker can only be started by the page, which takes a while; one that has ended its work waits
//! for more.

use super::host;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};

/// The work of one thread.
type Task = Box<dyn FnOnce() + Send>;

#[derive(Default)]
struct Tasks {
    waiting: VecDeque<Task>,
    /// Workers that wait for work, and those that were asked for and come.
    idle: usize,
}

static TASKS: Mutex<Tasks> = Mutex::new(Tasks { waiting: VecDeque::new(), idle: 0 });
static WAKE: Condvar = Condvar::new();
/// Threads that paint, as the page said.
static THREADS: AtomicUsize = AtomicUsize::new(1);

/// The page has so many processors.
pub fn set_thread_count(count: usize) {
    THREADS.store(count.max(1), Ordering::Relaxed);
}

/// How many threads can work at once.
pub fn thread_count() -> usize {
    THREADS.load(Ordering::Relaxed)
}

/// Gives work to a worker that waits, or to a new one.
pub fn run(task: Task) {
    let mut tasks = TASKS.lock().unwrap_or_else(PoisonError::into_inner);
    tasks.waiting.push_back(task);
    if tasks.idle < tasks.waiting.len() {
        tasks.idle += 1;
        host::start_thread();
    }
    WAKE.notify_one();
}

/// What a worker does, once it was started by [`spawn`](super::spawn): the work that comes, without
/// an end.
pub fn run_tasks() -> ! {
    loop {
        let mut tasks = TASKS.lock().unwrap_or_else(PoisonError::into_inner);
        let task = loop {
            if let Some(task) = tasks.waiting.pop_front() {
                break task;
            }
            tasks = WAKE.wait(tasks).unwrap_or_else(PoisonError::into_inner);
        };
        tasks.idle = tasks.idle.saturating_sub(1);
        drop(tasks);
        task();
        TASKS.lock().unwrap_or_else(PoisonError::into_inner).idle += 1;
    }
}
