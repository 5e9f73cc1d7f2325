//! Self-animating SVG of the beam moving between its obstacles.

use convergence_harness::plots::Scale;
use convergence_harness::plots::canvas::{Anchor, Canvas, Layer, Pen, Point, Rect, grid};
use convergence_harness::plots::look::look;
use convergence_harness::plots::ruler::{Ruler, fixed, on_scale};
use convergence_harness::plots::style::elide;
use convergence_harness::plots::style::{self, LABEL_SIZE, TICK_SIZE, TITLE_SIZE};

pub use crate::run::history::Frames;
use crate::run::snapshot::thinned;

/// Maximum numbers of frames and of points per frame; their product bounds the size of the
/// document.
const MOST_FRAMES: usize = 120;
const MOST_POINTS: usize = 61;

const PLOT: Rect = Rect {
    left: 130.0,
    top: 60.0,
    right: 780.0,
    bottom: 400.0,
};
const TIME_BAR: f64 = 466.0;
const HEIGHT: f64 = 530.0;

/// A motion of the beam.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// Shown above the beam.
    pub title: Option<String>,
    /// Displacements; the motion is shown in proportion to their times.
    pub frames: Frames,
    /// Lower and upper obstacle, at the free end of the beam.
    pub obstacles: Option<(f64, f64)>,
    /// Duration of one cycle in seconds; 8 if not positive.
    pub seconds: f64,
}

/// Draws the clamped wall, the obstacles and the moving beam. If nothing moves, the beam is drawn
/// as in its most bent frame.
pub fn animation(figure: &Animation) -> String {
    let frames = drawable_frames(figure);
    let stage = Stage::new(figure, &frames);
    let mut canvas = Canvas::new(style::WIDTH, HEIGHT);
    canvas.draw(Layer::default(), |pen| stage.draw_scenery(pen, figure));
    canvas.raw(&stage.moving_parts(figure, &frames));
    let title = figure
        .title
        .clone()
        .unwrap_or_else(|| "Motion of the beam between its obstacles".into());
    canvas.finish(&title, "")
}

/// `(t, displacement at the points to draw)`, thinned, without incomplete frames.
fn drawable_frames(figure: &Animation) -> Vec<(f64, Vec<f64>)> {
    let Frames {
        times,
        points: nodes,
        u,
    } = &figure.frames;
    let is_complete = |frame: &&Vec<f64>| {
        frame.len() == nodes.len() && frame.iter().all(|&v| on_scale(Scale::Linear, v).is_some())
    };
    let timed = times.iter().zip(u);
    let all: Vec<(f64, &Vec<f64>)> = timed
        .filter(|(t, f)| t.is_finite() && is_complete(f))
        .map(|(&t, f)| (t, f))
        .collect();
    let points = thinned(nodes.len(), MOST_POINTS);
    let pick = |n: usize| (all[n].0, points.iter().map(|&i| all[n].1[i]).collect());
    thinned(all.len(), MOST_FRAMES)
        .into_iter()
        .map(pick)
        .collect()
}

/// Layout of the drawing.
struct Stage {
    x: Ruler,
    u: Ruler,
    t: Ruler,
    /// Nodes to draw.
    nodes: Vec<f64>,
}

impl Stage {
    fn new(figure: &Animation, frames: &[(f64, Vec<f64>)]) -> Self {
        let displacements = frames.iter().flat_map(|(_, u)| u.iter().copied());
        let obstacles = figure.obstacles.into_iter().flat_map(|(g1, g2)| [g1, g2]);
        let u = Ruler::around(
            Scale::Linear,
            displacements.chain(obstacles).chain([0.0]),
            0.12,
        );
        let points = &figure.frames.points;
        let x = Ruler::around(Scale::Linear, points.iter().copied(), 0.0);
        let t = Ruler::around(Scale::Linear, frames.iter().map(|f| f.0), 0.0);
        let nodes = thinned(points.len(), MOST_POINTS)
            .into_iter()
            .map(|i| points[i]);
        Self {
            x: x.laid_out(PLOT.left, PLOT.right),
            u: u.laid_out(PLOT.bottom, PLOT.top),
            t: t.laid_out(PLOT.left, PLOT.right),
            nodes: nodes.collect(),
        }
    }

