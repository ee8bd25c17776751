//! Turns of axes that are meant to be the same.

use std::f64::consts::FRAC_PI_2;

/// Turns that differ by less than this are one, radians: far above the rounding of an angle that was computed in another way,
/// far below what a plate is made to.
const SAME_TURN: f64 = 1e-7;

/// The turns of the axes of a scene, in the order in which they come.
///
/// Two supports of a node in all but the same axes would hold it in both directions, and a support that is all but the mirror
/// image of another is none: so that both see one turn, whatever is within rounding of an earlier one, of its mirror images and
/// of quarter turns of either becomes that.
#[derive(Debug, Clone, Default)]
pub struct Turns(Vec<f64>);

impl Turns {
    /// What stands for `angle`, radians, from now on.
    pub fn settle(&mut self, angle: f64) -> f64 {
        let known = std::iter::once(0.0).chain(self.0.iter().copied());
        let mut images = known.flat_map(|turn| [turn, -turn]).map(|turn| {
            let quarters = ((angle - turn) / FRAC_PI_2).round();
            turn + quarters * FRAC_PI_2
        });
        if let Some(same) = images.find(|image| (angle - image).abs() <= SAME_TURN) {
            return same;
        }
        self.0.push(angle);
        angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_within_rounding_are_one() {
        let mut turns = Turns::default();
        let thirty = 30.0_f64.to_radians();
        assert_eq!(turns.settle(1e-9), 0.0);
        assert_eq!(turns.settle(-FRAC_PI_2 + 5e-8), -FRAC_PI_2);
        assert_eq!(turns.settle(thirty), thirty);
        for off in [0.0, 1e-15, 1e-10, -5e-8, 9e-8] {
            assert_eq!(turns.settle(thirty + off), thirty);
            assert_eq!(turns.settle(-thirty + off), -thirty);
            assert!((turns.settle(5.0 * thirty + off) - 5.0 * thirty).abs() < 1e-15);
            assert!((turns.settle(-2.0 * thirty + off) + 2.0 * thirty).abs() < 1e-15);
        }
        for off in [2e-7, 1e-3] {
            assert_eq!(turns.settle(thirty + off), thirty + off);
        }
    }
}
