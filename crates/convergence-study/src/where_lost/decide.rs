//! Which part of a program the variants name: a table of variants and one rule.
//!
//! **The table.** A variant switches off some parts: a face, the first time, a coordinate, a term.
//! A mistake acts in a part, or in several together (where two faces meet; at a face, in time); it
//! is hidden where one of these is switched off.
//!
//! **The rule.** Let the order come back in a variant: then every mistake is hidden in it. Let it
//! stay lost: then one mistake at least acts in none of the parts that it switches off. So
//!
//! - lost goes down: to each variant that switches off less; back goes up: to each that switches
//!   off more. Lost outweighs back, for where the lost part is merely small it seems to be gone;
//! - back in a variant of one part: every mistake acts in this part, which explains all losses;
//! - lost where some parts are off, back where one more is: a mistake acts in that one.
//!
//! One part that explains all is named before several that explain one each. What is named must
//! agree with the whole table, and nothing is named while another variant of one part may explain
//! as much.

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
    /// Every mistake acts in all of these parts: a face, the first time, what acts along a
    /// coordinate or time, or has a parameter or a field. Of several faces there is one at each.
    Named(Vec<SolverPart>),
    /// Where two faces meet.
    Corner(Vec<SolverPart>),
    /// Lost in each variant.
    Everywhere,
    /// These variants would decide, and are missing or undecided.
    Open(Vec<SolverPart>),
    /// No single part explains what the variants show.
    Several,
}

impl Conclusion {
    /// The parts that are named.
    pub(super) fn named(&self) -> Vec<SolverPart> {
        match self {
            Self::Named(parts) | Self::Corner(parts) => parts.clone(),
            Self::Everywhere | Self::Open(_) | Self::Several => vec![],
        }
    }
}

/// A variant, and the parts that it switches off.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) part: SolverPart,
    /// With what follows from others.
    pub(super) fate: Fate,
    /// As it was run.
    pub(super) measured: Fate,
    off: Vec<SolverPart>,
}

impl Row {
    fn is_flat(&self) -> bool {
        self.off.iter().all(is_flat)
    }

    fn hides(&self, mistake: &[SolverPart]) -> bool {
        self.off.iter().any(|part| mistake.contains(part))
    }

    fn switches_off_less_than(&self, other: &Self) -> bool {
        self.off.len() < other.off.len() && self.off.iter().all(|part| other.off.contains(part))
    }
}

/// What the variants of a file show, all of them: one that was not run is unknown.
pub(super) struct Table {
    pub(super) rows: Vec<Row>,
    /// The most parts that are off in a variant that seemed to be back, although the order is lost
    /// where more is off.
    contradicted: usize,
}

impl Table {
    pub(super) fn new(examined: &[Examined]) -> Self {
        let faces = examined.iter().filter_map(|one| match &one.part {
            SolverPart::Face(name) => Some(name.clone()),
            _ => None,
        });
        let faces: Vec<String> = faces.collect();
        let measured = examined.iter().map(|one| Row {
            part: one.part.clone(),
            fate: one.fate,
            measured: one.fate,
            off: parts_off(&one.part, &faces),
        });
        let measured: Vec<Row> = measured.collect();
        let mut rows = measured.clone();
        let mut contradicted = 0;
        for row in &mut rows {
            let mut lost = measured.iter().filter(|other| other.fate == Fate::Lost);
            let mut back = measured.iter().filter(|other| other.fate == Fate::Back);
            if lost.any(|other| row.switches_off_less_than(other)) {
                if row.fate == Fate::Back {
                    contradicted = row.off.len().max(contradicted);
                }
                row.fate = Fate::Lost;
            } else if row.fate == Fate::Unknown
                && back.any(|other| other.switches_off_less_than(row))
            {
                row.fate = Fate::Back;
            }
        }
        Self { rows, contradicted }
    }

    /// What follows from all of it.
    pub(super) fn conclusion(&self) -> Conclusion {
        let single = self.singles(Fate::Back);
        let (flat, inside): (Vec<SolverPart>, Vec<SolverPart>) =
            single.into_iter().partition(is_flat);
        let several = self.faces_by_pairs();
        let conclusion = if !flat.is_empty() {
            self.at_one_place(flat, inside)
        } else if several.len() > 1 {
            self.at_several_faces(&several, &inside)
        } else if !inside.is_empty() {
            self.inside(inside)
        } else {
            None
        };
        conclusion.unwrap_or_else(|| self.nothing())
    }

