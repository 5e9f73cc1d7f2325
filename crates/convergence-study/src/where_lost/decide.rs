//! Which part of a program the variants name: a function of what became of the order in each.
//!
//! **The argument.** Let the order come back in a variant: then every mistake is invisible in it,
//! so each is in a part that the variant switches off. Let it stay lost: then at least one mistake
//! acts on it, in a part that the variant leaves on. So
//!
//! - back where the solution is flat at one face: all mistakes are at this face;
//! - lost where it is flat at all faces but one, back where it is flat at this one too: a mistake
//!   is at that face;
//! - lost where it is flat at all faces and at the first time: a mistake is inside the domain; if
//!   the order is back where the solution does not change along y, that mistake acts along y.
//!
//! Each name follows from such a pair. The further conditions guard against a variant in which the
//! lost part is merely small, and so looks restored at the levels of a study: variants that switch
//! off more must agree. What is not known is no evidence: a part is not named if a variant that its
//! name rests on is missing or undecided.

use crate::run::Fate;
use crate::study::variants::SolverPart;

/// A variant, and what became of the order.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Examined {
    pub(super) part: SolverPart,
    pub(super) fate: Fate,
}

/// What follows.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Conclusion {
    /// Mistakes at these faces, and at no other place.
    Faces(Vec<String>),
    /// At one face, and only if the data change in time, which has this name.
    FaceInTime { face: String, time: String },
    /// Where two faces meet.
    Corner([String; 2]),
    /// In the data at the first time.
    Initial,
    /// Inside the domain: in what acts along a coordinate or time, or has a parameter or a field;
    /// if there are several, in what has all of them.
    Inside(Vec<SolverPart>),
    /// Lost in each variant.
    Everywhere,
    /// A variant would decide, and is missing or undecided: these are.
    Open(Vec<SolverPart>),
    /// No single part explains what the variants show.
    Several,
}

impl Conclusion {
    /// The parts that are named.
    pub(super) fn named(&self) -> Vec<SolverPart> {
        match self {
            Self::Faces(names) => names.iter().cloned().map(SolverPart::Face).collect(),
            Self::FaceInTime { face, time } => {
                vec![
                    SolverPart::Face(face.clone()),
                    SolverPart::Time(time.clone()),
                ]
            }
            Self::Corner(names) => names.iter().cloned().map(SolverPart::Face).collect(),
            Self::Initial => vec![SolverPart::Initial],
            Self::Inside(parts) => parts.clone(),
            Self::Everywhere | Self::Open(_) | Self::Several => vec![],
        }
    }
}

/// What the variants of a file show, all of them: one that could not be used is unknown.
pub(super) fn decide(examined: &[Examined]) -> Conclusion {
    let table = Fates(examined);
    let of_faces = match table.single_faces_back().as_slice() {
        [] => table.no_single_face(),
        [face] => table.one_face(face),
        [one, other] => table.corner(one, other),
        _ => Deduction::Nothing,
    };
    let found = [of_faces, table.initial(), table.inside()]
        .into_iter()
        .find(|found| matches!(found, Deduction::Conclusion(_)))
        .unwrap_or(Deduction::Nothing);
    match found {
        Deduction::Conclusion(conclusion) => conclusion,
        Deduction::Nothing if examined.iter().any(|one| one.fate == Fate::Unknown) => {
            let unknown = examined.iter().filter(|one| one.fate == Fate::Unknown);
            Conclusion::Open(unknown.map(|one| one.part.clone()).collect())
        }
        Deduction::Nothing if examined.iter().all(|one| one.fate == Fate::Lost) => {
            Conclusion::Everywhere
        }
        Deduction::Nothing => Conclusion::Several,
    }
}

enum Deduction {
    Conclusion(Conclusion),
    Nothing,
}

impl Deduction {
    /// The conclusion, if all that it rests on is there.
    fn if_all(conditions: &[bool], conclusion: Conclusion) -> Self {
        if conditions.iter().all(|holds| *holds) {
            Self::Conclusion(conclusion)
        } else {
            Self::Nothing
        }
    }
}

struct Fates<'e>(&'e [Examined]);

