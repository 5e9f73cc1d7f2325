//! The processes of a case on Windows: a job object.
//!
//! Whatever a process of the job starts is in the job as well. Windows ends all of them when the
//! last handle of the job is closed: by [`ProcessGroup::end`], or when this process ends, however
//! it ends. What a program starts in the instant between its own start and its entry into the job
//! stays outside.

use std::io;
use std::os::windows::io::AsRawHandle;
use std::process::{Child, Command};

use win32job::{ExtendedLimitInfo, Job};

/// The job of one case.
#[derive(Debug)]
pub(in crate::program) struct ProcessGroup {
    /// Empty once the case has ended.
    job: Option<Job>,
}

impl ProcessGroup {
    /// A job whose processes end with its last handle.
    pub(in crate::program) fn new() -> io::Result<Self> {
        let mut limits = ExtendedLimitInfo::new();
        limits.limit_kill_on_job_close();
        let job = Job::create_with_limit_info(&limits).map_err(io::Error::other)?;
        Ok(Self { job: Some(job) })
    }

    /// Starts the program in the job.
    pub(in crate::program) fn start(&mut self, command: &mut Command) -> io::Result<Child> {
        let mut child = command.spawn()?;
        let Some(job) = &self.job else {
            return Ok(child);
        };
        let entered = job.assign_process(child.as_raw_handle() as isize);
        // A program that has already ended cannot enter.
        if let Err(error) = entered
            && child.try_wait()?.is_none()
        {
            let _ = child.kill();
            let _ = child.wait();
            return Err(io::Error::other(error));
        }
        Ok(child)
    }

    /// Ends the program: Windows has no request that every program understands.
    pub(in crate::program) fn ask_to_end(&self, program: &mut Child) {
        let _ = program.kill();
    }

    /// Ends all processes of the job.
    pub(in crate::program) fn end(&mut self, program: &mut Child) {
        self.job = None;
        let _ = program.kill();
    }
}
