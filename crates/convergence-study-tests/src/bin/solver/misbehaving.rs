//! A second-order solver that can misbehave in many ways.

use std::io::{self, Read, Write};
use std::process::{Command, Stdio, exit};
use std::thread::sleep;
use std::time::Duration;

use nix::sys::signal::{SigSet, Signal};

/// `solver TOKEN MODE N [DT]`; the token marks the processes of one test. Only the case n = 16
/// misbehaves.
pub(crate) fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [token, mode, n, rest @ ..] = &arguments[..] else {
        exit(64)
    };
    if let Some(answer) = of_seed(mode, n, rest) {
        println!("{answer}");
        exit(0)
    }
    let n: u32 = if mode == "stdin" {
        number_from_stdin()
    } else {
        n.parse().unwrap_or(0)
    };
    if n == 16 {
        misbehave(token, mode, n);
    }
    if let [dt] = rest {
        // Second order in space, first in time; they have the same shape.
        let error = f64::from(n).powi(-2) + 0.1 * dt.parse::<f64>().unwrap();
        println!(r#"{{"errors": {{"L2": {error:e}}}}}"#);
        exit(0)
    }
    println!("iteration 1 {{residual}} [1]");
    if mode == "late" {
        // Second order, but only on fine levels; L1 shows it at once.
        let h = f64::from(n).recip();
        println!(
            r#"{{"errors": {{"L2": {:e}, "L1": {:e}}}}}"#,
            h * h * (1.0 + 4.0 * h),
            h * h
        );
        exit(0)
    }
    if mode == "cells" {
        // n is the number of cells of a square: the step is the edge of a cell, which is not 1/n.
        println!(
            r#"{{"errors": {{"L2": {:e}}}, "h": {:e}}}"#,
            f64::from(n).recip(),
            f64::from(n).sqrt().recip()
        );
        exit(0)
    }
    if mode == "degrees" {
        println!(
            r#"{{"errors": {{"L2": {:e}}}}}"#,
            3.0 * 5.0_f64.powf(-f64::from(n))
        );
        exit(0)
    }
    if mode == "twice" {
        println!(
            r#"{{"errors": {{"L2": {:e}, "L2": 1e-3}}}}"#,
            f64::from(n).powi(-2)
        );
        exit(0)
    }
    println!("{}", answer(n));
}

/// What the programs answer that draw at random by a seed.
fn of_seed(mode: &str, number: &str, rest: &[String]) -> Option<String> {
    let seed = rest.first().map_or("1", String::as_str);
    if let Some(mode) = mode.strip_prefix("taylor-") {
        let [step, seed] = [number, seed].map(|word| word.parse().unwrap());
        return Some(super::differentiable::answer(mode, step, seed));
    }
    let mode = mode.strip_prefix("random-")?;
    let (n, seed) = (number.parse().unwrap(), seed.parse().unwrap());
    Some(super::random::answer(mode, n, seed))
}

fn answer(n: u32) -> String {
    let h = 1.0 / f64::from(n);
    let flux = 3.0 + 0.7 * h * h;
    format!(
        r#"{{"errors": {{"L2": {:e}, "H1": {:e}}}, "values": {{"flux": {flux:?}}}, "work": {}}}"#,
        h * h,
        3.0 * h,
        n * n
    )
}

/// The whole of standard input must be one object.
fn number_from_stdin() -> u32 {
    let mut text = String::new();
    io::stdin().read_to_string(&mut text).unwrap();
    let case: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        case["h"].as_f64(),
        case["n"].as_f64().map(f64::recip),
        "{text}"
    );
    case["n"].as_u64().unwrap() as u32
}

/// Standard streams are inherited from this process, so that their reader waits for both.
fn start(token: &str, mode: &str) -> Command {
    let mut child = Command::new(std::env::current_exe().unwrap());
    child.args([token, mode, "16"]).stdin(Stdio::null());
    child
}

