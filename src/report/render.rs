//! A traced picture and, beside it, what each of its rays cost.

use plotters::style::RGBAColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::Axis;
use super::bitmap::Bitmap;
use super::figure::{Figure, LEFT, Pen, WIDTH};
use super::glyphs::SUB;
use super::number::{counted, grouped};
use super::palette::{AXIS, INK, MUTED, viridis};
use super::text::{LEADING, MEDIUM, SMALL, caption_lines, fit};

/// Side of each of the two squares, and the gap between them.
const SIDE: f64 = 226.0;
const GAP: f64 = 12.0;
const TOP: f64 = 38.0;
const BOTTOM: f64 = TOP + SIDE;

/// What the figure shows.
#[derive(Clone, Debug)]
pub struct Render {
    /// Name of the scene.
    pub scene: String,
    /// The picture, as many pixels across as up.
    pub picture: Bitmap,
    /// Cost of each pixel corner, row by row from the top; 0 where there was nothing to do.
    pub costs: Vec<f64>,
    /// The cost's constants c_K, c_B, c_t.
    pub constants: [f64; 3],
    /// Kinds of rays: name, how many were cast, how many hit something.
    pub rays: Vec<(&'static str, u64, u64)>,
    /// The tree, in words.
    pub tree: String,
    /// Whether this is a quick form.
    pub quick: bool,
}

/// The figure: the picture to the left, the costs to the right with their scale.
pub fn figure(render: &Render) -> Figure {
    let [lo, hi] = ends(&render.costs);
    let scale = Axis::log(format!("cost C, {}", render.tree), lo, hi, 5);
    let caption = caption_lines(caption(render), WIDTH - 2.0 * LEFT, render.quick);
    let baseline = BOTTOM + 14.0;
    let height = baseline + LEADING * (caption.len() as f64 - 1.0) + 6.0;
    let title = format!("What a picture of {} costs", render.scene);
    Figure::draw(&title, (&caption, baseline), WIDTH, height, |pen| {
        let left = LEFT + SIDE + GAP;
        for (heading, left) in [(render.scene.as_str(), LEFT), (scale.label.as_str(), left)] {
            let at = (left, TOP - 4.0);
            let heading = fit(heading, MEDIUM, SIDE);
            pen.text(&heading, at, MEDIUM, INK, (HPos::Left, VPos::Bottom));
        }
        let square = |left: f64, bitmap| pen.picture((left, TOP), (left + SIDE, BOTTOM), bitmap);
        square(LEFT, render.picture.clone());
        square(left, heat(&render.costs, &scale));
        colour_bar(pen, left + SIDE + 8.0, &scale);
    })
}

fn caption(render: &Render) -> String {
    let [k, b, t] = render.constants;
    let kinds = render.rays.iter().map(|&(name, rays, hits)| {
        format!(
            "{}, of which {} hit",
            counted(rays, &format!("{name} ray")),
            grouped(hits)
        )
    });
    let kinds: Vec<_> = kinds.collect();
    let Bitmap { width, height, .. } = render.picture;
    format!(
        "Whitted's tracer, {width} × {height} pixels: {}. Right: C = c{SUB}K n{SUB}K + c{SUB}B n{SUB}B + c{SUB}t n{SUB}t, \
         c{SUB}K = {k}, c{SUB}B = {b}, c{SUB}t = {t}, of each ray through a pixel's corner and of all that came of it; \
         one in a thousand lies beyond either end of the scale.",
        kinds.join("; "),
    )
}

/// Where the scale begins and ends: one in a thousand of the costs above zero lies beyond either end.
fn ends(costs: &[f64]) -> [f64; 2] {
    let mut costs: Vec<f64> = costs.iter().copied().filter(|&cost| cost > 0.0).collect();
    costs.sort_unstable_by(f64::total_cmp);
    let beyond = costs.len() / 1000;
    match (costs.get(beyond), costs.iter().nth_back(beyond)) {
        (Some(&lo), Some(&hi)) => [lo, hi],
        _ => [1.0, 10.0],
    }
}

/// Share of the way along the scale; what has no cost is at its lower end.
fn share(scale: &Axis, cost: f64) -> f64 {
    let at = scale.at(cost).unwrap_or(scale.lo);
    (at - scale.lo) / (scale.hi - scale.lo)
}

fn heat(costs: &[f64], scale: &Axis) -> Bitmap {
    let side = costs.len().isqrt();
    let colour = |&cost: &f64| {
        let RGBAColor(r, g, b, _) = viridis(share(scale, cost));
        [r, g, b]
    };
    Bitmap {
        width: side,
        height: side,
        rgb: costs.iter().flat_map(colour).collect(),
    }
}

fn colour_bar(pen: &Pen, left: f64, scale: &Axis) {
    const BAR: f64 = 7.0;
    const STEPS: usize = 128;
    let colours = (0..STEPS).flat_map(|i| {
        let RGBAColor(r, g, b, _) = viridis(1.0 - (i as f64 + 0.5) / STEPS as f64);
        [r, g, b]
    });
    let bar = Bitmap {
        width: 1,
        height: STEPS,
        rgb: colours.collect(),
    };
    let right = left + BAR;
    pen.picture((left, TOP), (right, BOTTOM), bar);
    for tick in &scale.ticks {
        let y = BOTTOM - SIDE * (tick.at - scale.lo) / (scale.hi - scale.lo);
        pen.line(&[(right, y), (right + 2.0, y)], AXIS, 0.5);
        let at = (right + 3.5, y);
        pen.text(&tick.label, at, SMALL, MUTED, (HPos::Left, VPos::Center));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_leaves_out_one_in_a_thousand() {
        let mut costs: Vec<f64> = (1..=2000).map(f64::from).collect();
        costs.extend([0.0; 500]);
        assert_eq!(ends(&costs), [3.0, 1998.0]);
        assert_eq!(ends(&[0.0; 4]), [1.0, 10.0]);
    }

    #[test]
    fn colours_follow_the_cost() {
        let scale = Axis::log("", 10.0, 1000.0, 3);
        let bitmap = heat(&[10.0, 1000.0, 0.0, 1e9], &scale);
        let pixel = |i: usize| &bitmap.rgb[3 * i..3 * i + 3];
        assert_eq!((bitmap.width, bitmap.height), (2, 2));
        assert_eq!((pixel(0), pixel(1)), (pixel(2), pixel(3)));
        assert_ne!(pixel(0), pixel(1));
        assert_eq!(share(&scale, 100.0), 0.5);
    }

    #[test]
    fn the_picture_is_in_both_files() {
        let (red, side) = ([255, 0, 0], 4);
        let figure = figure(&Render {
            scene: "spd:tetra:6".into(),
            picture: Bitmap {
                width: side,
                height: side,
                rgb: red.repeat(side * side),
            },
            costs: vec![3.0; 25],
            constants: [15.0, 0.0, 20.0],
            rays: vec![("primary", 263_169, 49_949)],
            tree: "sah".into(),
            quick: false,
        });
        let svg = figure.svg();
        assert_eq!(svg.matches("<image ").count(), 3);
        let png = figure.png(72.0).expect("a figure");
        let mut reader = png::Decoder::new(std::io::Cursor::new(png))
            .read_info()
            .expect("a PNG");
        let mut bytes = vec![0; reader.output_buffer_size().expect("it fits")];
        reader.next_frame(&mut bytes).expect("pixels");
        let at = |x: usize, y: usize| &bytes[3 * (y * 518 + x)..][..3];
        assert_eq!(at(100, 150), red);
        assert_ne!(at(300, 150), red);
        assert_eq!(at(2, 150), [255; 3]);
    }
}
