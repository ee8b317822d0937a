//! Colours and marks: the Okabe-Ito palette with a marker shape per series, viridis for densities.

use plotters::style::RGBAColor;

use super::figure::Pen;

/// The page.
pub const WHITE: RGBAColor = rgb(0xff, 0xff, 0xff);
/// Text and the theory's line.
pub const INK: RGBAColor = rgb(0x22, 0x22, 0x22);
/// Second-rank text.
pub const MUTED: RGBAColor = rgb(0x59, 0x59, 0x59);
/// Grid lines.
pub const GRID: RGBAColor = rgb(0xe4, 0xe4, 0xe4);
/// Axis lines and ticks.
pub const AXIS: RGBAColor = rgb(0x8c, 0x8c, 0x8c);
/// Okabe-Ito blue.
pub const BLUE: RGBAColor = rgb(0x00, 0x72, 0xb2);
/// Okabe-Ito vermillion.
pub const VERMILLION: RGBAColor = rgb(0xd5, 0x5e, 0x00);
/// Okabe-Ito sky blue.
pub const SKY: RGBAColor = rgb(0x56, 0xb4, 0xe9);
/// Okabe-Ito bluish green.
pub const GREEN: RGBAColor = rgb(0x00, 0x9e, 0x73);

/// Okabe-Ito without its yellow, which is too faint for marks on white.
const SERIES: [RGBAColor; 7] = [
    BLUE,
    VERMILLION,
    GREEN,
    rgb(0xe6, 0x9f, 0x00),
    rgb(0xcc, 0x79, 0xa7),
    SKY,
    rgb(0x00, 0x00, 0x00),
];

const fn rgb(r: u8, g: u8, b: u8) -> RGBAColor {
    RGBAColor(r, g, b, 1.0)
}

/// The colour, seen through.
pub const fn faded(RGBAColor(r, g, b, _): RGBAColor, alpha: f64) -> RGBAColor {
    RGBAColor(r, g, b, alpha)
}

/// Shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Marker {
    /// A disc.
    Disc,
    /// A square.
    Square,
    /// A triangle that points up.
    Up,
    /// A diamond.
    Diamond,
    /// A triangle that points down.
    Down,
}

impl Marker {
    /// Draws the mark; all shapes of a radius have about the area of the disc.
    pub fn draw(self, pen: &Pen, (x, y): (f64, f64), radius: f64, colour: RGBAColor) {
        let corners: &[(f64, f64)] = match self {
            Marker::Disc => return pen.disc((x, y), radius, colour),
            Marker::Square => &[(-0.89, -0.89), (0.89, -0.89), (0.89, 0.89), (-0.89, 0.89)],
            Marker::Up => &[(0.0, -1.45), (1.26, 0.73), (-1.26, 0.73)],
            Marker::Diamond => &[(0.0, -1.32), (1.2, 0.0), (0.0, 1.32), (-1.2, 0.0)],
            Marker::Down => &[(0.0, 1.45), (1.26, -0.73), (-1.26, -0.73)],
        };
        let corners: Vec<_> = corners
            .iter()
            .map(|(u, v)| (x + radius * u, y + radius * v))
            .collect();
        pen.polygon(&corners, colour);
    }

    /// Draws the outline of the mark, its inside white.
    pub fn ring(self, pen: &Pen, at: (f64, f64), radius: f64, colour: RGBAColor) {
        self.draw(pen, at, radius, WHITE);
        self.draw(pen, at, radius, colour);
        self.draw(pen, at, 0.55 * radius, WHITE);
    }
}

/// Look of one series: 35 pairs of colour and shape, of which neighbours differ in both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Its colour.
    pub colour: RGBAColor,
    /// Its shape.
    pub marker: Marker,
}

impl Look {
    /// The look of the `i`-th series.
    pub fn of(i: usize) -> Self {
        const MARKERS: [Marker; 5] = [
            Marker::Disc,
            Marker::Square,
            Marker::Up,
            Marker::Diamond,
            Marker::Down,
        ];
        Look {
            colour: SERIES[i % SERIES.len()],
            // The second round of shapes begins one further on: a blue disc and a sky blue one look alike.
            marker: MARKERS[(i + i / MARKERS.len()) % MARKERS.len()],
        }
    }
}

/// viridis at a share from 0 (dark blue) to 1 (yellow).
pub fn viridis(share: f64) -> RGBAColor {
    const STOPS: [[u8; 3]; 9] = [
        [68, 1, 84],
        [71, 44, 122],
        [59, 81, 139],
        [44, 113, 142],
        [33, 144, 141],
        [39, 173, 129],
        [92, 200, 99],
        [170, 220, 50],
        [253, 231, 37],
    ];
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let i = (place as usize).min(STOPS.len() - 2);
    let t = place - i as f64;
    let mix = |c: usize| {
        (f64::from(STOPS[i][c]) * (1.0 - t) + f64::from(STOPS[i + 1][c]) * t).round() as u8
    };
    rgb(mix(0), mix(1), mix(2))
}
