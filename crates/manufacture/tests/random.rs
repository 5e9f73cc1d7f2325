//! Files drawn at random, their emitted C, and slips in it: no right source is called wrong, and no
//! slip is missed.
//!
//! `MANUFACTURE_FILES=2000` draws more files, `MANUFACTURE_SEED=7` others.

use std::path::Path;
use std::process::Command;

use manufacture::{Language, Manufacture, Sampling};

use crate::files::read;

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// A number with two decimals, not zero.
    fn number(&mut self) -> f64 {
        (20 + self.below(180)) as f64 / 100.0
    }

    fn one_of<'t>(&mut self, texts: &[&'t str]) -> &'t str {
        texts[self.below(texts.len())]
    }

    /// A smooth function of the variables.
    fn function(&mut self, variables: &[&str]) -> String {
        let mut sum = format!("{}", self.number());
        for _ in 0..2 + self.below(2) {
            let [x, y] = [self.one_of(variables), self.one_of(variables)];
            let [a, b] = [self.number(), self.number()];
            let wave = self.one_of(&[
                "sin(A*X + B*Y)",
                "exp(-A*X)*cos(B*Y)",
                "tanh(A*X - B*Y)",
                "X^2*Y*A",
                "sqrt(1 + A*X^2)",
            ]);
            let wave = wave.replace('X', x).replace('Y', y);
            sum += &format!(
                " + {}*{}",
                self.number(),
                wave.replace('A', &a.to_string())
                    .replace('B', &b.to_string())
            );
        }
        sum
    }

    fn file(&mut self) -> String {
        let dimension = 1 + self.below(3);
        let coordinates = &["x", "y", "z"][..dimension];
        let has_time = self.below(2) == 0;
        let mut variables = coordinates.to_vec();
        let mut head = String::new();
        if has_time {
            variables.push("t");
            head += "time = \"t\"\n";
        }
        let domain: String = variables
            .iter()
            .map(|name| format!("{name} = [0.1, {}]\n", 1.0 + self.number()))
            .collect();
        let v: Vec<String> = coordinates
            .iter()
            .map(|_| format!("{:?}", self.function(&variables)))
            .collect();
        let mut scalar = vec![
            "-div(k*grad(T))",
            "dot(v, grad(T))",
            "a*T^3",
            "-b*exp(-T)",
            "laplacian(laplacian(T))",
            "T*div(v)",
        ];
        let mut vector = vec![
            "dot(grad(v), v)",
            "-div(2*k*sym(grad(v)))",
            "grad(T)",
            "-a*v",
            "-grad(div(v))",
            "T*dot(transpose(grad(v)), v)",
        ];
        if has_time {
            scalar.push("dt(T)");
            vector.push("dt(v)");
        }
        let terms = |random: &mut Self, mut all: Vec<&str>| {
            let mut text = String::new();
            for _ in 0..2 + random.below(3) {
                let term = all.remove(random.below(all.len()));
                let plus = if text.is_empty() || term.starts_with('-') {
                    ""
                } else {
                    " + "
                };
                text += &format!("{plus}{term}");
            }
            text
        };
        let [scalar, vector] = [terms(self, scalar), terms(self, vector)];
        format!(
            "[manufacture]\nname = \"random\"\ncoordinates = {coordinates:?}\n{head}[domain]\n{domain}[parameters]\na = {}\nb = {}\n\
             [exact]\nT = {:?}\nv = [{}]\n[define]\nk = \"{} + 0.3*T^2\"\n[equations]\nT = \"{scalar}\"\nv = \"{vector}\"\n\
             [boundary.x_max]\nrobin = \"-k*dot(grad(T), n) - b*T\"\n",
            self.number(),
            self.number(),
            self.function(&variables),
            v.join(", "),
            self.number()
        )
    }
}

/// Emitted C in a folder.
struct Built<'f> {
    folder: &'f Path,
    manufacture: Manufacture,
    library: String,
}

