//! All mistakes of a model, one and two at a time, with all ways in which variants may hide them.

use super::*;
use crate::rows::rows;

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

/// The variants that are flat at x_max.
const AT_X_MAX: &str =
    "flat_x_max flat_x flat_faces flat_but_x_min flat_but_y_min flat_but_y_max flat_everywhere";

/// What a plane problem in time shows, and what is concluded.
struct Shown {
    examined: Vec<Examined>,
    concluded: &'static str,
}

fn shown() -> Vec<Shown> {
    let shown = |[_, back, unknown, round_off, concluded]: [&'static str; 5]| {
        let mut examined = examined(&settings()[0].parts(), |_| false);
        for (fate, list) in [
            (Fate::Back, back),
            (Fate::RoundOff, round_off),
            (Fate::Unknown, unknown),
        ] {
            for variant in list.replace("AT_X_MAX", AT_X_MAX).split_whitespace() {
                set(&mut examined, variant, fate);
            }
        }
        Shown {
            examined,
            concluded,
        }
    };
    let rows = rows(include_str!("conclusions.md")).into_iter();
    rows.map(shown).collect()
}

fn set(examined: &mut [Examined], variant: &str, fate: Fate) {
    let mut entries = examined.iter_mut();
    let entry = entries.find(|one| name(&one.part) == variant);
    entry.unwrap_or_else(|| panic!("no {variant}")).fate = fate;
}

/// A conclusion, with the variants of the parts that are named or would decide.
fn in_words(conclusion: &Conclusion) -> String {
    let (word, parts) = match conclusion {
        Conclusion::Named(parts) => ("", parts),
        Conclusion::Corner(parts) => ("the corner of ", parts),
        Conclusion::Open(parts) => ("open: ", parts),
        Conclusion::Everywhere => return "everywhere".to_owned(),
        Conclusion::Several => return "several".to_owned(),
    };
    let names: Vec<String> = parts.iter().map(name).collect();
    word.to_owned() + &names.join(" ")
}

#[test]
fn variants_show_a_part_and_none_is_named_in_round_off_or_where_a_variant_contradicts_or_lacks() {
    for Shown {
        examined,
        concluded,
    } in shown()
    {
        let said = in_words(&decide(&examined));
        let is_open = said.starts_with("open: ") && concluded == "open";
        assert!(
            said == concluded || is_open,
            "{said}, not {concluded}: {examined:?}"
        );
    }
}

/// One variant that is mistaken takes names away; it gives none.
#[test]
fn a_variant_that_contradicts_others_names_nothing_else() {
    let mut silent = 0;
    for Shown { examined, .. } in shown().into_iter().take(13) {
        let named = decide(&examined).named();
        for one in &examined {
            let parts = parts_off(&one.part, &owned(settings()[0].faces));
            if !parts.iter().all(is_flat) {
                continue;
            }
            let opposite = match one.fate {
                Fate::Back => Fate::Lost,
                _ => Fate::Back,
            };
            let mut mistaken = examined.clone();
            set(&mut mistaken, &name(&one.part), opposite);
            let found = decide(&mistaken).named();
            silent += usize::from(found.is_empty());
            // Of several mistakes one more may be among those.
            let is_among = found.iter().all(|part| named.contains(part));
            assert!(
                is_among || named.len() != 1,
                "{one:?}: {found:?} for {named:?}"
            );
        }
    }
    assert!(silent > 40, "{silent}");
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
