//! What the harness and a guard tell each other through their socket: objects of JSON, one a line.

use std::ffi::OsString;
use std::io::{self, BufRead, Write};
use std::os::unix::net::UnixStream;
use std::process::Command;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::IS_GUARD;

/// What the guard is to start.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct StartRequest {
    program: OsString,
    arguments: Vec<OsString>,
    directory: Option<OsString>,
    /// Variables of its environment beside those of the harness.
    variables: Vec<EnvironmentVariable>,
    /// Its standard input; may be empty.
    pub(super) input: String,
}

#[derive(Debug, Serialize, Deserialize)]
struct EnvironmentVariable {
    name: OsString,
    value: OsString,
}

/// What the guard answers: whether the program has started, then how it has ended.
#[derive(Debug, Serialize, Deserialize)]
pub(super) enum Reply {
    /// It leads the process group of this number.
    Started { group: i32 },
    /// The error in words.
    NotStarted { error: String },
    /// The status as the operating system has it.
    Ended { status: i32 },
}

impl StartRequest {
    pub(super) fn new(command: &Command, input: String) -> Self {
        let variables = command.get_envs().filter_map(|(name, value)| {
            Some(EnvironmentVariable {
                name: name.to_owned(),
                value: value?.to_owned(),
            })
        });
        Self {
            program: command.get_program().to_owned(),
            arguments: command.get_args().map(ToOwned::to_owned).collect(),
            directory: command.get_current_dir().map(Into::into),
            variables: variables.collect(),
            input,
        }
    }

    /// The program, which may be a harness with guards of its own.
    pub(super) fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).env_remove(IS_GUARD);
        for EnvironmentVariable { name, value } in &self.variables {
            command.env(name, value);
        }
        if let Some(directory) = &self.directory {
            command.current_dir(directory);
        }
        command
    }
}

/// Sends a message.
///
/// # Errors
/// The other side has ended.
pub(super) fn send(mut socket: &UnixStream, message: &impl Serialize) -> io::Result<()> {
    let mut line = serde_json::to_vec(message)?;
    line.push(b'\n');
    socket.write_all(&line)
}

/// The next message; `None` if the other side has closed the socket.
///
/// # Errors
/// It cannot be read, the time limit of the socket is over, or it is no such message.
pub(super) fn receive<T: DeserializeOwned>(socket: &mut impl BufRead) -> io::Result<Option<T>> {
    let mut line = vec![];
    socket.read_until(b'\n', &mut line)?;
    if line.is_empty() {
        return Ok(None);
    }
    Ok(Some(serde_json::from_slice(&line)?))
}
