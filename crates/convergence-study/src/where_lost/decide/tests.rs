//! All mistakes of a model, one and two at a time, with all ways in which variants may hide them.

use super::*;

fn decide(examined: &[Examined]) -> Conclusion {
    Table::new(examined).conclusion()
}

/// A problem: which parts its file has.
struct Setting {
    coordinates: &'static [&'static str],
    faces: &'static [&'static str],
    has_time: bool,
    others: Vec<SolverPart>,
}

fn settings() -> Vec<Setting> {
    let setting = |coordinates, faces, has_time| Setting {
        coordinates,
        faces,
        has_time,
        others: vec![],
    };
    let with_others = |setting: Setting| Setting {
        others: vec![
            SolverPart::Parameter("p".to_owned()),
            SolverPart::Field("u".to_owned()),
        ],
        ..setting
    };
    const SQUARE: &[&str] = &["x_min", "x_max", "y_min", "y_max"];
    vec![
        with_others(setting(&["x", "y"], SQUARE, true)),
        setting(&["x", "y"], &SQUARE[..3], false),
        // Periodic along y.
        setting(&["x", "y"], &SQUARE[..2], true),
        with_others(setting(&["x"], &SQUARE[..2], true)),
        // At rest.
        with_others(setting(&["x"], &SQUARE[..2], false)),
        setting(&["x"], &[], true),
    ]
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

impl Setting {
    /// The variants of such a file.
    fn parts(&self) -> Vec<SolverPart> {
        let mut parts = self.inner();
        parts.extend(owned(self.faces).into_iter().map(SolverPart::Face));
        let mut with_faces = 0;
        for name in owned(self.coordinates) {
            let sides = self
                .faces
                .iter()
                .filter(|face| coordinate(face) == name)
                .count();
            with_faces += usize::from(sides > 0);
            if sides == 2 {
                parts.push(SolverPart::BothFaces(name));
            }
        }
        if with_faces > 1 {
            parts.push(SolverPart::AllFaces);
            parts.extend(owned(self.faces).into_iter().map(SolverPart::AllFacesBut));
        }
        if self.has_time {
            parts.push(SolverPart::Initial);
            if !self.faces.is_empty() {
                parts.push(SolverPart::AllFacesAndInitial);
            }
        }
        parts
    }

    /// The variants that switch off what acts inside the domain.
    fn inner(&self) -> Vec<SolverPart> {
        let mut inner: Vec<SolverPart> = owned(self.coordinates)
            .into_iter()
            .map(SolverPart::Coordinate)
            .collect();
        if self.has_time {
            inner.push(SolverPart::Time("t".to_owned()));
        }
        inner.extend(self.others.iter().cloned());
        inner
    }

    /// All single mistakes.
    fn mistakes(&self) -> Vec<Mistake> {
        let inner = self.inner();
        let subset = |bits: usize| -> Vec<SolverPart> {
            let parts = inner.iter().enumerate();
            let chosen = parts.filter(|(place, _)| bits >> place & 1 == 1);
            chosen.map(|(_, part)| part.clone()).collect()
        };
        let mut mistakes = vec![];
        for hidden_by in (0..1usize << inner.len()).map(subset) {
            let mut add = |faces: &[&str], is_initial: bool| {
                if self.has_time || !is_initial {
                    mistakes.push(Mistake::new(faces, is_initial, &hidden_by));
                }
            };
            add(&[], false);
            add(&[], true);
            for (place, face) in self.faces.iter().enumerate() {
                add(&[face], false);
                add(&[face], true);
                for other in &self.faces[place + 1..] {
                    if coordinate(face) != coordinate(other) {
                        add(&[face, other], false);
                    }
                }
            }
        }
        mistakes
    }
}

/// A mistake: seen only where the solution is not flat at each of some faces, and at the first
/// time; and where the solution changes in each part of `hidden_by`.
#[derive(Debug, Clone, PartialEq)]
struct Mistake {
    faces: Vec<String>,
    is_initial: bool,
    hidden_by: Vec<SolverPart>,
}

impl Mistake {
    fn new(faces: &[&str], is_initial: bool, hidden_by: &[SolverPart]) -> Self {
        Self {
            faces: owned(faces),
            is_initial,
            hidden_by: hidden_by.to_vec(),
        }
    }

    /// Faces and the first time.
    fn places(&self) -> usize {
        self.faces.len() + usize::from(self.is_initial)
    }

    fn is_hidden_in(&self, variant: &SolverPart) -> bool {
        let at = |is_flat: &dyn Fn(&str) -> bool| self.faces.iter().any(|face| is_flat(face));
        match variant {
            SolverPart::Face(name) => at(&|face| face == name),
            SolverPart::BothFaces(name) => at(&|face| coordinate(face) == name),
            SolverPart::AllFaces => at(&|_| true),
            SolverPart::AllFacesBut(name) => at(&|face| face != name),
            SolverPart::Initial => self.is_initial,
            SolverPart::AllFacesAndInitial => self.places() > 0,
            inner => self.hidden_by.contains(inner),
        }
    }

    /// Whether a part that is named is one of the mistake.
    fn has(&self, part: &SolverPart) -> bool {
        match part {
            SolverPart::Face(name) => self.faces.contains(name),
            SolverPart::Initial => self.is_initial,
            inner => self.hidden_by.contains(inner),
        }
    }
}

/// Back where this says so, lost elsewhere.
fn examined(parts: &[SolverPart], is_back: impl Fn(&SolverPart) -> bool) -> Vec<Examined> {
    let examined = |part: &SolverPart| Examined {
        part: part.clone(),
        fate: if is_back(part) {
            Fate::Back
        } else {
            Fate::Lost
        },
    };
    parts.iter().map(examined).collect()
}

fn fates(parts: &[SolverPart], mistakes: &[&Mistake]) -> Vec<Examined> {
    examined(parts, |part| {
        let mut mistakes = mistakes.iter();
        mistakes.all(|mistake| mistake.is_hidden_in(part))
    })
}

fn assert_true(conclusion: &Conclusion, mistakes: &[&Mistake]) {
    for part in conclusion.named() {
        let is_wrong = mistakes.iter().any(|mistake| mistake.has(&part));
        assert!(is_wrong, "{part:?} is named for {mistakes:?}");
    }
}

#[test]
fn one_mistake_is_named_if_no_other_part_hides_it_and_never_falsely() {
    let mut named = 0;
    for setting in settings() {
        let parts = setting.parts();
        for mistake in setting.mistakes() {
            let conclusion = decide(&fates(&parts, &[&mistake]));
            assert_true(&conclusion, &[&mistake]);
            let parts = conclusion.named();
            named += usize::from(!parts.is_empty());
            match (mistake.places(), mistake.hidden_by.len()) {
                (0, 0) => assert_eq!(conclusion, Conclusion::Everywhere),
                (0, 1) => assert_eq!(parts, mistake.hidden_by, "{conclusion:?}"),
                (1, _) => assert!(!parts.is_empty(), "{mistake:?}: {conclusion:?}"),
                _ => (),
            }
        }
    }
    assert!(named > 200, "{named}");
}

#[test]
fn of_two_mistakes_no_part_is_named_that_is_right() {
    let mut named = 0;
    for setting in settings() {
        let parts = setting.parts();
        let mistakes = setting.mistakes();
        for (place, one) in mistakes.iter().enumerate() {
            for other in &mistakes[place + 1..] {
                let conclusion = decide(&fates(&parts, &[one, other]));
                assert_true(&conclusion, &[one, other]);
                named += usize::from(!conclusion.named().is_empty());
            }
        }
    }
    assert!(named > 1000, "{named}");
}

/// Each fate in turn is replaced by what is no evidence.
#[test]
fn what_is_unknown_or_round_off_names_nothing_that_is_right() {
    for setting in settings() {
        let parts = setting.parts();
        let mistakes = setting.mistakes();
        let pairs = mistakes.iter().enumerate().step_by(3);
        for (place, one) in pairs {
            for other in mistakes[place..].iter().step_by(5) {
                let whole = fates(&parts, &[one, other]);
                for changed in 0..whole.len() {
                    for fate in [Fate::Unknown, Fate::RoundOff] {
                        let mut examined = whole.clone();
                        if fate == Fate::Unknown || examined[changed].fate == Fate::Back {
                            examined[changed].fate = fate;
                        }
                        assert_true(&decide(&examined), &[one, other]);
                    }
                }
            }
        }
    }
}

/// The name of the variant of a part.
fn name(part: &SolverPart) -> String {
    match part {
        SolverPart::Coordinate(name) | SolverPart::Time(name) | SolverPart::Field(name) => {
            format!("constant_{name}")
        }
        SolverPart::Face(name) | SolverPart::BothFaces(name) => format!("flat_{name}"),
        SolverPart::AllFaces => "flat_faces".to_owned(),
        SolverPart::AllFacesBut(name) => format!("flat_but_{name}"),
        SolverPart::Initial => "flat_initial".to_owned(),
        SolverPart::AllFacesAndInitial => "flat_everywhere".to_owned(),
        SolverPart::Parameter(name) => format!("zero_{name}"),
    }
}

/// The fates of a plane problem in time with these variants back, and all others lost.
fn back(names: &[&str]) -> Vec<Examined> {
    examined(&settings()[0].parts(), |part| names.contains(&&*name(part)))
}

fn with(mut examined: Vec<Examined>, variant: &str, fate: Fate) -> Vec<Examined> {
    let mut entries = examined.iter_mut();
    let entry = entries.find(|one| name(&one.part) == variant);
    entry.unwrap_or_else(|| panic!("no {variant}")).fate = fate;
    examined
}

/// The variants that are flat at x_max.
const AT_X_MAX: [&str; 7] = [
    "flat_x_max",
    "flat_x",
    "flat_faces",
    "flat_but_x_min",
    "flat_but_y_min",
    "flat_but_y_max",
    "flat_everywhere",
];

/// A conclusion, and the variants that are back.
struct Shown {
    conclusion: Conclusion,
    back: Vec<&'static str>,
}

fn faces(names: &[&str]) -> Vec<SolverPart> {
    owned(names).into_iter().map(SolverPart::Face).collect()
}

fn at_faces(names: &[&str]) -> Conclusion {
    Conclusion::Named(faces(names))
}

/// At these faces, in time.
fn in_time(names: &[&str]) -> Conclusion {
    let time = SolverPart::Time("t".to_owned());
    Conclusion::Named([faces(names), vec![time]].concat())
}

fn rows() -> Vec<Shown> {
    let at = |names: &[&str], back: &[&'static str]| Shown {
        conclusion: at_faces(names),
        back: back.to_vec(),
    };
    let inside = |parts: Vec<SolverPart>, back: &[&'static str]| Shown {
        conclusion: Conclusion::Named(parts),
        back: back.to_vec(),
    };
    let at_x_max = |more: &'static str| [AT_X_MAX.as_slice(), &[more]].concat();
    let y = SolverPart::Coordinate("y".to_owned());
    let t = SolverPart::Time("t".to_owned());
    let p = SolverPart::Parameter("p".to_owned());
    let pair = ["flat_faces", "flat_everywhere"];
    let with_pair = |more: &[&'static str]| [pair.as_slice(), more].concat();
    vec![
        at(&["x_max"], &AT_X_MAX),
        at(&["x_max"], &at_x_max("constant_x")),
        Shown {
            conclusion: in_time(&["x_max"]),
            back: at_x_max("constant_t"),
        },
        at(
            &["x_min", "x_max"],
            &with_pair(&["constant_x", "flat_x", "flat_but_y_min", "flat_but_y_max"]),
        ),
        at(
            &["x_max", "y_max"],
            &with_pair(&["flat_but_x_min", "flat_but_y_min"]),
        ),
        Shown {
            conclusion: Conclusion::Corner(faces(&["x_max", "y_max"])),
            back: [
                AT_X_MAX.as_slice(),
                &["flat_y_max", "flat_y", "flat_but_x_max"],
            ]
            .concat(),
        },
        // At the first time the solution is small where the faces meet.
        Shown {
            conclusion: Conclusion::Corner(faces(&["x_max", "y_max"])),
            back: [
                AT_X_MAX.as_slice(),
                &["flat_y_max", "flat_y", "flat_but_x_max", "flat_initial"],
            ]
            .concat(),
        },
        inside(vec![y.clone()], &["constant_y"]),
        inside(vec![t], &["constant_t"]),
        inside(vec![y, p], &["constant_y", "zero_p"]),
        Shown {
            conclusion: Conclusion::Named(vec![SolverPart::Initial]),
            back: vec!["flat_initial", "flat_everywhere"],
        },
        // All data at the old time.
        Shown {
            conclusion: in_time(&["x_min", "x_max", "y_min", "y_max"]),
            back: with_pair(&["constant_t"]),
        },
        Shown {
            conclusion: Conclusion::Everywhere,
            back: vec![],
        },
    ]
}

#[test]
fn each_part_has_its_variants() {
    for row in rows() {
        assert_eq!(decide(&back(&row.back)), row.conclusion);
    }
}

/// One variant that is mistaken takes names away; it gives none.
#[test]
fn a_variant_that_contradicts_others_names_nothing_else() {
    let mut silent = 0;
    for row in rows() {
        let named = row.conclusion.named();
        for examined in back(&row.back).iter().filter(|one| {
            let parts = parts_off(&one.part, &owned(settings()[0].faces));
            parts.iter().all(is_flat)
        }) {
            let opposite = match examined.fate {
                Fate::Back => Fate::Lost,
                _ => Fate::Back,
            };
            let variant = name(&examined.part);
            let found = decide(&with(back(&row.back), &variant, opposite)).named();
            silent += usize::from(found.is_empty());
            // Of several mistakes one more may be among those.
            if named.len() != 1 {
                continue;
            }
            assert!(
                found.iter().all(|part| named.contains(part)),
                "{variant}: {found:?} for {named:?}"
            );
        }
    }
    assert!(silent > 40, "{silent}");
}

#[test]
fn round_off_in_what_is_named_names_nothing() {
    for (row, variant) in [
        (0, "flat_x_max"),
        (5, "flat_y_max"),
        (7, "constant_y"),
        (10, "flat_initial"),
    ] {
        let examined = with(back(&rows()[row].back), variant, Fate::RoundOff);
        assert_eq!(decide(&examined), Conclusion::Several, "{variant}");
    }
    // It does not hide that another coordinate may be the place.
    let examined = with(back(&["constant_y"]), "constant_x", Fate::RoundOff);
    assert_eq!(decide(&examined), Conclusion::Several);
}

#[test]
fn a_contradiction_or_a_gap_names_nothing() {
    // Small at x_min, not absent: what is flat there and elsewhere is lost.
    assert_eq!(decide(&back(&["flat_x_min"])), Conclusion::Several);
    assert_eq!(
        decide(&back(&["constant_x", "constant_y"])),
        Conclusion::Several
    );
    // Faces and initial data at once, hidden together without y.
    assert_eq!(
        decide(&back(&["constant_y", "flat_everywhere"])),
        Conclusion::Several
    );
    let unknown = |back_in: &[&'static str], variant: &str| {
        decide(&with(back(back_in), variant, Fate::Unknown))
    };
    // What another variant implies is no gap.
    for variant in ["flat_y_min", "flat_faces", "flat_x", "flat_initial"] {
        assert_eq!(unknown(&AT_X_MAX, variant), at_faces(&["x_max"]));
    }
    let along_y = Conclusion::Named(vec![SolverPart::Coordinate("y".to_owned())]);
    for variant in ["flat_y", "flat_faces", "flat_x_max"] {
        assert_eq!(unknown(&["constant_y"], variant), along_y);
    }
    for conclusion in [
        unknown(&AT_X_MAX, "flat_x_max"),
        unknown(&["constant_y"], "flat_everywhere"),
        unknown(&["constant_y"], "constant_x"),
        // It may explain all that four faces explain together.
        unknown(&["flat_faces", "flat_everywhere"], "constant_t"),
    ] {
        assert!(matches!(conclusion, Conclusion::Open(_)), "{conclusion:?}");
    }
}

#[test]
fn a_face_is_named_only_if_a_wider_variant_confirms_it_and_no_other_face_is_open() {
    let unknown = |variants: &[&str]| {
        let all = variants.iter();
        decide(&all.fold(back(&AT_X_MAX), |examined, variant| {
            with(examined, variant, Fate::Unknown)
        }))
    };
    assert_eq!(unknown(&AT_X_MAX[2..]), at_faces(&["x_max"]));
    assert_eq!(unknown(&AT_X_MAX[1..]).named(), []);
    // It may be a corner.
    let conclusion = unknown(&["flat_y_min", "flat_y", "flat_but_x_max"]);
    assert_eq!(conclusion, Conclusion::Open(faces(&["y_min"])));
}

#[test]
fn at_rest_a_term_is_named_only_if_the_order_is_lost_where_both_faces_are_flat() {
    let parameter = SolverPart::Parameter("p".to_owned());
    let fates = |of_both| {
        let faces =
            ["x_min", "x_max"].map(|face| (SolverPart::Face(face.to_owned()), Fate::Unknown));
        let both = (SolverPart::BothFaces("x".to_owned()), of_both);
        let examined = faces
            .into_iter()
            .chain([both, (parameter.clone(), Fate::Back)]);
        let examined = examined.map(|(part, fate)| Examined { part, fate });
        decide(&examined.collect::<Vec<_>>())
    };
    assert_eq!(
        fates(Fate::Lost),
        Conclusion::Named(vec![parameter.clone()])
    );
    assert!(matches!(fates(Fate::Back), Conclusion::Open(_)));
}
