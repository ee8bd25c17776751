//! Damage in plan and in a section.

use crate::output::damage::{DamageMap, ModeName, PlaceDamage};
use crate::output::outlines::drawn;
use fem_core::plugin::Dimension;
use fem_io::plot::{Axis, Fill, MapCell, MapPlot, Panel};

/// Most plies and interfaces of a sheet.
const SHEET: usize = 12;
/// Height of an interface in the section, in plies: it has none of its own.
const INTERFACE: f64 = 0.3;
/// Most angles beside a section.
const ANGLES: usize = 24;

/// What failed, ply by ply: the first places that did, and the two with the largest indices where none did.
///
/// A cell has the colour of its first mode, or a grey by its largest index below 1. The view is that of the damage, not
/// of the whole plate, where damage is a small part of it.
pub fn plan(title: &str, damage: &DamageMap) -> MapPlot {
    let failed = damage.places.iter().filter(|place| !place.failed.is_empty());
    let mut shown: Vec<&PlaceDamage> = failed.collect();
    shown.sort_by(|a, b| a.failed[0].2.total_cmp(&b.failed[0].2));
    let count = shown.len();
    if shown.is_empty() {
        for interface in [false, true] {
            let of_kind = damage.places.iter().filter(|place| place.ply.contains('|') == interface);
            shown.extend(of_kind.max_by(|a, b| a.largest().total_cmp(&b.largest())));
        }
    }
    shown.truncate(SHEET);
    let more = count.saturating_sub(SHEET);
    let first = if more > 0 { format!("First {SHEET} of {count} places: ") } else { String::new() };
    let near = find_view(damage);
    MapPlot {
        title: format!("{first}{title}"),
        x: Axis::linear("x", "mm"),
        y: Axis::linear("y", "mm"),
        rows: Vec::new(),
        equal_aspect: true,
        scale: Some("largest index".into()),
        classes: classes(damage),
        outlines: drawn(&damage.outlines),
        panels: shown.iter().map(|place| plan_of(damage, place, &near)).collect(),
    }
}

fn plan_of(damage: &DamageMap, place: &PlaceDamage, near: &[bool]) -> Panel {
    let heading = match place.failed.first() {
        Some(first) => format!("{}: from {}", name_place(damage, place), Dimension::TIME.of(first.2)),
        None => format!("{}: up to {:.2}", name_place(damage, place), place.largest()),
    };
    let fills = fills(place);
    let here = (0..damage.judged.len()).map(|i| damage.holds(place, i));
    let judged = damage.judged.iter().zip(fills).zip(here).filter(|((q, _), here)| *here && near[**q as usize]);
    let cell = |q: u32, fill: Fill| MapCell {
        corners: damage.outline(q).into_iter().map(|p| p.map(|v| v * 1e3)).collect(),
        fill,
    };
    Panel {
        title: heading,
        cells: judged.map(|((q, fill), _)| cell(*q, fill)).collect(),
        crosses: damage.impacts_m.iter().map(|p| p.map(|v| v * 1e3)).collect(),
        ..Panel::default()
    }
}

/// Cells of the view: those within a box round all that failed and all impacts, half as large again on every side, which
/// is at least a quarter of the plate; all where nothing failed.
fn find_view(damage: &DamageMap) -> Vec<bool> {
    let places = |q: u32| damage.outline(q).into_iter();
    let failed = damage.places.iter().flat_map(|place| &place.failed).map(|f| damage.judged[f.0 as usize]);
    let mut failed: Vec<u32> = failed.collect();
    failed.sort_unstable();
    failed.dedup();
    if failed.is_empty() {
        return vec![true; damage.quads.len()];
    }
    let bounds = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        points.fold(start, |[lo, hi], p| [[0, 1].map(|d| lo[d].min(p[d])), [0, 1].map(|d| hi[d].max(p[d]))])
    };
    let plate = bounds(&mut damage.judged.iter().flat_map(|q| places(*q)));
    let [lo, hi] = bounds(&mut failed.iter().flat_map(|q| places(*q)).chain(damage.impacts_m.iter().copied()));
    let size = |d: usize| (2.0 * (hi[d] - lo[d])).max(0.25 * (plate[1][d] - plate[0][d]));
    let half = 0.5 * size(0).max(size(1));
    let inside = |q: u32| {
        let p = damage.outline(q);
        (0..2).all(|d| {
            let centre = p.iter().map(|p| p[d]).sum::<f64>() / p.len() as f64;
            (centre - 0.5 * (lo[d] + hi[d])).abs() <= half * (1.0 + 1e-9)
        })
    };
    (0..damage.quads.len() as u32).map(inside).collect()
}

