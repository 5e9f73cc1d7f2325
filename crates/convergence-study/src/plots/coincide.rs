//! Curves that hide each other: which ones a note must name.

use super::ruler::Ruler;
use super::style;
use super::xy::Curve;

/// Curves closer than this everywhere look like one, in px.
const CLOSE: f64 = 3.0;

/// A note for each set of data curves that lie on one another, at every point that both axes can show.
pub(super) fn notes(curves: &[Curve], x: &Ruler, y: &Ruler) -> Vec<String> {
    let is_shown = |curve: &&Curve| curve.is_data && curve.points.len() > 1;
    let data: Vec<&Curve> = curves.iter().filter(is_shown).collect();
    let mut sets: Vec<Vec<&Curve>> = vec![];
    for curve in data {
        let set = sets.iter_mut().find(|set| coincide(set[0], curve, x, y));
        match set {
            Some(set) if set.iter().all(|known| known.noted() != curve.noted()) => set.push(curve),
            Some(_) => {}
            None => sets.push(vec![curve]),
        }
    }
    let mut notes: Vec<String> = vec![];
    for set in sets.iter().filter(|set| set.len() > 1) {
        let names: Vec<&str> = set.iter().map(|curve| curve.noted()).collect();
        let note = format!("{} coincide", names.join(" and "));
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    notes
}

fn coincide(a: &Curve, b: &Curve, x: &Ruler, y: &Ruler) -> bool {
    // The plot is somewhat narrower than the page.
    let x = x.laid_out(0.0, style::WIDTH);
    let y = y.laid_out(0.0, style::PLOT_HEIGHT);
    let near = |ruler: &Ruler, a: f64, b: f64| match (ruler.px(a), ruler.px(b)) {
        (Some(a), Some(b)) => (a - b).abs() < CLOSE,
        (None, None) => true,
        _ => false,
    };
    let mut pairs = a.points.iter().zip(&b.points);
    a.points.len() == b.points.len() && pairs.all(|(p, q)| near(&x, p.0, q.0) && near(&y, p.1, q.1))
}
