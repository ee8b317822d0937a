//! What Vlastimil Havran found, read from `data/reference/`.

use std::sync::LazyLock;

use serde::Deserialize;
use serde::de::DeserializeOwned;

const STRATEGIES: &str = include_str!("../../../data/reference/havran2000-strategies.csv");
const RAYS: &str = include_str!("../../../data/reference/havran1999-rays.csv");
const FACTS: &str = include_str!("../../../data/reference/spd-facts.csv");

/// Our names of his strategies 1 to 5.
pub const NAMES: [&str; 5] = [
    "spatial-median",
    "object-median",
    "sah",
    "sah-between-medians",
    "sah-cyclic",
];

/// Eye rays of a full picture of the databases: 513 x 513.
pub const EYE_RAYS: u64 = 513 * 513;

/// Scenes of his table of strategies.
pub const SCENES: u64 = 30;

/// The group of scenes (about ten thousand objects) whose rays he counted in 1999.
const COUNTED_GROUP: &str = "G4";

/// One row of his table of strategies: total run time with building, in per cent above strategy 3's, over 30 scenes.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Row {
    /// His number of the strategy.
    pub strategy: usize,
    /// Arithmetic mean.
    pub avg_percent: f64,
    /// Least.
    pub best_percent: f64,
    /// Largest.
    pub worst_percent: f64,
}

/// Rays of a whole picture (1999), as far as he tells.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Rays {
    /// Name of the scene without its size.
    pub scene: String,
    /// Eye rays that hit something.
    pub primary_hits: Option<u64>,
    /// Rays towards lights.
    pub shadow_rays: Option<u64>,
    /// Those of them that are blocked.
    pub shadow_hits: Option<u64>,
    /// Reflected and refracted rays.
    pub secondary_rays: Option<u64>,
    /// Rays of every kind.
    pub all_rays: Option<u64>,
}

#[derive(Deserialize)]
struct Fact {
    scene: String,
    size: String,
    group: String,
}

static TABLE: LazyLock<Vec<Row>> = LazyLock::new(|| rows(STRATEGIES));
static COUNTS: LazyLock<Vec<Rays>> = LazyLock::new(|| rows(RAYS));
static GROUPS: LazyLock<Vec<Fact>> = LazyLock::new(|| rows(FACTS));

fn rows<T: DeserializeOwned>(text: &str) -> Vec<T> {
    let rows = csv::Reader::from_reader(text.as_bytes()).into_deserialize();
    rows.map(|row| row.expect("the embedded file is well formed"))
        .collect()
}

/// His number of one of our strategies.
pub fn number(strategy: &str) -> Option<usize> {
    let place = NAMES.iter().position(|&name| name == strategy)?;
    Some(place + 1)
}

/// His row for one of our strategies.
pub fn row(strategy: &str) -> Option<Row> {
    let number = number(strategy)?;
    TABLE.iter().copied().find(|row| row.strategy == number)
}

/// His group of a scene of the databases: `G3`, `G4` or `G5`, of about 10^3, 10^4, 10^5 objects.
pub fn group(scene: &str) -> Option<&'static str> {
    let (name, size) = name_and_size(scene)?;
    let mut facts = GROUPS.iter().filter(|fact| !fact.group.is_empty());
    let fact = facts.find(|fact| fact.scene == name && fact.size == size)?;
    Some(&fact.group)
}

/// His counts of 1999 for a scene, if it has the size he took.
pub fn rays(scene: &str) -> Option<&'static Rays> {
    let (name, _) = name_and_size(scene)?;
    let counted = || COUNTS.iter().find(|rays| rays.scene == name);
    (group(scene) == Some(COUNTED_GROUP)).then(counted)?
}

fn name_and_size(scene: &str) -> Option<(&str, &str)> {
    scene.strip_prefix("spd:")?.split_once(':')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_embedded_files_are_read() {
        assert_eq!(TABLE.len(), 5);
        let worst = |name| row(name).map(|row| row.worst_percent);
        assert_eq!(worst("spatial-median"), Some(36604.0));
        assert_eq!(worst("sah-cyclic"), Some(88.0));
        assert_eq!(worst("sah-samples"), None);
        assert_eq!(group("spd:tree:15"), Some("G5"));
        assert_eq!(group("spd:tree:14"), None);
        assert_eq!(group("simple:soup:2000"), None);
    }

    #[test]
    fn rays_are_those_of_his_size() {
        let gears = rays("spd:gears:4").unwrap();
        assert_eq!(
            (gears.shadow_rays, gears.primary_hits),
            (Some(2_088_012), Some(245_332))
        );
        assert_eq!(rays("spd:gears:9"), None);
        assert_eq!(rays("spd:jacks:4"), None, "he gives no counts of it");
        assert_eq!(COUNTS.len(), 8);
    }
}
