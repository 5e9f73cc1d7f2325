//! Files drawn at random, their emitted C, and slips in it: no right source is called wrong, no
//! slip is missed, and no cause is named that does not hold at other points, too.
//!
//! `MANUFACTURE_FILES=2000` draws more files, `MANUFACTURE_SEED=7` others.

use convergence_judge::random::SplitMix;
use std::collections::BTreeMap;
use std::ops::Range;

use crate::prelude::*;

pub(crate) struct Random(SplitMix);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(SplitMix::new(seed))
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.0.next_u64() % count as u64) as usize
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

    pub(crate) fn file(&mut self) -> String {
        let dimension = 1 + self.below(3);
        let coordinates = &["x", "y", "z"][..dimension];
        let has_time = self.below(2) == 0;
        let mut variables = coordinates.to_vec();
        let mut head = String::new();
        let is_curved = self.below(3) == 0;
        match dimension {
            2 if is_curved => head += "system = \"polar\"\n",
            3 if is_curved => head += "system = \"cylindrical\"\n",
            _ => (),
        }
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

/// Kinds of slips, texts of C, and what a slip makes of them.
const SLIPS: &str = include_str!("slips.json");

/// A program with one slip.
struct Slip {
    kind: String,
    library: String,
}

/// Emitted C in a folder.
struct Built<'f> {
    folder: &'f Path,
    manufacture: Manufacture,
    library: String,
}

pub(crate) const POINTS: Sampling = Sampling {
    seed: 5,
    points: 40,
    is_strict: false,
};

/// Other points, at which a cause must hold as well.
pub(crate) const OTHER_POINTS: Sampling = Sampling { seed: 6, ..POINTS };

impl Built<'_> {
    fn path(&self, name: &str) -> String {
        self.folder.join(name).display().to_string()
    }

    /// Builds a program from this library and the answering program.
    fn build(&self, library: &str) -> String {
        std::fs::write(self.path("slipped.c"), library).unwrap();
        let built = run(
            "cc -O0 -w -o slipped slipped.c random_answer.c -lm",
            self.folder,
            "",
        );
        assert!(built.status.success(), "{built:?}");
        self.path("slipped")
    }

    /// What is said of a program; `None` if its values are not finite.
    fn compare(
        &self,
        program: &str,
        face: Option<&str>,
        sampling: &Sampling,
    ) -> Option<Vec<Comparison>> {
        let mut command = Command::new(program);
        answered(&self.manufacture, command.args(face), face, sampling).ok()
    }

    /// The library with one slip in a source; `None` if there is no room for it.
    fn slip(&self, random: &mut Random) -> Option<Slip> {
        let start = self.library.find("random_source_T")?;
        // Behind the sources one by one stand all in one function, which is not compared here.
        let end = start + self.library[start..].find("random_sources").unwrap_or(0);
        let sources = &self.library[start..end];
        let is_plane = sources.contains("x[1]");
        let mut slips = vec![];
        for [kind, text, replacement] in serde_json::from_str::<Vec<[String; 3]>>(SLIPS).unwrap() {
            let mut places = places(sources, &text, start);
            // A pointer is no product.
            places.retain(|place| !self.library[..*place].ends_with("double "));
            if !places.is_empty() && (kind != "index" || is_plane) {
                slips.push((kind, text, replacement, places));
            }
        }
        // First the kind, so that rare kinds are drawn as often as common ones.
        let mut kinds: Vec<String> = slips.iter().map(|slip| slip.0.clone()).collect();
        kinds.dedup();
        let chosen = kinds.get(random.below(kinds.len().max(1)))?;
        slips.retain(|slip| slip.0 == *chosen);
        let (kind, text, replacement, places) = &slips[random.below(slips.len())];
        let place = places[random.below(places.len())];
        Some(Slip {
            kind: kind.clone(),
            library: replaced(&self.library, place..place + text.len(), replacement),
        })
    }
}

/// Where a text is in another, which begins at `start`.
pub(crate) fn places(text: &str, part: &str, start: usize) -> Vec<usize> {
    let found = text.match_indices(part);
    found.map(|(place, _)| start + place).collect()
}

/// A text with other words in the place of these.
pub(crate) fn replaced(text: &str, place: Range<usize>, new: &str) -> String {
    let mut text = text.to_owned();
    text.replace_range(place, new);
    text
}

/// What became of the slips of a kind.
#[derive(Debug, Default)]
struct Count {
    slips: usize,
    /// Slips with values that are not finite.
    refused: usize,
    /// Components by cause.
    causes: BTreeMap<&'static str, usize>,
}

/// Whether two comparisons name the same cause with the same numbers.
fn is_same_cause(first: &Comparison, second: &Comparison) -> bool {
    let mut factors = first.factors.iter().zip(&second.factors);
    first.cause == second.cause
        && first.terms == second.terms
        && factors.all(|(a, b)| (a - b).abs() <= 1e-6 * a.abs().max(1.0))
}

pub(crate) fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(default)
}

/// A comparison allows 1000 spreads of the two evaluations, `emitted` a share of the size.
#[test]
fn no_right_source_is_called_wrong_and_no_slip_is_missed() {
    foreign_tools::needs!(C);
    let folder = tempfile::tempdir().unwrap();
    let mut counts: BTreeMap<String, Count> = BTreeMap::new();
    let seed = setting("MANUFACTURE_SEED", 1);
    let files = setting("MANUFACTURE_FILES", 12);
    for number in 0..files {
        let mut random = Random::new(seed * 1_000_003 + number);
        let file = random.file();
        let manufacture = read(&file);
        let findings = manufacture.check_emitted(Language::C, folder.path(), &POINTS);
        assert_eq!(findings.unwrap(), [], "{file}");
        let library = manufacture.emit(Language::C).swap_remove(0).text;
        let built = Built {
            folder: folder.path(),
            manufacture,
            library,
        };
        let program = built.path("random_answer_c");
        for face in [None, Some("x_max")] {
            for comparison in built.compare(&program, face, &POINTS).unwrap() {
                assert_eq!(comparison.cause, "equal", "{comparison:?}\n{file}");
            }
        }
        if let Some(slip) = built.slip(&mut random) {
            let count = counts.entry(slip.kind.clone()).or_default();
            count.slips += 1;
            named(&built, &slip, count, &file);
        }
    }
    let slips: usize = counts.values().map(|count| count.slips).sum();
    assert!(slips as u64 * 2 > files, "{slips} slips in {files} files");
    println!("{files} files, {slips} slips, all found: {counts:#?}");
}

/// Counts the causes of a slip, each of which must hold at other points.
fn named(built: &Built<'_>, slip: &Slip, count: &mut Count, file: &str) {
    let program = built.build(&slip.library);
    let [here, elsewhere] = [POINTS, OTHER_POINTS].map(|s| built.compare(&program, None, &s));
    let (Some(here), Some(elsewhere)) = (here, elsewhere) else {
        count.refused += 1;
        return;
    };
    let mut is_found = false;
    for (first, second) in here.iter().zip(&elsewhere) {
        if first.cause == "equal" && second.cause == "equal" {
            continue;
        }
        is_found = true;
        *count.causes.entry(first.cause).or_insert(0) += 1;
        assert!(
            is_same_cause(first, second),
            "{first:?}\n{second:?}\n{}\n{file}",
            slip.library
        );
    }
    assert!(is_found, "a slip is missed:\n{}\n{file}", slip.library);
}
