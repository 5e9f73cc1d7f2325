//! What the name of a column says.

use super::cell::plain;

/// What a step, or a count of steps, is taken in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    Space,
    Time,
}

/// How a column gives the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Measure {
    Step,
    Count,
}

/// Names of steps and counts, separated by commas.
const SPACE_STEPS: &str = "h,hx,hy,hz,hmax,h max,hmin,dx,dy,dz,δx,δy,δz,delta x,deltax,mesh size,meshsize,grid size,grid spacing,element size,cell size,spacing,max h,edge length";
const SPACE_COUNTS: &str = "n,nx,ny,nz,n x,nx1,cells,ncells,ncell,n cells,active cells,number of active cells,cells per side,elements,elems,nelem,nel,n elements,nodes,points,mesh points,grid points,dofs,dof,ndof,ndofs,n dofs,degrees of freedom,unknowns,vertices,grid,mesh,resolution,size,panels,intervals,faces,edges,particles,samples";
const TIME_STEPS: &str =
    "dt,tau,τ,δt,delta t,deltat,time step,timestep,time step size,step size,k n,ht";
const TIME_COUNTS: &str = "nt,n t,steps,timesteps,nsteps,time steps,n steps";
const LEVELS: &str = "level,levels,lvl,refinement,refinements,refine,refinement level,cycle,l,ref";
const DEGREES: &str = "p,k,degree,deg,polydeg,fe degree,poly degree,polynomial degree,degré";

/// Counts, levels and dimensions: words in the names of whole numbers that may be set aside. The
/// page of tables prints them, and the costs.
const COUNTS: &str = "level levels lvl refinement refinements refine cycle l i index row id run case iteration iterations iter iters its nl li newton cg gmres ncycle cycles steps nsteps timesteps evaluations evals calls rhs ranks procs threads cores ref seed order degree p n nt nx ny nz nodes cells elements points dofs dim edges faces samples particles ne ni k m";
/// Words in the names of costs, which may be any numbers.
const COSTS: &str = "time times cpu wall walltime runtime elapsed temps sec seconds secs s solve setup assembly mem memory cost flops duration";
const RATES: &str = "order orders rate rates eoc ooc roc ordre slope slopes ratio ratios factor reduction conv log2";
/// Parts of a word, and words, that only an error has in its name.
const ERROR_PARTS: &str = "err norm resid diff dev ∞ infty | fehler linf lmax";
const ERROR_WORDS: &str = "l1 l2 lp h0 h1 h2 rms rmse mae";
const SPACED_NORMS: &str = " l 1 , l 2 , l p , l inf , l max , h 0 , h 1 , h 2 ";
/// Words of which two in a name are another norm than one of them.
const NORMS: &str = "l1 l2 lp h0 h1 h2 linf inf max inside";
const UNITS: &str = "s ms us m mm cm h K Pa";

/// The name of a column in small letters, without markup and unit, words separated by blanks.
pub(super) fn key(name: &str) -> String {
    let name = plain(name);
    let name = name.trim_start_matches(['#', '%', '\\', ' ']);
    let unit = name
        .rsplit_once('/')
        .filter(|(_, unit)| UNITS.split(' ').any(|one| one == *unit));
    let name = unit.map_or(name, |(name, _)| name);
    let bracket = if name.ends_with(']') { "[" } else { "(" };
    let name = match name.rfind(bracket) {
        Some(start) if start > 0 && name.ends_with([']', ')']) => &name[..start],
        _ => name,
    };
    let name = name
        .to_lowercase()
        .replace('∆', "δ")
        .replace(['_', '\\', '{', '}', '^'], " ");
    let words: Vec<&str> = name.split_whitespace().collect();
    let words = words.join(" ");
    let count = ["number of ", "num ", "no. "]
        .iter()
        .find_map(|start| words.strip_prefix(start));
    count.map_or(words.clone(), str::to_owned)
}

fn has(list: &str, key: &str) -> bool {
    list.split(',').any(|name| name == key)
}

/// The words of a key.
pub(super) fn words(key: &str) -> impl Iterator<Item = &str> {
    key.split(|c: char| !(c.is_alphanumeric() || c == '|'))
        .filter(|word| !word.is_empty())
}

fn has_word(list: &str, key: &str) -> bool {
    words(key).any(|word| list.split(' ').any(|known| known == word))
}

/// What a column steps through, and how, by its key.
pub(super) fn family(key: &str) -> Option<(Family, Measure)> {
    let rows = [
        (SPACE_STEPS, Family::Space, Measure::Step),
        (TIME_STEPS, Family::Time, Measure::Step),
        (TIME_COUNTS, Family::Time, Measure::Count),
        (SPACE_COUNTS, Family::Space, Measure::Count),
    ];
    let row = rows.into_iter().find(|(list, ..)| has(list, key));
    row.map(|(_, family, measure)| (family, measure))
}

pub(super) fn is_level(key: &str) -> bool {
    has(LEVELS, key)
}

