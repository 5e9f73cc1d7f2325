//! The study file.
//!
//! ```toml
//! [[case]]
//! name = "listed-nodes"
//! claim = "..."                # in words
//! ends = "answer"              # or "indefinite", "iteration-limit", "not-finite": the failure
//! [case.answer]                # with `ends = "answer"` only: numbers as `run --format json` calls them
//! within = 1e-9                # bound on the distance to each
//! u_tip = -0.0408657198986
//! # and the tables of a scene, by any scheme
//! [case.time]
//! dt = 0.005
//! t_end = 1.0
//! ```

use std::path::Path;

use convergence_study::input::{InputError, Section};
use convergence_study::study::{FromFile, Header};

use super::{Answer, NUMBERS, Scenes, Whole};
use crate::kinds::energy::End;
use crate::scene::{self, Scene};

impl FromFile for Scenes {
    fn from_document(header: Header, root: &Section<'_>, _: &Path) -> Result<Self, InputError> {
        root.allow(&["study", "case"])?;
        let allowed = "a list of at least one case, each [[case]]";
        let list = root.require("case", allowed)?;
        let mut scenes: Vec<Whole> = vec![];
        for item in list.items(allowed)? {
            let whole = case(&item.section()?)?;
            if scenes.iter().any(|earlier| earlier.name == whole.name) {
                return Err(item.refuse(format!("a second \"{}\"", whole.name), "a name that no other case has"));
            }
            scenes.push(whole);
        }
        if scenes.is_empty() { Err(list.refuse_as_written(allowed)) } else { Ok(Self { header, scenes }) }
    }
}

fn case(section: &Section<'_>) -> Result<Whole, InputError> {
    section.allow(&[&["name", "claim", "ends", "answer"], &scene::TABLES[..]].concat())?;
    let name = section.require("name", "a text")?.text()?.to_owned();
    let end = section.require("ends", "\"answer\" or an error")?.choice(&End::ALL)?;
    let (answer, within) = match (section.section("answer")?, end) {
        (Some(answer), End::Answer) => numbers(&answer)?,
        (None, End::Answer) => {
            return Err(section.missing("answer", "a table with numbers, where a case ends with its answer"));
        }
        (Some(_), _) => return Err(section.refuse("answer", "an answer", "none, where a case ends with an error")),
        (None, _) => (vec![], 0.0),
    };
    Ok(Whole {
        claim: section.require("claim", "a text")?.text()?.to_owned(),
        scene: Scene::from_tables(section, name.clone())?,
        name,
        end,
        answer,
        within,
    })
}

/// The numbers of an answer, and the bound.
fn numbers(section: &Section<'_>) -> Result<(Answer, f64), InputError> {
    section.allow(&[&["within"], &NUMBERS[..]].concat())?;
    let within = section.positive("within")?;
    let mut answer = vec![];
    for name in NUMBERS {
        if let Some(field) = section.get(name) {
            answer.push((name, field.number()?));
        }
    }
    if answer.is_empty() {
        Err(section.missing(NUMBERS[0], "at least one number of the answer"))
    } else {
        Ok((answer, within))
    }
}