const POINTS: Sampling = Sampling {
    seed: 5,
    points: 40,
    is_strict: false,
};

impl Built<'_> {
    /// The causes of the quantities when the library has this text.
    fn causes(&self, library: &str, face: Option<&str>) -> Vec<(String, &'static str, f64)> {
        let path = |name: &str| self.folder.join(name).display().to_string();
        std::fs::write(path("random.c"), library).unwrap();
        let build = Command::new("cc")
            .args([
                "-O0",
                "-w",
                "-o",
                &path("answer"),
                &path("random.c"),
                &path("random_answer.c"),
                "-lm",
            ])
            .output();
        let build = build.unwrap();
        assert!(
            build.status.success(),
            "{}",
            String::from_utf8_lossy(&build.stderr)
        );
        let command = format!("'{}' {}", path("answer"), face.unwrap_or(""));
        // Values that are not finite are refused.
        let Ok(comparisons) = self.manufacture.against(&command, face, &POINTS) else {
            return vec![("refused".to_owned(), "refused", f64::NAN)];
        };
        comparisons
            .into_iter()
            .map(|c| (c.sentence, c.cause, c.difference))
            .collect()
    }

    /// The library with one slip in a source: of a sign, a function, a digit or an index. `None` if
    /// there is no room for it.
    fn slip(&self, random: &mut Random) -> Option<String> {
        let slips = [
            (" + ", " - "),
            (" - ", " + "),
            ("cos(", "sin("),
            ("sin(", "cos("),
            ("exp(", "cosh("),
            ("*", "/"),
            ("x[0]", "(1.1*x[0])"),
            (" 0.", " 1."),
            ("(0.", "(1."),
        ];
        let (old, new) = slips[random.below(slips.len())];
        let start = self.library.find("random_source_T")?;
        let end = start + self.library[start..].find("random_normal").unwrap_or(0);
        let places: Vec<usize> = self.library[start..end]
            .match_indices(old)
            .map(|found| start + found.0)
            .collect();
        // A pointer is no product.
        let places: Vec<usize> = places
            .into_iter()
            .filter(|place| !self.library[..*place].ends_with("double "))
            .collect();
        let place = *places.get(random.below(places.len().max(1)))?;
        Some(format!(
            "{}{new}{}",
            &self.library[..place],
            &self.library[place + old.len()..]
        ))
    }
}

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(default)
}

#[test]
fn no_right_source_is_called_wrong_and_no_slip_is_missed() {
    let folder = tempfile::tempdir().unwrap();
    let mut slips = 0;
    let mut named = std::collections::BTreeMap::new();
    let seed = setting("MANUFACTURE_SEED", 1);
    let files = setting("MANUFACTURE_FILES", 12);
    for number in 0..files {
        let mut random = Random(seed * 1_000_003 + number);
        let file = random.file();
        let manufacture = read(&file);
        let emitted = manufacture.emit(Language::C);
        for file in &emitted {
            std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
        }
        let built = Built {
            folder: folder.path(),
            manufacture,
            library: emitted[0].text.clone(),
        };
        for face in [None, Some("x_max")] {
            for (sentence, cause, _) in built.causes(&built.library, face) {
                assert_eq!(cause, "equal", "{sentence}\n{file}");
            }
        }
        let Some(library) = built.slip(&mut random) else {
            continue;
        };
        let causes = built.causes(&library, None);
        let wrong: Vec<_> = causes.iter().filter(|cause| cause.1 != "equal").collect();
        assert!(!wrong.is_empty(), "a slip is missed:\n{library}\n{file}");
        slips += 1;
        for (_, cause, difference) in wrong {
            assert!(*difference > 0.0 || *cause == "refused");
            *named.entry(*cause).or_insert(0) += 1;
        }
    }
    assert!(slips * 2 > files, "{slips} slips in {files} files");
    println!("{files} files, {slips} slips: {named:?}");
}
