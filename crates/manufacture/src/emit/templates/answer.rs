use std::io::{self, BufRead};

#[path = "@NAME@.rs"]
mod library;

fn main() {
    let face = std::env::args().nth(1).unwrap_or_default();
@SETTINGS@    let mut lines = io::stdin().lock().lines();
    lines.next();
    match face.as_str() {
@NAMES@        _ => std::process::exit(2),
    }
    for line in lines {
        let line = line.expect("a line of text");
        let words = line.split_whitespace();
        let p: Vec<f64> = words.map(|word| word.parse().expect("a number")).collect();
        let mut x = [0.0; @D@];
        x.copy_from_slice(&p[..@D@]);
        let mut out: Vec<f64> = vec![];
        match face.as_str() {
@CALLS@            _ => (),
        }
        let words: Vec<String> = out.iter().map(|value| format!("{value:?}")).collect();
        println!("{}", words.join(" "));
    }
}