/// All plies, and the interfaces as thin bands, along x through the first impact; `None` where no judged cell is cut.
pub fn section(title: &str, damage: &DamageMap) -> Option<MapPlot> {
    let y = damage.impacts_m.first()?[1];
    let near = find_view(damage);
    let seen = damage.judged.iter().enumerate().filter(|(_, q)| near[**q as usize]);
    let cut = seen.filter_map(|(i, q)| Some((i, crossing(&damage.outline(*q), y)?)));
    let cut: Vec<(usize, [f64; 2])> = cut.collect();
    if cut.is_empty() {
        return None;
    }
    let mut panel = Panel {
        title: format!("section at y = {}, interfaces as thin bands", Dimension::LENGTH.of(y)),
        ..Panel::default()
    };
    // Interfaces last: their bands lie above the plies.
    let (interfaces, plies): (Vec<_>, Vec<_>) = damage.places.iter().partition(|place| place.ply.contains('|'));
    for place in plies.into_iter().chain(interfaces) {
        let [low, high] = heights(damage, place)?;
        let fills = fills(place);
        let band = |(i, [a, b]): &(usize, [f64; 2])| {
            let corners = [[*a, low], [*b, low], [*b, high], [*a, high]];
            MapCell { corners: corners.map(|p| p.map(|v| v * 1e3)).to_vec(), fill: fills[*i] }
        };
        panel.cells.extend(cut.iter().filter(|(i, _)| damage.holds(place, *i)).map(band));
    }
    // Angles are those under the impact.
    let struck = cut.iter().find(|(_, [a, b])| (*a..=*b).contains(&damage.impacts_m[0][0])).map(|(i, _)| *i);
    let region = struck.and_then(|i| damage.regions.get(damage.judged[i] as usize));
    let own = || damage.plies.iter().filter(|band| band.region.is_none() || band.region.as_ref() == region);
    let every = own().count().div_ceil(ANGLES).max(1);
    let note = |(k, ply): (usize, &crate::output::damage::PlyBand)| {
        (0.5e3 * (ply.z_m[0] + ply.z_m[1]), format!("{}: {}", k + 1, degrees(ply.angle_deg)))
    };
    panel.notes = own().enumerate().step_by(every).map(note).collect();
    Some(MapPlot {
        title: title.to_owned(),
        x: Axis::linear("x", "mm"),
        y: Axis::linear("z", "mm"),
        rows: Vec::new(),
        equal_aspect: false,
        scale: Some("largest index".into()),
        classes: classes(damage),
        outlines: Vec::new(),
        panels: vec![panel],
    })
}

/// From which z to which a place is drawn; `None` for one that the laminate does not have.
fn heights(damage: &DamageMap, place: &PlaceDamage) -> Option<[f64; 2]> {
    let mut numbers = place.ply.split('|').map(|k| k.parse::<usize>().ok()?.checked_sub(1));
    let lower = damage.band(place, numbers.next()??)?.z_m;
    match numbers.next() {
        None => Some(lower),
        Some(upper) => {
            let upper = damage.band(place, upper?)?.z_m;
            let half = 0.5 * INTERFACE * (lower[1] - lower[0]).min(upper[1] - upper[0]);
            Some([lower[1] - half, lower[1] + half])
        }
    }
}

/// From which x to which the line at `y` runs through a convex cell; along an edge it counts as just above it.
fn crossing(corners: &[[f64; 2]], y: f64) -> Option<[f64; 2]> {
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for (i, a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if (a[1] <= y) != (b[1] <= y) {
            let x = a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]);
            ends = [ends[0].min(x), ends[1].max(x)];
        }
    }
    (ends[0] < ends[1]).then_some(ends)
}

fn fills(place: &PlaceDamage) -> Vec<Fill> {
    let fill = |(mode, index): (Option<usize>, &f64)| mode.map_or(Fill::Share(*index), Fill::Class);
    place.first_modes().into_iter().zip(&place.index).map(fill).collect()
}

/// Modes by the names that a legend gives them: with the criterion where several judge.
fn classes(damage: &DamageMap) -> Vec<String> {
    let several = damage.modes.iter().any(|m| m.criterion != damage.modes[0].criterion);
    let name = |m: &ModeName| if several { format!("{} ({})", m.mode, m.criterion) } else { m.mode.clone() };
    damage.modes.iter().map(name).collect()
}