/// What the program prints in these modes, in which it ends with status 0.
fn wrong_answer(mode: &str, n: u32) -> Option<String> {
    let is_complete = || std::path::Path::new("all").exists();
    Some(match mode {
        "nan" => r#"{"errors": {"L2": NaN, "H1": 1.0}}"#.to_owned(),
        "half" => format!(
            r#"{{"errors": {{"L2": NaN, "H1": {}}}, "values": {{"flux": 3.1}}}}"#,
            3.0 / 16.0
        ),
        "cut" => answer(64) + "\n" + r#"{"errors": {"L2": 1e5, "H1": 1.0 }"#,
        "own-step" => answer(n).replace("{\"errors\"", "{\"h\": 0.06, \"errors\""),
        "missing" => r#"{"errors": {"H1": 1.0}}"#.to_owned(),
        "optional" if is_complete() => {
            answer(n).replace("\"values\": {", "\"values\": {\"lift\": 2.0, ")
        }
        "lacking" => format!(r#"{{"errors": {{"L2": {:e}, "max": 1.0}}}}"#, 1.0 / 256.0),
        _ => return None,
    })
}

fn hang() -> ! {
    loop {
        sleep(Duration::from_secs(1));
    }
}

fn misbehave(token: &str, mode: &str, n: u32) {
    use std::os::unix::process::CommandExt;
    if let Some(text) = wrong_answer(mode, n) {
        println!("{text}");
        exit(0)
    }
    match mode {
        "hang" => hang(),
        "ignore-term" => {
            let mut signals = SigSet::empty();
            signals.add(Signal::SIGTERM);
            signals.thread_block().unwrap();
            hang()
        }
        "abort" => std::process::abort(),
        "silent" => exit(0),
        "status" => {
            eprintln!("reading the mesh\n\n\x1b[31mno such file: mesh.msh\x1b[0m");
            exit(3)
        }
        "garbage" => {
            println!("\u{7}fin\n\n");
            io::stdout().write_all(&[0xff, 0xfe, b'\n']).unwrap();
            exit(0)
        }
        // Each leaves a child that keeps standard output open and would hang for ever.
        "fork" => drop(start(token, "hang").spawn().unwrap()),
        "leave" => drop(
            start(token, "ignore-term")
                .process_group(0)
                .spawn()
                .unwrap(),
        ),
        // Its child has another session, no parent of the case and no environment.
        "daemon" => daemon(token),
        "daemon-hang" => {
            daemon(token);
            hang()
        }
        // The guard is its parent.
        "kill-guard" => {
            drop(start(token, "hang").spawn().unwrap());
            let guard = nix::unistd::Pid::from_raw(std::os::unix::process::parent_id() as i32);
            nix::sys::signal::kill(guard, Signal::SIGKILL).unwrap();
            hang()
        }
        "flood" => flood(),
        "read" => {
            let mut text = String::new();
            assert_eq!(
                io::stdin().read_to_string(&mut text).unwrap(),
                0,
                "standard input is not at its end"
            );
        }
        _ => {}
    }
}

/// Starts a process that has cut every tie but its descent; waits until it is there.
fn daemon(token: &str) {
    let script = r#"(setsid env -i sh -c 'echo > started; sleep 318; : "$1"' sh "$1" &)"#;
    let status = Command::new("sh")
        .args(["-c", script, "sh", token])
        .status();
    assert!(status.unwrap().success());
    while !std::path::Path::new("started").exists() {
        sleep(Duration::from_millis(1));
    }
}

/// 100 MB in lines, and 100 MB without a line end.
fn flood() {
    let mut out = io::stdout().lock();
    let line = "x".repeat(999) + "\n";
    (0..100_000).for_each(|_| out.write_all(line.as_bytes()).unwrap());
    let block = [b'{'; 1 << 20];
    (0..100).for_each(|_| out.write_all(&block).unwrap());
    out.write_all(b"\n").unwrap();
}
