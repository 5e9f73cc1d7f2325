//! Self-animating SVG of the beam moving between its obstacles.

use convergence_study::internal::plots::{
    Scale,
    canvas::{Anchor, Canvas, Layer, Pen, Point, Rect, grid},
    look::look,
    ruler::{Ruler, fixed, on_scale},
    style::{self, LABEL_SIZE, TICK_SIZE, TITLE_SIZE, elide},
};

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

/// The displacement at the points to draw, at one time.
struct Frame {
    t: f64,
    u: Vec<f64>,
}

impl Frame {
    /// The largest absolute displacement.
    fn deflection(&self) -> f64 {
        self.u.iter().fold(0.0, |most: f64, u| most.max(u.abs()))
    }
}

/// The frames to draw: thinned, without incomplete ones.
fn drawable_frames(figure: &Animation) -> Vec<Frame> {
    let Frames {
        times,
        points: nodes,
        u: displacements,
    } = &figure.frames;
    let mut complete = vec![];
    for (&t, u) in times.iter().zip(displacements) {
        let is_drawable = u.iter().all(|&u| on_scale(Scale::Linear, u).is_some());
        if t.is_finite() && u.len() == nodes.len() && is_drawable {
            complete.push((t, u));
        }
    }
    let points = thinned(nodes.len(), MOST_POINTS);
    let mut frames = vec![];
    for n in thinned(complete.len(), MOST_FRAMES) {
        let (t, u) = complete[n];
        frames.push(Frame {
            t,
            u: points.iter().map(|&i| u[i]).collect(),
        });
    }
    frames
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
    fn new(figure: &Animation, frames: &[Frame]) -> Self {
        let displacements = frames.iter().flat_map(|frame| frame.u.iter().copied());
        let obstacles = figure.obstacles.into_iter().flat_map(|(g1, g2)| [g1, g2]);
        let u = Ruler::around(
            Scale::Linear,
            displacements.chain(obstacles).chain([0.0]),
            0.12,
        );
        let points = &figure.frames.points;
        let x = Ruler::around(Scale::Linear, points.iter().copied(), 0.0);
        let t = Ruler::around(Scale::Linear, frames.iter().map(|frame| frame.t), 0.0);
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
            e => format!(
                " / {}",
                convergence_study::internal::plots::ruler::power_of_ten(e)
            ),
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
    fn moving_parts(&self, figure: &Animation, frames: &[Frame]) -> String {
        // The first of several frames with the same deflection.
        let most = frames
            .iter()
            .enumerate()
            .rev()
            .max_by(|a, b| a.1.deflection().total_cmp(&b.1.deflection()));
        let Some((still, frame)) = most else {
            return String::new();
        };
        let blue = look(0).colour;
        let colour = format!("#{:02x}{:02x}{:02x}", blue.0, blue.1, blue.2);
        let clock = self.clock(figure, frames);
        let shapes: Vec<String> = frames
            .iter()
            .map(|frame| points(&self.beam(frame)))
            .collect();
        let heights = value_list(frames.iter().map(|frame| self.tip(frame).1));
        let marks = value_list(frames.iter().map(|frame| self.t.px_of(frame.t)));
        let (beam, beams) = (&shapes[still], shapes.join(";"));
        let (tip_x, tip_y) = self.tip(frame);
        let [tip_x, tip_y, mark_x, mark_y] =
            [tip_x, tip_y, self.t.px_of(frame.t), TIME_BAR].map(grid);
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

    /// The line of the beam in a frame.
    fn beam(&self, frame: &Frame) -> Vec<Point> {
        let mut line = vec![];
        for (&x, &u) in self.nodes.iter().zip(&frame.u) {
            line.push((self.x.px(x).unwrap_or(PLOT.left), self.u.px_of(u)));
        }
        line
    }

    /// The free end of the beam in a frame.
    fn tip(&self, frame: &Frame) -> Point {
        let end = self.beam(frame).last().copied();
        end.unwrap_or((PLOT.left, PLOT.bottom))
    }

    /// Duration and key times, which must rise from 0 to 1 in SMIL.
    fn clock(&self, figure: &Animation, frames: &[Frame]) -> String {
        let seconds = if figure.seconds > 0.0 && figure.seconds.is_finite() {
            figure.seconds
        } else {
            8.0
        };
        let (start, end) = (frames[0].t, frames[frames.len() - 1].t);
        let rises = end > start && frames.windows(2).all(|pair| pair[0].t <= pair[1].t);
        let mut keys = vec![];
        if rises {
            for frame in frames {
                keys.push(fixed((frame.t - start) / (end - start), 5));
            }
        }
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

/// Coordinates as the values of an animation.
fn value_list(values: impl Iterator<Item = f64>) -> String {
    values
        .map(|value| grid(value).to_string())
        .collect::<Vec<_>>()
        .join(";")
}

fn points(line: &[Point]) -> String {
    line.iter()
        .map(|&(x, y)| format!("{},{}", grid(x), grid(y)))
        .collect::<Vec<_>>()
        .join(" ")
}