/// `ply 1 (45°)`, `interface 1|2`; with the region of a stepped plate `1 doubler (45°)`, `1|2 doubler`.
fn name_place(damage: &DamageMap, place: &PlaceDamage) -> String {
    let angle =
        place.ply.parse::<usize>().ok().and_then(|k| damage.band(place, k.wrapping_sub(1))).map(|ply| ply.angle_deg);
    match (angle, &place.region) {
        (Some(angle), None) => format!("ply {} ({})", place.ply, degrees(angle)),
        (None, None) => format!("interface {}", place.ply),
        // Short: a time stands beside it.
        (Some(angle), Some(region)) => format!("{} {region} ({})", place.ply, degrees(angle)),
        (None, Some(region)) => format!("{} {region}", place.ply),
    }
}

fn degrees(angle: f64) -> String {
    format!("{angle}\u{b0}").replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::output::damage::{Failed, PlyBand};
    use crate::output::outlines::PlanOutline;

    /// Four cells of 1 mm in a row, two plies and their interface; the second cell of ply 2 fails.
    fn damage() -> DamageMap {
        let points = (0..2).flat_map(|j| (0..5).map(move |i| [f64::from(i) * 1e-3, f64::from(j) * 1e-3]));
        let place = |ply: &str, index: [f64; 4], failed: Vec<Failed>| PlaceDamage {
            ply: ply.into(),
            region: None,
            index: index.to_vec(),
            failed,
        };
        DamageMap {
            format: fem_io::results::FORMAT,
            end_s: 1e-3,
            modes: ["fibre", "matrix"].map(|mode| ModeName { criterion: "c".into(), mode: mode.into() }).to_vec(),
            plies: [(0.0, [-1e-4, 0.0]), (90.0, [0.0, 1e-4])]
                .map(|(angle_deg, z_m)| PlyBand { region: None, angle_deg, z_m })
                .to_vec(),
            regions: Vec::new(),
            impacts_m: vec![[2e-3, 0.5e-3]],
            outlines: vec![PlanOutline { what: "support".into(), lines_m: vec![vec![[0.0, 0.0], [2e-3, 0.0]]] }],
            points_m: points.collect(),
            quads: (0..4).map(|i| vec![i, i + 1, i + 6, i + 5]).collect(),
            cells: vec![1, 2, 3, 4],
            judged: vec![0, 1, 2, 3],
            places: vec![
                place("1", [0.1, 0.2, 0.3, 0.4], Vec::new()),
                place("1|2", [0.5, 0.6, 0.6, 0.5], Vec::new()),
                place("2", [0.7, 1.2, 0.9, 0.8], vec![Failed(1, 1, 2e-4)]),
            ],
        }
    }

    #[test]
    fn a_sheet_shows_what_failed_and_what_came_next_to_failing() {
        let map = plan("t", &damage());
        assert_eq!(map.panels.len(), 1);
        assert_eq!(map.panels[0].title, "ply 2 (90\u{b0}): from 0.2 ms");
        let fills: Vec<_> = map.panels[0].cells.iter().map(|cell| cell.fill).collect();
        // The view is 2 mm round the middle of the failed cell and the impact, at 1.5 mm.
        assert_eq!(fills, [Fill::Share(0.7), Fill::Class(1), Fill::Share(0.9)]);
        let mut whole = damage();
        whole.places[2].failed.clear();
        let titles: Vec<_> = plan("t", &whole).panels.into_iter().map(|panel| panel.title).collect();
        assert_eq!(titles, ["ply 2 (90\u{b0}): up to 1.20", "interface 1|2: up to 0.60"]);
    }

    #[test]
    fn a_section_has_every_ply_and_the_interface_between() {
        let map = section("t", &damage()).unwrap();
        let panel = &map.panels[0];
        assert_eq!(panel.cells.len(), 9, "the cell at the right is out of view");
        let spans = |k: usize| {
            [panel.cells[k].corners[0], panel.cells[k].corners[2]].map(|p| p.map(|v| (v * 1e6).round() / 1e6))
        };
        assert_eq!(spans(0), [[0.0, -0.1], [1.0, 0.0]]);
        assert_eq!((spans(4), panel.cells[4].fill), ([[1.0, 0.0], [2.0, 0.1]], Fill::Class(1)));
        assert_eq!(spans(6), [[0.0, -0.015], [1.0, 0.015]]);
        assert_eq!(panel.notes, [(-0.05, "1: 0\u{b0}".to_owned()), (0.05, "2: 90\u{b0}".to_owned())]);
        let mut aside = damage();
        aside.impacts_m[0][1] = 2e-3;
        assert_eq!(section("t", &aside), None);
    }
}