impl Fates<'_> {
    fn fates(&self, is_wanted: impl Fn(&SolverPart) -> bool) -> Vec<Fate> {
        let wanted = self.0.iter().filter(|one| is_wanted(&one.part));
        wanted.map(|one| one.fate).collect()
    }

    /// Whether the order is back in all such variants; true if the file has none.
    fn are_back(&self, is_wanted: impl Fn(&SolverPart) -> bool) -> bool {
        self.fates(is_wanted).iter().all(|fate| *fate == Fate::Back)
    }

    fn are_lost(&self, is_wanted: impl Fn(&SolverPart) -> bool) -> bool {
        self.fates(is_wanted).iter().all(|fate| *fate == Fate::Lost)
    }

    fn are_not_lost(&self, is_wanted: impl Fn(&SolverPart) -> bool) -> bool {
        !self.fates(is_wanted).contains(&Fate::Lost)
    }

    fn are_not_back(&self, is_wanted: impl Fn(&SolverPart) -> bool) -> bool {
        let fates = self.fates(is_wanted);
        !fates.contains(&Fate::Back) && !fates.contains(&Fate::RoundOff)
    }

    /// The faces at each of which alone the solution may be flat, with its order back.
    fn single_faces_back(&self) -> Vec<String> {
        let names = self.0.iter().filter_map(|one| match &one.part {
            SolverPart::Face(name) if matches!(one.fate, Fate::Back | Fate::RoundOff) => {
                Some(name.clone())
            }
            _ => None,
        });
        names.collect()
    }

    fn one_face(&self, face: &str) -> Deduction {
        let this = |part: &SolverPart| *part == SolverPart::Face(face.to_owned());
        let other = |part: &SolverPart| matches!(part, SolverPart::Face(name) if name != face);
        let conclusion = match self.time_back() {
            Some(time) => Conclusion::FaceInTime {
                face: face.to_owned(),
                time,
            },
            None => Conclusion::Faces(vec![face.to_owned()]),
        };
        let conditions = [
            self.are_back(this),
            self.are_lost(other),
            // Data at a face act little on a solution that is flat at the first time, and a variant
            // in which the lost part may hide is undecided.
            self.are_not_back(|part| *part == SolverPart::Initial),
            self.agrees(face),
        ];
        Deduction::if_all(&conditions, conclusion)
    }

    /// The time's name, if the order is back where nothing changes in it.
    fn time_back(&self) -> Option<String> {
        self.0.iter().find_map(|one| match &one.part {
            SolverPart::Time(name) if one.fate == Fate::Back => Some(name.clone()),
            _ => None,
        })
    }

    /// Whether variants that are flat at this face and at others agree that its data are at fault.
    fn agrees(&self, face: &str) -> bool {
        let of_others =
            |part: &SolverPart| matches!(part, SolverPart::BothFaces(name) if !is_side(face, name));
        let both =
            |part: &SolverPart| matches!(part, SolverPart::BothFaces(name) if is_side(face, name));
        let others =
            |part: &SolverPart| matches!(part, SolverPart::AllFacesBut(name) if name != face);
        let but_this = |part: &SolverPart| *part == SolverPart::AllFacesBut(face.to_owned());
        self.are_back(both)
            && self.are_not_back(of_others)
            && self.are_back(|part| *part == SolverPart::AllFaces)
            && self.are_not_lost(others)
            && self.are_not_lost(|part| *part == SolverPart::AllFacesAndInitial)
            && self.are_not_back(but_this)
    }

    fn corner(&self, one: &str, other: &str) -> Deduction {
        let names = [one.to_owned(), other.to_owned()];
        let is_of_the_two =
            |part: &SolverPart| matches!(part, SolverPart::Face(name) if names.contains(name));
        let is_another =
            |part: &SolverPart| matches!(part, SolverPart::Face(name) if !names.contains(name));
        let both = |part: &SolverPart| matches!(part, SolverPart::BothFaces(name) if is_side(one, name) || is_side(other, name));
        let opposite = |part: &SolverPart| matches!(part, SolverPart::BothFaces(name) if is_side(one, name) && is_side(other, name));
        let conditions = [
            self.fates(opposite).is_empty(),
            self.are_back(is_of_the_two),
            self.are_lost(is_another),
            self.are_lost(|part| *part == SolverPart::Initial),
            self.are_back(both),
            self.are_back(|part| *part == SolverPart::AllFaces),
            self.are_not_lost(|part| matches!(part, SolverPart::AllFacesBut(_))),
            self.are_not_lost(|part| *part == SolverPart::AllFacesAndInitial),
        ];
        Deduction::if_all(&conditions, Conclusion::Corner(names))
    }

    fn no_single_face(&self) -> Deduction {
        match self.coordinates_with_both_back().as_slice() {
            [] => self.faces_by_all_but_one(),
            [coordinate] => self.both_faces(coordinate),
            _ => Deduction::Nothing,
        }
    }

    fn coordinates_with_both_back(&self) -> Vec<String> {
        let names = self.0.iter().filter_map(|one| match &one.part {
            SolverPart::BothFaces(name) if matches!(one.fate, Fate::Back | Fate::RoundOff) => {
                Some(name.clone())
            }
            _ => None,
        });
        names.collect()
    }

    fn both_faces(&self, coordinate: &str) -> Deduction {
        let faces = ["min", "max"].map(|end| format!("{coordinate}_{end}"));
        let this =
            |part: &SolverPart| matches!(part, SolverPart::BothFaces(name) if name == coordinate);
        let other =
            |part: &SolverPart| matches!(part, SolverPart::BothFaces(name) if name != coordinate);
        let but_these = |part: &SolverPart| matches!(part, SolverPart::AllFacesBut(name) if faces.contains(name));
        let but_others = |part: &SolverPart| matches!(part, SolverPart::AllFacesBut(name) if !faces.contains(name));
        let conditions = [
            self.are_back(this),
            self.are_lost(is_single_face),
            self.are_lost(other),
            self.are_not_back(|part| *part == SolverPart::Initial),
            self.are_not_back(but_these),
            self.are_not_lost(but_others),
            self.are_back(|part| *part == SolverPart::AllFaces),
            self.are_not_lost(|part| *part == SolverPart::AllFacesAndInitial),
        ];
        Deduction::if_all(&conditions, Conclusion::Faces(faces.to_vec()))
    }

    /// Several faces, of unlike coordinates: each without which the order stays lost.
    fn faces_by_all_but_one(&self) -> Deduction {
        let faces = self.0.iter().filter_map(|one| match &one.part {
            SolverPart::AllFacesBut(name) if one.fate == Fate::Lost => Some(name.clone()),
            _ => None,
        });
        let faces: Vec<String> = faces.collect();
        let is_all = |part: &SolverPart| *part == SolverPart::AllFaces;
        let all_but = |part: &SolverPart| matches!(part, SolverPart::AllFacesBut(_));
        let is_known = |fate: &Fate| matches!(fate, Fate::Lost | Fate::Back);
        // Both faces of one coordinate have a variant of their own.
        let covers = |part: &SolverPart| matches!(part, SolverPart::BothFaces(name) if faces.iter().all(|face| is_side(face, name)));
        let conditions = [
            faces.len() >= 2,
            self.fates(covers).is_empty(),
            self.are_lost(|part| *part == SolverPart::Initial),
            !self.fates(is_all).is_empty() && self.are_back(is_all),
            self.fates(all_but).iter().all(is_known),
            self.are_lost(is_single_face),
            self.are_lost(|part| matches!(part, SolverPart::BothFaces(_))),
            self.are_not_lost(|part| *part == SolverPart::AllFacesAndInitial),
        ];
        Deduction::if_all(&conditions, Conclusion::Faces(faces))
    }

    fn initial(&self) -> Deduction {
        let this = |part: &SolverPart| *part == SolverPart::Initial;
        let faces = |part: &SolverPart| is_flat(part) && !this(part);
        let conditions = [
            !self.fates(this).is_empty() && self.are_back(this),
            self.are_lost(|part| faces(part) && *part != SolverPart::AllFacesAndInitial),
            self.are_back(|part| *part == SolverPart::AllFacesAndInitial),
        ];
        Deduction::if_all(&conditions, Conclusion::Initial)
    }

    /// What acts inside the domain. That it is lost where all is flat outweighs that it seems to be
    /// back where less is: there the lost part may be small.
    fn inside(&self) -> Deduction {
        let back = self
            .0
            .iter()
            .filter(|one| !is_flat(&one.part) && one.fate == Fate::Back);
        let back: Vec<SolverPart> = back.map(|one| one.part.clone()).collect();
        let is_along =
            |part: &SolverPart| matches!(part, SolverPart::Coordinate(_) | SolverPart::Time(_));
        let along = back.iter().filter(|part| is_along(part)).count();
        // If it is lost in the last of these that the file has, it is in those before, too.
        let of_all = [
            SolverPart::Initial,
            SolverPart::AllFaces,
            SolverPart::AllFacesAndInitial,
        ];
        let strongest = of_all
            .iter()
            .rfind(|one| !self.fates(|part| part == *one).is_empty());
        // Without one of these, both faces of the one coordinate are all faces.
        let is_strong = |part: &SolverPart| match part {
            SolverPart::BothFaces(_) => strongest.is_none(),
            part => *part == SolverPart::AllFaces || Some(part) == strongest,
        };
        let both = |part: &SolverPart| match part {
            SolverPart::BothFaces(name) => back.contains(&SolverPart::Coordinate(name.clone())),
            _ => false,
        };
        let conditions = [
            !back.is_empty(),
            along <= 1,
            !self.fates(is_along).contains(&Fate::Unknown),
            !self.fates(is_along).contains(&Fate::RoundOff),
            self.are_lost(is_strong),
            self.are_lost(both),
        ];
        Deduction::if_all(&conditions, Conclusion::Inside(back))
    }
}

fn is_single_face(part: &SolverPart) -> bool {
    matches!(part, SolverPart::Face(_))
}

/// Whether a variant switches off data.
fn is_flat(part: &SolverPart) -> bool {
    match part {
        SolverPart::Face(_)
        | SolverPart::BothFaces(_)
        | SolverPart::AllFaces
        | SolverPart::AllFacesBut(_)
        | SolverPart::Initial
        | SolverPart::AllFacesAndInitial => true,
        SolverPart::Coordinate(_)
        | SolverPart::Time(_)
        | SolverPart::Parameter(_)
        | SolverPart::Field(_) => false,
    }
}

/// Whether a face belongs to a coordinate.
fn is_side(face: &str, coordinate: &str) -> bool {
    let ending = face.strip_prefix(coordinate);
    matches!(ending, Some("_min" | "_max"))
}

#[cfg(test)]
mod tests;
