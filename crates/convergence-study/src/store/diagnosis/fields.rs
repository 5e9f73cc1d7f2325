//! Which fields moved, and how much of the movement each has.

use super::{WrongField, WrongRate, moved_numbers, subject_of_number};
use crate::run::Finished;
use crate::store::{GuardedChange, Movement};
use crate::study::{NamedRate, Sort};

/// The share of a field is this power of its weight over the largest of its study: half the weight
/// is 1/256 of the share.
const SHARPNESS: i32 = 8;

/// The share of the only wrong field of a study, which does not show which field is first.
const ALONE: f64 = 0.1;

/// Fields by their share of the movement: within a study each is measured by its tolerance, on its
/// finest level, where its own error has had the least time to mix with those of others.
pub(super) fn first(finished: &[Finished], changes: &[GuardedChange]) -> Vec<WrongField> {
    let mut fields: Vec<WrongField> = vec![];
    for study in finished {
        let moved = moved_fields(study, changes);
        let most = moved
            .iter()
            .map(|field| field.weight)
            .fold(f64::MIN_POSITIVE, f64::max);
        for one in &moved {
            let share = if moved.len() > 1 {
                (one.weight / most).powi(SHARPNESS)
            } else {
                ALONE
            };
            add(&mut fields, one, share);
        }
    }
    fields.sort_by(|one, next| next.share.total_cmp(&one.share));
    fields
}

/// A field of one study whose errors moved or whose rate does not pass.
struct MovedField {
    name: String,
    /// How far its error on the finest level moved, in tolerances, as a logarithm; 1 if only the
    /// rate is wrong.
    weight: f64,
    /// By what its error on the finest level was multiplied.
    factor: f64,
    /// The rate that does not pass.
    rate: Option<WrongRate>,
}

/// The fields of a study whose errors moved, then those of which only the rate does not pass.
fn moved_fields(study: &Finished, changes: &[GuardedChange]) -> Vec<MovedField> {
    // Levels are in order: the last number of a field belongs to its finest level.
    let mut moved: Vec<MovedField> = vec![];
    let outcome = &study.outcome;
    for GuardedChange { name, movement, .. } in moved_numbers(changes, &study.header.id) {
        let Movement::Moved { from, to, .. } = movement else {
            continue;
        };
        let mut quantities = outcome.quantities.iter();
        if quantities.any(|quantity| quantity.name == *name && quantity.sort == Sort::Rate) {
            continue;
        }
        let name = subject_of_number(outcome, name).quantity;
        let factor = (to / from).abs();
        moved.retain(|known| known.name != name);
        moved.push(MovedField {
            name,
            weight: movement.weight().clamp(0.0, 1e12).ln_1p(),
            factor: if factor.is_nan() {
                f64::INFINITY
            } else {
                factor
            },
            rate: None,
        });
    }
    let rates = outcome.rates.iter();
    let wrong: Vec<(String, Option<WrongRate>)> = rates
        .filter(|named| !named.rate.verdict.is_pass())
        .map(|NamedRate { subject, rate, .. }| {
            let known = rate.fitted.zip(rate.order());
            let wrong = known.map(|(observed, claimed)| WrongRate { observed, claimed });
            (subject.quantity.clone(), wrong)
        })
        .collect();
    let unmoved: Vec<MovedField> = wrong
        .iter()
        .filter(|(name, _)| moved.iter().all(|known| known.name != *name))
        .map(|(name, _)| MovedField {
            name: name.clone(),
            weight: 1.0,
            factor: 1.0,
            rate: None,
        })
        .collect();
    moved.extend(unmoved);
    for one in &mut moved {
        let mut of_field = wrong.iter().filter(|(name, _)| *name == one.name);
        one.rate = of_field.find_map(|(_, rate)| *rate);
    }
    moved
}

/// Adds what one study says about a field to what the others say.
fn add(fields: &mut Vec<WrongField>, moved: &MovedField, share: f64) {
    let known = fields.iter().position(|field| field.name == moved.name);
    let place = known.unwrap_or(fields.len());
    if known.is_none() {
        fields.push(WrongField {
            name: moved.name.clone(),
            share: 0.0,
            rate: None,
            factor: 1.0,
        });
    }
    let field = &mut fields[place];
    field.share += share;
    field.rate = [field.rate, moved.rate]
        .into_iter()
        .flatten()
        .max_by(|a, b| a.distance().total_cmp(&b.distance()));
    if moved.factor.ln().abs() > field.factor.ln().abs() {
        field.factor = moved.factor;
    }
}