    /// The parts of which alone it is not known whether they explain all losses, if no other does.
    pub(super) fn may_explain_all(&self) -> Vec<SolverPart> {
        match self.singles(Fate::Back).is_empty() {
            true => self.singles(Fate::Unknown),
            false => vec![],
        }
    }

    /// The parts that seem to explain all losses alone; and the widest variant, which shows whether
    /// a part lies inside the domain or at its boundary.
    pub(super) fn explaining(&self) -> Vec<SolverPart> {
        let mut parts = self.singles(Fate::Back);
        if !parts.iter().all(is_flat) {
            parts.extend(self.widest().map(|row| row.part.clone()));
        }
        parts
    }

    /// What would decide.
    pub(super) fn open(&self) -> Vec<SolverPart> {
        match self.conclusion() {
            Conclusion::Open(parts) => parts,
            _ => vec![],
        }
    }

    /// What has to be known of a part inside the domain that seems to explain all losses.
    pub(super) fn open_inside(&self) -> Vec<SolverPart> {
        match self.singles(Fate::Back).iter().all(is_flat) {
            true => vec![],
            false => self.open(),
        }
    }

    /// The variant that switches off most of the boundary.
    fn widest(&self) -> Option<&Row> {
        let rows = self.rows.iter().filter(|row| row.is_flat());
        rows.max_by_key(|row| row.off.len())
    }

    fn of(&self, fate: Fate) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.fate == fate)
    }

    /// The parts whose own variants have this fate.
    fn singles(&self, fate: Fate) -> Vec<SolverPart> {
        let rows = self.of(fate).filter(|row| row.off.len() == 1);
        rows.map(|row| row.off[0].clone()).collect()
    }

    /// Whether the table is that of these mistakes, as far as it is known.
    fn agrees(&self, mistakes: &[Vec<SolverPart>]) -> bool {
        let mut rows = self.rows.iter();
        rows.all(|row| {
            let is_hidden = mistakes.iter().all(|mistake| row.hides(mistake));
            match row.fate {
                Fate::Back => is_hidden,
                Fate::Lost => !is_hidden,
                Fate::RoundOff | Fate::Unknown => true,
            }
        })
    }

    /// Every mistake acts in these parts.
    fn at_one_place(&self, flat: Vec<SolverPart>, inside: Vec<SolverPart>) -> Option<Conclusion> {
        if !self.agrees(&[[flat.as_slice(), &inside].concat()]) {
            return None;
        }
        // Some variant that is flat there and elsewhere must show it as well.
        let wider = self.rows.iter().filter(|row| {
            let has_all = flat.iter().all(|part| row.off.contains(part));
            row.is_flat() && row.off.len() > 1 && has_all
        });
        let wider: Vec<&Row> = wider.collect();
        if !wider.is_empty() && wider.iter().all(|row| row.measured != Fate::Back) {
            // What is not known is no denial.
            let unknown = wider.iter().filter(|row| row.measured == Fate::Unknown);
            let unknown: Vec<SolverPart> = unknown.map(|row| row.part.clone()).collect();
            return (!unknown.is_empty()).then_some(Conclusion::Open(unknown));
        }
        let mut open = self.singles(Fate::Unknown);
        open.retain(is_face);
        if !open.is_empty() {
            return Some(Conclusion::Open(open));
        }
        // A solution that is flat at the first time is small at the faces: it hides what is there.
        let (faces, initial): (Vec<SolverPart>, Vec<SolverPart>) =
            flat.into_iter().partition(is_face);
        match faces.as_slice() {
            [] => Some(Conclusion::Named(initial)),
            [_] => Some(in_time(faces, &inside)),
            [SolverPart::Face(one), SolverPart::Face(other)]
                if coordinate(one) != coordinate(other) =>
            {
                Some(Conclusion::Corner(faces))
            }
            _ => None,
        }
    }

    /// The faces in which a mistake acts: lost where some parts are off, back where this is, too.
    fn faces_by_pairs(&self) -> Vec<SolverPart> {
        let mut acting = vec![];
        for back in self.of(Fate::Back).filter(|row| row.is_flat()) {
            for lost in self
                .of(Fate::Lost)
                .filter(|lost| lost.switches_off_less_than(back))
            {
                let rest = back.off.iter().filter(|part| !lost.off.contains(part));
                if let [part] = rest.collect::<Vec<_>>()[..] {
                    acting.push(part);
                }
            }
        }
        let faces = self.rows.iter().map(|row| &row.part);
        let acting = faces.filter(|part| is_face(part) && acting.contains(part));
        acting.cloned().collect()
    }

    /// A mistake at each of these faces; all of them in time, if it explains all losses.
    fn at_several_faces(&self, faces: &[SolverPart], inside: &[SolverPart]) -> Option<Conclusion> {
        let mistakes = faces
            .iter()
            .map(|face| [std::slice::from_ref(face), inside].concat());
        if self.contradicted > 0 || !self.agrees(&mistakes.collect::<Vec<_>>()) {
            return None;
        }
        let mut open = self.singles(Fate::Unknown);
        // Each face must be one without which the order stays lost.
        let parts = self.of(Fate::Unknown).map(|row| row.part.clone());
        open.extend(parts.filter(|part| matches!(part, SolverPart::AllFacesBut(_))));
        Some(match open.is_empty() {
            true => in_time(faces.to_vec(), inside),
            false => Conclusion::Open(open),
        })
    }

    /// What acts inside the domain: the order is lost although the solution is flat at all faces
    /// and at the first time.
    fn inside(&self, parts: Vec<SolverPart>) -> Option<Conclusion> {
        let widest = self.widest()?;
        let along =
            |part: &&SolverPart| matches!(part, SolverPart::Coordinate(_) | SolverPart::Time(_));
        let unknown = self.singles(Fate::Unknown);
        let mut open: Vec<SolverPart> = unknown.iter().filter(along).cloned().collect();
        match widest.fate {
            Fate::Lost => (),
            Fate::Unknown => open.push(widest.part.clone()),
            Fate::Back | Fate::RoundOff => return None,
        }
        let is_round_off = self.singles(Fate::RoundOff).iter().filter(along).count() > 0;
        // At one face the lost part may be merely small.
        let is_doubtful = is_round_off || self.contradicted > 1;
        if parts.iter().filter(along).count() > 1 || is_doubtful {
            return None;
        }
        Some(match open.is_empty() {
            true => Conclusion::Named(parts),
            false => Conclusion::Open(open),
        })
    }

    fn nothing(&self) -> Conclusion {
        let unknown = self.of(Fate::Unknown).map(|row| row.part.clone());
        let unknown: Vec<SolverPart> = unknown.collect();
        if !unknown.is_empty() {
            Conclusion::Open(unknown)
        } else if self.of(Fate::Lost).count() == self.rows.len() && self.contradicted == 0 {
            Conclusion::Everywhere
        } else {
            Conclusion::Several
        }
    }
}

