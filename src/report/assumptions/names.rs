//! Sets of rays in words, and which assumptions each breaks.

use crate::study::records::BiasRecord;

/// A set of rays in plain words.
pub fn words(set: &str) -> String {
    let (source, ask) = set.split_once(':').unwrap_or((set, ""));
    let source = match source {
        "lines" => "uniform lines",
        "disc" => "uniform lines, by discs",
        "sphere-points" => "uniform lines, by sphere points",
        "beam" => "parallel beam",
        "eye" => "from a point outside",
        "uniform-hemisphere" => "box surface, uniform directions",
        "sphere-hemisphere" => "sphere, uniform directions",
        "box-chord" => "through two points of faces",
        "sphere-to-volume" => "from a sphere to points inside",
        "volume-line" => "lines through a point inside",
        "volume-chord" => "lines through two points inside",
        "axes-only" => "along the axes only",
        "volume-ray" => "rays from inside",
        "volume-segment" => "segments inside",
        "objects" => "from the objects",
        "primary" => "picture: eye rays",
        "shadow" => "picture: shadow rays",
        "secondary" => "picture: secondary rays",
        other => other,
    };
    match ask {
        "" => source.to_owned(),
        ask => format!("{source}, {ask} hit"),
    }
}

/// Which assumptions a set of rays breaks: over all trees, as which rays begin inside and are stopped hangs on the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Broken {
    /// Lines uniform in origin and direction: broken by all rays or none.
    pub uniform: bool,
    /// Least and largest share of the rays that begin inside.
    pub inside: [f64; 2],
    /// Least and largest share that an object stops.
    pub stopped: [f64; 2],
}

/// What the columns of [`Broken::marks`] are called.
pub const BROKEN: [&str; 3] = ["not uniform", "begin inside", "stopped"];

impl Broken {
    /// Of a set, from its rows in all trees.
    pub fn of(bias: &[BiasRecord], set: &str) -> Self {
        let own = || bias.iter().filter(|row| row.rays == set);
        let range = |share: fn(&BiasRecord) -> f64| {
            let all = || own().map(share);
            [all().fold(1.0, f64::min), all().fold(0.0, f64::max)]
        };
        Broken {
            uniform: own().any(|row| !row.uniform),
            inside: range(|row| row.inside),
            stopped: range(|row| row.stopped),
        }
    }

    /// Whether each assumption is broken by any ray.
    pub fn marks(&self) -> [bool; 3] {
        [self.uniform, self.inside[1] > 0.0, self.stopped[1] > 0.0]
    }

    /// What is broken, in words.
    pub fn words(&self) -> String {
        let marks = self.marks().into_iter().zip(BROKEN);
        let broken: Vec<&str> = marks.filter_map(|(is, name)| is.then_some(name)).collect();
        if broken.is_empty() {
            return "every assumption holds".to_owned();
        }
        broken.join(" + ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_told_in_words() {
        assert_eq!(words("lines:nearest"), "uniform lines, nearest hit");
        assert_eq!(words("shadow"), "picture: shadow rays");
        assert_eq!(words("stretched:any"), "stretched, any hit");
    }
}