/// Whether a key is one of the degree of elements.
pub(crate) fn is_degree(key: &str) -> bool {
    has(DEGREES, &key.to_lowercase())
}

/// Whether a key has a word of rates or factors, or is `r`.
pub(super) fn says_rates(key: &str) -> bool {
    has_word(RATES, key) || key == "r"
}

/// The error X of which a column named `rate of X` has the rates.
pub(super) fn error_of_rates(name: &str) -> Option<String> {
    plain(name).strip_prefix("rate of ").map(str::to_owned)
}

/// Whether a key has a word of an error.
pub(super) fn says_error(key: &str) -> bool {
    let spaced = format!(" {} ", words(key).collect::<Vec<_>>().join(" "));
    ERROR_PARTS.split(' ').any(|part| key.contains(part))
        || has_word(ERROR_WORDS, key)
        || SPACED_NORMS.split(',').any(|norm| spaced.contains(norm))
        || key.starts_with("e ")
}

/// Whether a word of a key is an error, and none a kind of it: `L2`, `rel err`, and no `err type`.
pub(super) fn says_error_alone(key: &str) -> bool {
    const ERRORS: &str = "err error errors linf lmax residual";
    const KINDS: &str = "kind message messages name norm type";
    (has_word(ERRORS, key) || has_word(ERROR_WORDS, key)) && !has_word(KINDS, key)
}

/// Whether a key asks whether a level was solved.
pub(super) fn says_solved(key: &str) -> bool {
    const SOLVED: &str = "conv succe ok valid pass finish complete stable solved";
    words(key).any(|word| SOLVED.split(' ').any(|start| word.starts_with(start)))
}

/// Whether a key numbers samples.
pub(super) fn says_sample(key: &str) -> bool {
    has_word(
        "seed sample run replica realization realisation path trial",
        key,
    )
}

/// Whether a key has a word of a cost.
pub(super) fn says_cost(key: &str) -> bool {
    has_word(COSTS, key)
}

/// Whether a key has a word of counts, levels, dimensions or costs.
pub(super) fn says_count_or_cost(key: &str) -> bool {
    has_word(COUNTS, key) || says_cost(key)
}

/// A name without units, marks and case, with one blank between words.
fn plain_key(name: &str) -> String {
    words(&plain(name).to_lowercase())
        .collect::<Vec<_>>()
        .join(" ")
}

/// The columns of these names that are meant: by name, by name without unit and marks, by number
/// from 1, or by words that only one name has, beside words of no other norm: `L2` is `L2 error`,
/// and neither `L2 H1` nor, as `max`, `max inside`.
pub(crate) fn position<'n>(
    names: impl Iterator<Item = &'n str> + Clone,
    wanted: &str,
) -> Option<usize> {
    let looked_for = plain_key(wanted);
    let is_same = |name: &str| plain(name) == plain(wanted);
    let is_near = |name: &str| plain_key(name) == looked_for || key(name) == looked_for;
    if let Some(found) = names.clone().position(is_same) {
        return Some(found);
    }
    let mut near = names.clone().enumerate().filter(|(_, name)| is_near(name));
    if let Some((found, _)) = near.next() {
        return near.next().is_none().then_some(found);
    }
    if let Ok(number) = wanted.trim().parse::<usize>() {
        return number.checked_sub(1).filter(|k| *k < names.count());
    }
    let is_wanted = |own: &str| words(&looked_for).any(|word| word == own);
    let is_norm = has_word(NORMS, &looked_for);
    let has_words = |name: &str| {
        let name = plain_key(name);
        let mut others = words(&name).filter(|own| !is_wanted(own));
        !looked_for.is_empty()
            && words(&looked_for).all(|word| words(&name).any(|own| own == word))
            && !(is_norm && others.any(|own| has_word(NORMS, own)))
    };
    let mut several = names.enumerate().filter(|(_, name)| has_words(name));
    let (found, _) = several.next()?;
    several.next().is_none().then_some(found)
}

#[cfg(test)]
mod tests {
    use super::{COSTS, COUNTS, position};

    #[test]
    fn a_name_is_found_by_its_words_but_not_in_that_of_another_norm() {
        for (wanted, names, found) in [
            ("L2", ["L2 error", "H1 error"], Some(0)),
            ("val", ["val L2", "p L2"], Some(0)),
            ("L2", ["L2 error", "L2 of p"], None),
            ("max", ["max inside", "L2"], None),
            ("H1", ["L2 H1", "max"], None),
            ("L2", ["max of L2", "h"], None),
        ] {
            assert_eq!(position(names.into_iter(), wanted), found, "{wanted}");
        }
    }

    #[test]
    fn the_page_of_tables_prints_the_lists() {
        let page = include_str!("../../../book/src/tables.md");
        assert!(page.contains(&format!("\n{COUNTS}; costs:\n{COSTS}.\n")));
        assert!([COUNTS, COSTS].join(" ").split(' ').count() <= 90);
    }
}