    fn draw_scenery(&self, pen: &Pen<'_>, figure: &Animation) {
        if let Some(title) = &figure.title {
            let title = elide(title, TITLE_SIZE, style::WIDTH - 32.0);
            pen.text(
                &title,
                (0.5 * style::WIDTH, 28.0),
                TITLE_SIZE,
                Anchor::Center,
                style::INK,
            );
        }
        let rest = self.u.px(0.0).unwrap_or(PLOT.bottom);
        pen.line(&[(PLOT.left, rest), (PLOT.right, rest)], style::GRID, 1.4);
        let wall = Rect {
            left: PLOT.left - 18.0,
            right: PLOT.left,
            ..PLOT
        };
        pen.rect(wall, style::MINOR_GRID);
        pen.hatch(&[wall]);
        pen.line(
            &[(wall.right, wall.top), (wall.right, wall.bottom)],
            style::INK,
            2.0,
        );
        self.draw_displacement_axis(pen);
        self.draw_obstacles(pen, figure);
        self.draw_time_axis(pen);
    }

    fn draw_displacement_axis(&self, pen: &Pen<'_>) {
        let ticks = self.u.ticks(5);
        let edge = PLOT.left - 18.0;
        for t in &ticks.major {
            let y = self.u.px_of(t.position);
            pen.tick((edge - 6.0, y), (edge, y));
            pen.text(
                &t.label,
                (edge - 10.0, y),
                TICK_SIZE,
                Anchor::Right,
                style::INK,
            );
        }
        let power = match ticks.exponent {
            0 => String::new(),
            e => format!(" / {}", convergence_harness::plots::ruler::power_of_ten(e)),
        };
        pen.text_upwards(
            &format!("displacement u (dimensionless){power}"),
            (24.0, PLOT.centre().1),
            LABEL_SIZE,
        );
    }

    fn draw_obstacles(&self, pen: &Pen<'_>, figure: &Animation) {
        let Some((g1, g2)) = figure.obstacles else {
            return;
        };
        // Only the free end meets the obstacles.
        let (left, right) = (PLOT.right - 8.0, PLOT.right + 34.0);
        for (name, g, far) in [("g₁", g1, PLOT.bottom), ("g₂", g2, PLOT.top)] {
            let Some(near) = self.u.px(g) else { continue };
            let block = Rect {
                left,
                right,
                top: near.min(far),
                bottom: near.max(far),
            };
            pen.rect(block, style::SHADE);
            pen.hatch(&[block]);
            pen.line(&[(left, near), (right, near)], style::INK, 2.4);
            pen.text(
                name,
                (right + 10.0, near),
                LABEL_SIZE,
                Anchor::Left,
                style::INK,
            );
        }
    }

    fn draw_time_axis(&self, pen: &Pen<'_>) {
        pen.line(
            &[(PLOT.left, TIME_BAR), (PLOT.right, TIME_BAR)],
            style::INK,
            style::THIN,
        );
        for t in &self.t.ticks(6).major {
            let x = self.t.px_of(t.position);
            pen.tick((x, TIME_BAR), (x, TIME_BAR + 7.0));
            pen.text(
                &t.label,
                (x, TIME_BAR + 22.0),
                TICK_SIZE,
                Anchor::Center,
                style::INK,
            );
        }
        let at = (PLOT.centre().0, TIME_BAR + 47.0);
        pen.text("time t", at, LABEL_SIZE, Anchor::Center, style::INK);
        pen.text(
            "x = 0",
            (PLOT.left, PLOT.bottom + 20.0),
            TICK_SIZE,
            Anchor::Center,
            style::INK,
        );
        pen.text(
            "x = 1",
            (PLOT.right, PLOT.bottom + 20.0),
            TICK_SIZE,
            Anchor::Center,
            style::INK,
        );
    }

