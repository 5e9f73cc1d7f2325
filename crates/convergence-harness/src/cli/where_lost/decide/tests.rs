//! All mistakes of a model, one and two at a time, with all ways in which variants may hide them.

use super::*;

/// A problem: which parts its file has.
struct Setting {
    coordinates: &'static [&'static str],
    faces: &'static [&'static str],
    has_time: bool,
    others: Vec<Switch>,
}

fn settings() -> Vec<Setting> {
    let others = || {
        vec![
            Switch::Parameter("p".to_owned()),
            Switch::Field("u".to_owned()),
        ]
    };
    vec![
        Setting {
            coordinates: &["x", "y"],
            faces: &["x_min", "x_max", "y_min", "y_max"],
            has_time: true,
            others: others(),
        },
        Setting {
            coordinates: &["x", "y"],
            faces: &["x_min", "x_max", "y_min"],
            has_time: false,
            others: vec![],
        },
        // Periodic along y.
        Setting {
            coordinates: &["x", "y"],
            faces: &["x_min", "x_max"],
            has_time: true,
            others: vec![],
        },
        Setting {
            coordinates: &["x"],
            faces: &["x_min", "x_max"],
            has_time: true,
            others: others(),
        },
        Setting {
            coordinates: &["x"],
            faces: &[],
            has_time: true,
            others: vec![],
        },
    ]
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

impl Setting {
    /// The variants of such a file.
    fn switches(&self) -> Vec<Switch> {
        let mut switches = self.inner();
        switches.extend(owned(self.faces).into_iter().map(Switch::Face));
        let mut with_faces = 0;
        for name in owned(self.coordinates) {
            let sides = self
                .faces
                .iter()
                .filter(|face| is_side(face, &name))
                .count();
            with_faces += usize::from(sides > 0);
            if sides == 2 {
                switches.push(Switch::BothFaces(name));
            }
        }
        if with_faces > 1 {
            switches.push(Switch::AllFaces);
            switches.extend(owned(self.faces).into_iter().map(Switch::AllFacesBut));
        }
        if self.has_time {
            switches.push(Switch::Initial);
            if !self.faces.is_empty() {
                switches.push(Switch::AllFacesAndInitial);
            }
        }
        switches
    }

    /// The variants that switch off what acts inside the domain.
    fn inner(&self) -> Vec<Switch> {
        let mut inner: Vec<Switch> = owned(self.coordinates)
            .into_iter()
            .map(Switch::Coordinate)
            .collect();
        if self.has_time {
            inner.push(Switch::Time("t".to_owned()));
        }
        inner.extend(self.others.iter().cloned());
        inner
    }

    /// All single mistakes.
    fn mistakes(&self) -> Vec<Mistake> {
        let inner = self.inner();
        let subsets = |parts: &[Switch]| -> Vec<Vec<Switch>> {
            let count = 1usize << parts.len();
            let subset = |bits: usize| {
                let chosen = parts
                    .iter()
                    .enumerate()
                    .filter(|(place, _)| bits >> place & 1 == 1);
                chosen.map(|(_, part)| part.clone()).collect()
            };
            (0..count).map(subset).collect()
        };
        let mut mistakes = vec![];
        for hidden_by in subsets(&inner) {
            mistakes.push(Mistake::new(&[], false, &hidden_by, true));
            for (place, face) in self.faces.iter().enumerate() {
                mistakes.push(Mistake::new(&[face], false, &hidden_by, false));
                if self.has_time {
                    mistakes.push(Mistake::new(&[face], true, &hidden_by, false));
                }
                for other in &self.faces[place + 1..] {
                    let is_opposite = face.split('_').next() == other.split('_').next();
                    if !is_opposite {
                        mistakes.push(Mistake::new(&[face, other], false, &hidden_by, false));
                    }
                }
            }
            if self.has_time {
                mistakes.push(Mistake::new(&[], true, &hidden_by, false));
            }
        }
        mistakes
    }
}

/// A mistake: seen only where the solution is not flat at each of some faces, and at the first time;
/// and where the solution changes in each part of `hidden_by`.
#[derive(Debug, Clone, PartialEq)]
struct Mistake {
    faces: Vec<String>,
    is_initial: bool,
    hidden_by: Vec<Switch>,
    is_inside: bool,
}

impl Mistake {
    fn new(
        faces: &[&&'static str],
        is_initial: bool,
        hidden_by: &[Switch],
        is_inside: bool,
    ) -> Self {
        Self {
            faces: faces.iter().map(|face| (**face).to_owned()).collect(),
            is_initial,
            hidden_by: hidden_by.to_vec(),
            is_inside,
        }
    }

    fn is_hidden_in(&self, variant: &Switch) -> bool {
        let at = |is_flat: &dyn Fn(&str) -> bool| self.faces.iter().any(|face| is_flat(face));
        match variant {
            Switch::Face(name) => at(&|face| face == name),
            Switch::BothFaces(name) => at(&|face| is_side(face, name)),
            Switch::AllFaces => at(&|_| true),
            Switch::AllFacesBut(name) => at(&|face| face != name),
            Switch::Initial => self.is_initial,
            Switch::AllFacesAndInitial => self.is_initial || at(&|_| true),
            inner => self.hidden_by.contains(inner),
        }
    }

    /// Whether a part that is named is one of the mistake.
    fn has(&self, part: &Switch) -> bool {
        match part {
            Switch::Face(name) => self.faces.contains(name),
            Switch::Initial => self.is_initial,
            inner => self.hidden_by.contains(inner),
        }
    }
}

fn fates(switches: &[Switch], mistakes: &[&Mistake]) -> Vec<Examined> {
    let examined = |switch: &Switch| {
        let is_seen = mistakes.iter().any(|mistake| !mistake.is_hidden_in(switch));
        Examined {
            switch: switch.clone(),
            fate: if is_seen { Fate::Lost } else { Fate::Back },
        }
    };
    switches.iter().map(examined).collect()
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
        let switches = setting.switches();
        for mistake in setting.mistakes() {
            let conclusion = decide(&fates(&switches, &[&mistake]));
            assert_true(&conclusion, &[&mistake]);
            named += usize::from(!conclusion.named().is_empty());
            let is_at_one_place = mistake.faces.len() + usize::from(mistake.is_initial) == 1;
            if is_at_one_place {
                assert!(
                    !conclusion.named().is_empty(),
                    "{mistake:?}: {conclusion:?}"
                );
            }
            if mistake.is_inside && mistake.hidden_by.len() == 1 {
                assert_eq!(conclusion.named(), mistake.hidden_by, "{conclusion:?}");
            }
            if mistake.is_inside && mistake.hidden_by.is_empty() {
                assert_eq!(conclusion, Conclusion::Everywhere);
            }
        }
    }
    assert!(named > 200, "{named}");
}

#[test]
fn of_two_mistakes_no_part_is_named_that_is_right() {
    let mut named = 0;
    for setting in settings() {
        let switches = setting.switches();
        let mistakes = setting.mistakes();
        for (place, one) in mistakes.iter().enumerate() {
            for other in &mistakes[place + 1..] {
                let conclusion = decide(&fates(&switches, &[one, other]));
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
        let switches = setting.switches();
        let mistakes = setting.mistakes();
        let pairs = mistakes.iter().enumerate().step_by(3);
        for (place, one) in pairs {
            for other in mistakes[place..].iter().step_by(5) {
                let whole = fates(&switches, &[one, other]);
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

/// The fates of a plane problem in time with these variants back, and all others lost.
fn back(names: &[&str]) -> Vec<Examined> {
    let switches = settings()[0].switches();
    let examined = |switch: &Switch| Examined {
        switch: switch.clone(),
        fate: if names.contains(&switch.variant().as_str()) {
            Fate::Back
        } else {
            Fate::Lost
        },
    };
    switches.iter().map(examined).collect()
}

fn with(mut examined: Vec<Examined>, variant: &str, fate: Fate) -> Vec<Examined> {
    let mut entries = examined.iter_mut();
    let entry = entries.find(|one| one.switch.variant() == variant);
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

#[test]
fn each_row_of_the_table_of_parts_has_its_conclusion() {
    let face = |name: &str| Conclusion::Faces(vec![name.to_owned()]);
    assert_eq!(decide(&back(&AT_X_MAX)), face("x_max"));
    let without_x = [AT_X_MAX.as_slice(), &["constant_x"]].concat();
    assert_eq!(decide(&back(&without_x)), face("x_max"));
    let without_t = [AT_X_MAX.as_slice(), &["constant_t"]].concat();
    let in_time = Conclusion::FaceInTime {
        face: "x_max".to_owned(),
        time: "t".to_owned(),
    };
    assert_eq!(decide(&back(&without_t)), in_time);
    let both = [
        "constant_x",
        "flat_x",
        "flat_faces",
        "flat_but_y_min",
        "flat_but_y_max",
        "flat_everywhere",
    ];
    let both = decide(&back(&both));
    assert_eq!(both, Conclusion::Faces(owned(&["x_min", "x_max"])));
    let unlike = [
        "flat_faces",
        "flat_but_x_min",
        "flat_but_y_min",
        "flat_everywhere",
    ];
    let unlike = decide(&back(&unlike));
    assert_eq!(unlike, Conclusion::Faces(owned(&["x_max", "y_max"])));
    let along = |part| Conclusion::Inside(vec![part]);
    let y = Switch::Coordinate("y".to_owned());
    assert_eq!(decide(&back(&["constant_y"])), along(y.clone()));
    let t = Switch::Time("t".to_owned());
    assert_eq!(decide(&back(&["constant_t"])), along(t));
    let p = Switch::Parameter("p".to_owned());
    assert_eq!(
        decide(&back(&["constant_y", "zero_p"])),
        Conclusion::Inside(vec![y, p])
    );
    let initial = decide(&back(&["flat_initial", "flat_everywhere"]));
    assert_eq!(initial, Conclusion::Initial);
    assert_eq!(decide(&back(&[])), Conclusion::Everywhere);
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
    for (variant, fate) in [
        ("flat_y_min", Fate::Unknown),
        ("flat_initial", Fate::Unknown),
        ("flat_faces", Fate::Unknown),
        ("flat_x_max", Fate::Unknown),
    ] {
        let conclusion = decide(&with(back(&AT_X_MAX), variant, fate));
        assert!(
            matches!(conclusion, Conclusion::Open(_)),
            "{variant}: {conclusion:?}"
        );
    }
    for variant in ["flat_y", "flat_everywhere", "flat_faces", "constant_x"] {
        let conclusion = decide(&with(back(&["constant_y"]), variant, Fate::Unknown));
        assert!(
            matches!(conclusion, Conclusion::Open(_)),
            "{variant}: {conclusion:?}"
        );
    }
    let round_off = with(back(&["constant_y"]), "constant_y", Fate::RoundOff);
    assert_eq!(decide(&round_off), Conclusion::Several);
}
