//! The labels of the marks.

use super::Mark;
use super::layout::{ROW, SMALL, WIDTH};
use super::words::{estimate_width, shorten};

/// Where a mark's label stands: in a row counted from the curves upwards, to the right or the left of its line.
pub(super) struct Flag {
    pub(super) x: f64,
    pub(super) row: usize,
    pub(super) to_left: bool,
    pub(super) text: String,
    width: f64,
}

/// Gap between a mark's line and its label.
pub(super) const GAP: f64 = 10.0;

impl Flag {
    /// From where to where the label with its gaps reaches.
    pub(super) fn span(&self) -> [f64; 2] {
        if self.to_left { [self.x - self.width, self.x] } else { [self.x, self.x + self.width] }
    }

    fn overlaps(&self, other: &Self) -> bool {
        let (a, b) = (self.span(), other.span());
        a[0] <= b[1] && b[0] <= a[1]
    }

    /// Baseline of the label above an area whose upper edge is `top`.
    pub(super) fn baseline(&self, top: f64) -> f64 {
        top - 16.0 - self.row as f64 * ROW
    }

    /// Whether the label stands across the line of `other`.
    fn covers(&self, other: &Self) -> bool {
        let [from, to] = self.span();
        from < other.x && other.x < to
    }
}

/// Labels beside their lines, in rows such that no label meets another one, or another mark's line where that can be
/// avoided: two lines that are close can each run under the other's label.
///
/// A label stands to the right of its line, to the left where it would leave the picture or run into such a pair.
pub(super) fn flags(marks: &[Mark], place: impl Fn(&Mark) -> f64, left: f64, right: f64) -> Vec<Flag> {
    let flag = |mark: &Mark| {
        let text = shorten(&mark.label, SMALL, 0.45 * (right - left));
        Flag { x: place(mark), row: 0, to_left: false, width: 2.0 * GAP + estimate_width(&text, SMALL), text }
    };
    let mut flags: Vec<Flag> = marks.iter().map(flag).collect();
    let mut waiting: Vec<usize> = (0..flags.len()).collect();
    waiting.sort_by(|&a, &b| flags[b].x.total_cmp(&flags[a].x));

    for (n, &i) in waiting.iter().enumerate() {
        let flag = &flags[i];
        let crossed = |&j: &usize| flag.covers(&flags[j]) && flags[j].covers(flag);
        let turn = flag.span()[1] > WIDTH || flag.x > flag.width && waiting[..n].iter().any(crossed);
        flags[i].to_left = turn;
    }

    // A label that stands across a line goes above that line's own label, hence after it.
    let mut placed: Vec<usize> = Vec::new();
    while !waiting.is_empty() {
        let free = |&i: &usize| !waiting.iter().any(|&j| flags[i].covers(&flags[j]));
        let i = waiting.remove(waiting.iter().position(free).unwrap_or(0));
        let below = placed.iter().map(|&j| &flags[j]).filter(|other| other.overlaps(&flags[i]));
        flags[i].row = below.map(|other| other.row + 1).max().unwrap_or(0);
        placed.push(i);
    }
    flags
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LEFT: f64 = 150.0;
    const RIGHT: f64 = 1540.0;

    fn at(places: &[(f64, &str)]) -> Vec<Flag> {
        let marks: Vec<_> = places.iter().map(|(x, name)| Mark { x: *x, y: 0.0, label: (*name).to_owned() }).collect();
        flags(&marks, |m| m.x, LEFT, RIGHT)
    }

    fn rows(places: &[(f64, &str)]) -> Vec<(usize, bool)> {
        at(places).iter().map(|f| (f.row, f.to_left)).collect()
    }

    #[test]
    fn labels_far_apart_share_a_row() {
        assert_eq!(rows(&[(200.0, "first"), (900.0, "second")]), [(0, false), (0, false)]);
    }

    #[test]
    fn near_labels_step_down_to_the_right_so_that_no_line_crosses_a_label() {
        let stairs = rows(&[(220.0, "matrix tension"), (200.0, "matrix tension"), (240.0, "matrix tension")]);
        assert_eq!(stairs, [(1, false), (2, false), (0, false)]);
    }

    #[test]
    fn labels_at_the_right_edge_turn_left() {
        assert_eq!(rows(&[(1500.0, "matrix tension"), (1540.0, "shear")]), [(0, true), (1, true)]);
    }

    #[test]
    fn a_label_turns_left_where_two_lines_would_run_under_each_others_labels() {
        assert_eq!(rows(&[(1300.0, "matrix tension"), (1450.0, "matrix tension")]), [(0, true), (1, true)]);
    }

    proptest! {
        #[test]
        fn labels_stay_in_the_picture_and_apart(
            places in proptest::collection::vec((LEFT..=RIGHT, "[a-z ]{0,60}"), 0..40)
        ) {
            let places: Vec<_> = places.iter().map(|(x, name)| (*x, name.as_str())).collect();
            let flags = at(&places);
            for (i, a) in flags.iter().enumerate() {
                let [from, to] = a.span();
                prop_assert!(0.0 <= from && to <= WIDTH, "{from} {to}");
                for b in &flags[..i] {
                    prop_assert!(a.row != b.row || !a.overlaps(b), "{:?} {:?}", a.span(), b.span());
                }
            }
        }
    }
}