    /// The beam, its tip and the time mark, each with its animation.
    fn moving_parts(&self, figure: &Animation, frames: &[(f64, Vec<f64>)]) -> String {
        let bent =
            |frame: &(f64, Vec<f64>)| frame.1.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        // The first of several frames with the same deflection.
        let most = frames
            .iter()
            .enumerate()
            .rev()
            .max_by(|a, b| bent(a.1).total_cmp(&bent(b.1)));
        let Some((still, shown)) = most else {
            return String::new();
        };
        let blue = look(0).colour;
        let colour = format!("#{:02x}{:02x}{:02x}", blue.0, blue.1, blue.2);
        let clock = self.clock(figure, frames);
        let shapes: Vec<String> = frames.iter().map(|f| points(&self.beam(&f.1))).collect();
        let tip = |f: &(f64, Vec<f64>)| {
            self.beam(&f.1)
                .last()
                .copied()
                .unwrap_or((PLOT.left, PLOT.bottom))
        };
        let list = |v: &mut dyn Iterator<Item = f64>| {
            v.map(|v| grid(v).to_string()).collect::<Vec<_>>().join(";")
        };
        let heights = list(&mut frames.iter().map(|f| tip(f).1));
        let marks = list(&mut frames.iter().map(|f| self.t.px_of(f.0)));
        let (beam, beams) = (&shapes[still], shapes.join(";"));
        let (tip_x, tip_y) = tip(shown);
        let [tip_x, tip_y, mark_x, mark_y] =
            [tip_x, tip_y, self.t.px_of(shown.0), TIME_BAR].map(grid);
        format!(
            "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"70\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\" points=\"{beam}\">\n\
             <animate attributeName=\"points\" {clock} values=\"{beams}\"/>\n</polyline>\n\
             <circle cx=\"{tip_x}\" cy=\"{tip_y}\" r=\"75\" fill=\"{colour}\" stroke=\"#ffffff\" stroke-width=\"18\">\n\
             <animate attributeName=\"cy\" {clock} values=\"{heights}\"/>\n</circle>\n\
             <circle cx=\"{mark_x}\" cy=\"{mark_y}\" r=\"80\" fill=\"{colour}\">\n\
             <animate attributeName=\"cx\" {clock} values=\"{marks}\"/>\n</circle>\n"
        )
    }

    fn beam(&self, u: &[f64]) -> Vec<Point> {
        let place = |(&x, &u): (&f64, &f64)| (self.x.px(x).unwrap_or(PLOT.left), self.u.px_of(u));
        self.nodes.iter().zip(u).map(place).collect()
    }

    /// Duration and key times, which must rise from 0 to 1 in SMIL.
    fn clock(&self, figure: &Animation, frames: &[(f64, Vec<f64>)]) -> String {
        let seconds = if figure.seconds > 0.0 && figure.seconds.is_finite() {
            figure.seconds
        } else {
            8.0
        };
        let (start, end) = (frames[0].0, frames[frames.len() - 1].0);
        let rises = end > start && frames.windows(2).all(|w| w[0].0 <= w[1].0);
        let key = |f: &(f64, Vec<f64>)| fixed((f.0 - start) / (end - start), 5);
        let keys: Vec<String> = if rises {
            frames.iter().map(key).collect()
        } else {
            Vec::new()
        };
        let keys = if keys.is_empty() {
            String::new()
        } else {
            format!(" keyTimes=\"{}\"", keys.join(";"))
        };
        format!(
            "dur=\"{}s\" repeatCount=\"indefinite\" calcMode=\"linear\"{keys}",
            fixed(seconds, 2)
        )
    }
}

fn points(line: &[Point]) -> String {
    line.iter()
        .map(|&(x, y)| format!("{},{}", grid(x), grid(y)))
        .collect::<Vec<_>>()
        .join(" ")
}