/// The parts that a variant switches off, one by one.
fn parts_off(part: &SolverPart, faces: &[String]) -> Vec<SolverPart> {
    let flat = |is_off: &dyn Fn(&String) -> bool| -> Vec<SolverPart> {
        let faces = faces.iter().filter(|face| is_off(face));
        faces.cloned().map(SolverPart::Face).collect()
    };
    match part {
        SolverPart::BothFaces(name) => flat(&|face| coordinate(face) == name),
        SolverPart::AllFaces => flat(&|_| true),
        SolverPart::AllFacesBut(name) => flat(&|face| face != name),
        SolverPart::AllFacesAndInitial => {
            let mut all = flat(&|_| true);
            all.push(SolverPart::Initial);
            all
        }
        one => vec![one.clone()],
    }
}

/// The coordinate that is constant on a face.
fn coordinate(face: &str) -> &str {
    face.rsplit_once('_').map_or(face, |parts| parts.0)
}

/// At these faces, and in time, if that is among the parts that explain all losses: then only if
/// the data change in it.
fn in_time(mut faces: Vec<SolverPart>, inside: &[SolverPart]) -> Conclusion {
    let mut inside = inside.iter();
    let time = inside.find(|part| matches!(part, SolverPart::Time(_)));
    faces.extend(time.cloned());
    Conclusion::Named(faces)
}

fn is_face(part: &SolverPart) -> bool {
    matches!(part, SolverPart::Face(_))
}

/// Whether a part is data, which a solution switches off that is flat there.
fn is_flat(part: &SolverPart) -> bool {
    is_face(part) || *part == SolverPart::Initial
}

#[cfg(test)]
mod tests;
