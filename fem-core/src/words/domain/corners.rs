//! What a plane cell has at each of its corners.

use super::Domain;
use std::fmt::{self, Debug};
use std::hash::{Hash, Hasher};
use std::iter::Take;
use std::ops::{Deref, DerefMut};

/// One value at each corner of a plane cell, anticlockwise; reads as a slice.
///
/// ```
/// use fem_core::domain::{Corners, Domain};
///
/// let cell: Corners<u32> = [4, 7, 9].into();
/// assert_eq!((cell.domain(), cell.len(), cell[1]), (Domain::Triangle, 3, 7));
/// assert_eq!(cell.sides().collect::<Vec<_>>(), [[4, 7], [7, 9], [9, 4]]);
/// ```
#[derive(Clone, Copy)]
pub struct Corners<T> {
    /// The last is idle in a triangle.
    pub(super) of: [T; 4],
    domain: Domain,
}

impl<T> Corners<T> {
    /// Shape of the cell.
    pub fn domain(&self) -> Domain {
        self.domain
    }
}

impl<T: Copy> Corners<T> {
    /// One value made of each.
    pub fn map<U: Copy>(self, mut each: impl FnMut(T) -> U) -> Corners<U> {
        let [a, b, c, d] = self.of;
        match self.domain {
            Domain::Quadrilateral => [each(a), each(b), each(c), each(d)].into(),
            Domain::Triangle => [each(a), each(b), each(c)].into(),
        }
    }

    /// The values at both ends of each side, in the order of the corners that sides begin at.
    pub fn sides(self) -> impl ExactSizeIterator<Item = [T; 2]> {
        let n = self.len();
        (0..n).map(move |i| [self[i], self[if i + 1 == n { 0 } else { i + 1 }]])
    }

    /// One value made of both ends of each side, in the places of the corners that sides begin at.
    pub fn map_sides<U: Copy>(self, mut each: impl FnMut([T; 2]) -> U) -> Corners<U> {
        let [a, b, c, d] = self.of;
        match self.domain {
            Domain::Quadrilateral => [[a, b], [b, c], [c, d], [d, a]].map(each).into(),
            Domain::Triangle => [each([a, b]), each([b, c]), each([c, a])].into(),
        }
    }

    /// The four parts that a cell is divided into by the middles of its sides and, in a quadrilateral alone, its `centre`; the
    /// first ones have their corners in the places of the cell's own.
    pub fn quarters(self, middles: Self, centre: impl FnOnce() -> T) -> [Self; 4] {
        match self.domain {
            Domain::Quadrilateral => {
                let ([a, b, c, d], [ab, bc, cd, da], m) = (self.of, middles.of, centre());
                [[a, ab, m, da], [ab, b, bc, m], [m, bc, c, cd], [da, m, cd, d]].map(Self::from)
            }
            Domain::Triangle => {
                let ([a, b, c, _], [ab, bc, ca, _]) = (self.of, middles.of);
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]].map(Self::from)
            }
        }
    }

    /// The four corners of a quadrilateral; a triangle's last one comes twice.
    pub fn four(self) -> [T; 4] {
        match self.domain {
            Domain::Quadrilateral => self.of,
            Domain::Triangle => [self.of[0], self.of[1], self.of[2], self.of[2]],
        }
    }

    /// Corners from as many values, where there is such a cell.
    pub fn from_slice(values: &[T]) -> Option<Self> {
        match *values {
            [a, b, c] => Some([a, b, c].into()),
            [a, b, c, d] => Some([a, b, c, d].into()),
            _ => None,
        }
    }
}

impl<T> From<[T; 4]> for Corners<T> {
    fn from(of: [T; 4]) -> Self {
        Self { of, domain: Domain::Quadrilateral }
    }
}

impl<T: Copy> From<[T; 3]> for Corners<T> {
    fn from([a, b, c]: [T; 3]) -> Self {
        Self { of: [a, b, c, c], domain: Domain::Triangle }
    }
}

impl<T> Deref for Corners<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.of[..self.domain.corners().len()]
    }
}

impl<T> DerefMut for Corners<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.of[..self.domain.corners().len()]
    }
}

impl<T> IntoIterator for Corners<T> {
    type Item = T;
    type IntoIter = Take<std::array::IntoIter<T, 4>>;
    fn into_iter(self) -> Self::IntoIter {
        let n = self.len();
        self.of.into_iter().take(n)
    }
}

impl<'a, T> IntoIterator for &'a Corners<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<T: Debug> Debug for Corners<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

impl<T: PartialEq> PartialEq for Corners<T> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T: Eq> Eq for Corners<T> {}

impl<T: Hash> Hash for Corners<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (**self).hash(state);
    }
}
