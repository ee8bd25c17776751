//! Materials: orthotropic elasticity with its validity checks, density, strengths.

use crate::words::tensor::Matrix6;
use std::fmt;

/// Elastic constants of an orthotropic solid in its own axes; Pa and dimensionless.
///
/// `nu_ij` is the strain along j per strain along i under stress along i, so `nu12/e1 = nu21/e2`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs)]
pub struct Elastic {
    pub e1: f64,
    pub e2: f64,
    pub e3: f64,
    pub nu12: f64,
    pub nu13: f64,
    pub nu23: f64,
    pub g12: f64,
    pub g13: f64,
    pub g23: f64,
}

/// Why a set of constants is refused.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialError {
    /// Name of the material.
    pub material: String,
    /// The inequality or constant that offends, with its numbers.
    pub why: String,
}

impl fmt::Display for MaterialError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "material `{}`: {}", self.material, self.why)
    }
}
impl std::error::Error for MaterialError {}

/// Why no solid has a set of elastic constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ElasticError {
    /// A modulus that is not positive, or not finite.
    Modulus {
        /// Its name.
        name: &'static str,
        /// What was given, Pa.
        value: f64,
    },
    /// |νij| < √(Ei/Ej) does not hold.
    Ratio {
        /// Its axes i and j.
        axes: [u8; 2],
        /// What was given.
        value: f64,
        /// √(Ei/Ej).
        bound: f64,
    },
    /// 1 − ν12 ν21 − ν23 ν32 − ν31 ν13 − 2 ν21 ν32 ν13 is not positive.
    Determinant(f64),
}

impl fmt::Display for ElasticError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Modulus { name, value } => write!(f, "{name} must be positive and finite, got {value}"),
            Self::Ratio { axes: [i, j], value, bound } => write!(
                f,
                "|nu{i}{j}| < sqrt(E{i}/E{j}) = {bound:.6} is required for a positive definite stiffness, got nu{i}{j} = \
                 {value}"
            ),
            Self::Determinant(value) => write!(
                f,
                "1 - nu12 nu21 - nu23 nu32 - nu31 nu13 - 2 nu21 nu32 nu13 > 0 is required for a positive definite \
                 stiffness, got {value:.6}"
            ),
        }
    }
}
impl std::error::Error for ElasticError {}

impl Elastic {
    /// Fibres along 1, isotropic in the 2-3 plane: G23 = E2 / (2 (1 + ν23)), E3 = E2, ν13 = ν12, G13 = G12.
    pub fn transversely_isotropic(e1: f64, e2: f64, nu12: f64, nu23: f64, g12: f64) -> Self {
        let g23 = e2 / (2.0 * (1.0 + nu23));
        Self { e1, e2, e3: e2, nu12, nu13: nu12, nu23, g12, g13: g12, g23 }
    }

    /// Isotropic: G = E / (2 (1 + ν)).
    pub fn isotropic(e: f64, nu: f64) -> Self {
        Self::transversely_isotropic(e, e, nu, nu, e / (2.0 * (1.0 + nu)))
    }

    /// Compliance S in the material's axes, ε = S σ.
    pub fn compliance(&self) -> Matrix6 {
        let mut s = [[0.0; 6]; 6];
        let e = [self.e1, self.e2, self.e3];
        for i in 0..3 {
            s[i][i] = 1.0 / e[i];
        }
        for (i, j, nu) in [(0, 1, self.nu12), (0, 2, self.nu13), (1, 2, self.nu23)] {
            s[i][j] = -nu / e[i];
            s[j][i] = s[i][j];
        }
        s[3][3] = 1.0 / self.g12;
        s[4][4] = 1.0 / self.g23;
        s[5][5] = 1.0 / self.g13;
        s
    }

    /// Stiffness C = S⁻¹ in the material's axes.
    ///
    /// Meaningful only for constants that pass [`Elastic::check`].
    pub fn stiffness(&self) -> Matrix6 {
        let s = self.compliance();
        let normal = nalgebra::Matrix3::from_fn(|i, j| s[i][j]);
        let inverse = normal.try_inverse().unwrap_or_else(|| nalgebra::Matrix3::repeat(f64::NAN));
        let mut c = [[0.0; 6]; 6];
        for i in 0..3 {
            for j in 0..3 {
                c[i][j] = 0.5 * (inverse[(i, j)] + inverse[(j, i)]);
            }
        }
        c[3][3] = self.g12;
        c[4][4] = self.g23;
        c[5][5] = self.g13;
        c
    }

    /// Stiffness 11 22 12 in the material's axes with σ33 = 0.
    pub fn plane_stiffness(&self) -> nalgebra::Matrix3<f64> {
        const PLANE: [usize; 3] = [0, 1, 3];
        let c = self.stiffness();
        nalgebra::Matrix3::from_fn(|i, j| {
            let (i, j) = (PLANE[i], PLANE[j]);
            c[i][j] - c[i][2] * c[2][j] / c[2][2]
        })
    }

    /// Positive definiteness of the stiffness, one named inequality at a time.
    ///
    /// # Errors
    /// The first inequality that fails, with its numbers.
    pub fn check(&self) -> Result<(), ElasticError> {
        for (name, value) in
            [("E1", self.e1), ("E2", self.e2), ("E3", self.e3), ("G12", self.g12), ("G13", self.g13), ("G23", self.g23)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ElasticError::Modulus { name, value });
            }
        }
        for (value, ei, ej, axes) in [
            (self.nu12, self.e1, self.e2, [1, 2]),
            (self.nu13, self.e1, self.e3, [1, 3]),
            (self.nu23, self.e2, self.e3, [2, 3]),
        ] {
            let bound = (ei / ej).sqrt();
            if !(value.abs() < bound) {
                return Err(ElasticError::Ratio { axes, value, bound });
            }
        }
        let (nu21, nu31, nu32) =
            (self.nu12 * self.e2 / self.e1, self.nu13 * self.e3 / self.e1, self.nu23 * self.e3 / self.e2);
        let determinant = 1.0 - self.nu12 * nu21 - self.nu23 * nu32 - self.nu13 * nu31 - 2.0 * nu21 * nu32 * self.nu13;
        if !(determinant > 0.0) {
            return Err(ElasticError::Determinant(determinant));
        }
        Ok(())
    }
}

macro_rules! constants {
    ($(#[$what:meta])* $one:ident of $all:ident: $($(#[$doc:meta])* $variant:ident $get:ident $name:literal),+ $(,)?) => {
        $(#[$what])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum $one { $($(#[$doc])* $variant),+ }

        impl $one {
            /// All of them, in the order of their declaration.
            pub const ALL: &'static [$one] = &[$($one::$variant),+];
            /// The key that scenes and tables use.
            pub const fn name(self) -> &'static str {
                match self { $($one::$variant => $name),+ }
            }
        }

        impl $all {
            $($(#[$doc])* #[inline] pub const fn $get(&self) -> f64 { self.0[$one::$variant as usize] })+
        }

        impl Default for $all {
            fn default() -> Self {
                Self([f64::NAN; $one::ALL.len()])
            }
        }

        impl $all {
            /// The same with one constant given, SI.
            #[must_use]
            pub fn with(mut self, which: $one, value: f64) -> Self {
                self.0[which as usize] = value;
                self
            }

            /// The constant, if it was given.
            pub fn get(&self, which: $one) -> Option<f64> {
                Some(self.0[which as usize]).filter(|v| !v.is_nan())
            }
        }
    };
}

constants! {
    /// A strength that a criterion or a law may require of a material.
    Strength of Strengths:
    /// Tension along the fibres, s1T.
    Xt xt "Xt",
    /// Compression along the fibres (positive number), s1C.
    Xc xc "Xc",
    /// Tension across the fibres, s2T.
    Yt yt "Yt",
    /// Compression across the fibres (positive number), s2C.
    Yc yc "Yc",
    /// Shear along the fibres, s12 = s13.
    S12 s12 "S12",
    /// Shear across the fibres, s23.
    S23 s23 "S23",
    /// Tension through the thickness, of an interface.
    Zt zt "Zt",
    /// Compression through the thickness (positive number), of an interface.
    Zc zc "Zc",
    /// Interlaminar shear in the 3-1 plane, of an interface; its 2-3 plane has S23.
    S13 s13 "S13",
}

/// Strengths of a material in Pa; a constant that nobody gave is NaN and never enters a computation, because
/// criteria declare what they need and are refused without it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strengths([f64; Strength::ALL.len()]);

constants! {
    /// An energy per new crack area that a law may require of a material.
    Toughness of Toughnesses:
    /// An interface that opens, mode I.
    GIc gic "GIc",
    /// An interface that is sheared, mode II.
    GIIc giic "GIIc",
    /// Fibres that break in tension.
    Gft gft "Gft",
    /// Fibres that kink in compression.
    Gfc gfc "Gfc",
    /// A crack along the fibres that opens.
    Gmt gmt "Gmt",
    /// Compression across the fibres.
    Gmc gmc "Gmc",
    /// A crack along the fibres that is sheared.
    Gms gms "Gms",
}

/// Toughnesses of a material in J/m²; one that nobody gave is NaN, as a strength is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Toughnesses([f64; Toughness::ALL.len()]);

/// A material: elasticity, density, strengths. SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name by which layups and errors refer to it.
    pub name: String,
    /// Elastic constants in the material's axes.
    pub elastic: Elastic,
    /// Density, kg/m³, if it was given: criteria do without, a plate that moves does not ([`Material::mass_density`]).
    pub density: Option<f64>,
    /// Strengths, Pa.
    pub strengths: Strengths,
    /// Toughnesses, J/m².
    pub toughness: Toughnesses,
    /// Exponent of Benzeggagh and Kenane's toughness of an interface under a mixed mode, if it was given.
    pub eta: Option<f64>,
    /// Thermal expansion along 1, 2, 3, 1/K, if it was given.
    pub expansion: Option<[f64; 3]>,
}

impl Material {
    /// Refuses constants that no solid can have.
    ///
    /// # Errors
    /// Names the constant or the inequality with its numbers.
    pub fn check(&self) -> Result<(), MaterialError> {
        let refuse = |why: String| Err(MaterialError { material: self.name.clone(), why });
        if let Err(why) = self.elastic.check() {
            return refuse(why.to_string());
        }
        let toughnesses = Toughness::ALL.iter().map(|&t| (t.name(), self.toughness.get(t), "J/m2"));
        for (name, given, unit) in toughnesses.chain([("density", self.density, "kg/m3")]) {
            if let Some(v) = given.filter(|v| !(*v > 0.0 && v.is_finite())) {
                return refuse(format!("{name} must be positive and finite, got {v} {unit}"));
            }
        }
        // Below 1 the toughness of a mixed mode rises at once from that of mode I, with a slope that has no bound.
        if let Some(v) = self.eta.filter(|v| !(*v >= 1.0 && v.is_finite())) {
            return refuse(format!("eta, Benzeggagh and Kenane's exponent, must be finite and at least 1, got {v}"));
        }
        if let Some(v) = self.expansion.iter().flatten().find(|v| !v.is_finite()) {
            return refuse(format!("thermal expansion must be finite, got {v} 1/K"));
        }
        for &s in Strength::ALL {
            if let Some(v) = self.strengths.get(s).filter(|v| !(*v > 0.0 && v.is_finite())) {
                return refuse(format!("strength {} must be positive and finite, got {v} Pa", s.name()));
            }
        }
        Ok(())
    }

    /// The density, where a mass is needed.
    ///
    /// # Errors
    /// It was not given.
    pub fn mass_density(&self) -> Result<f64, MaterialError> {
        self.density.ok_or_else(|| MaterialError {
            material: self.name.clone(),
            why: "the mass of the plate needs a density, which the material does not give".into(),
        })
    }

    /// The thermal expansion, where it is needed.
    ///
    /// # Errors
    /// It was not given.
    pub fn thermal_expansion(&self) -> Result<[f64; 3], MaterialError> {
        self.expansion.ok_or_else(|| MaterialError {
            material: self.name.clone(),
            why: "a change of temperature needs the thermal expansion, which the material does not give".into(),
        })
    }

    /// Refuses a material that lacks a constant which `user` requires.
    ///
    /// # Errors
    /// Names the user and every missing constant.
    pub fn require(&self, needed: &[Strength], user: &str) -> Result<(), MaterialError> {
        let missing = needed.iter().filter(|s| self.strengths.get(**s).is_none()).map(|s| s.name());
        self.refuse_missing(missing.collect(), "strength", user)
    }

    /// Refuses a material that lacks a toughness which `user` requires.
    ///
    /// # Errors
    /// Names the user and every missing toughness.
    pub fn require_toughness(&self, needed: &[Toughness], user: &str) -> Result<(), MaterialError> {
        let missing = needed.iter().filter(|t| self.toughness.get(**t).is_none()).map(|t| t.name());
        self.refuse_missing(missing.collect(), "toughness", user)
    }

    fn refuse_missing(&self, missing: Vec<&str>, what: &str, user: &str) -> Result<(), MaterialError> {
        if missing.is_empty() {
            return Ok(());
        }
        Err(MaterialError {
            material: self.name.clone(),
            why: format!("{user} needs the {what} {}, which the material does not give", missing.join(", ")),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stiffness_inverts_compliance() {
        let e = Elastic::transversely_isotropic(130.3e9, 9.65e9, 0.35, 0.40, 5.93e9);
        assert!(e.check().is_ok());
        let (c, s) = (e.stiffness(), e.compliance());
        for (i, row) in c.iter().enumerate() {
            for j in 0..6 {
                let p: f64 = row.iter().zip(&s).map(|(c, s)| c * s[j]).sum();
                assert!((p - f64::from(i == j)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_offending_inequality_is_named() {
        let mut e = Elastic::transversely_isotropic(10e9, 10e9, 0.3, 0.3, 4e9);
        e.nu12 = 1.2;
        assert!(e.check().unwrap_err().to_string().contains("|nu12| < sqrt(E1/E2)"));
        e.nu12 = 0.9;
        e.nu13 = 0.9;
        e.nu23 = 0.9;
        assert!(e.check().unwrap_err().to_string().contains("> 0 is required"));
        e.e2 = f64::NAN;
        assert!(e.check().unwrap_err().to_string().contains("E2"));
        let m = Material {
            name: "m".into(),
            elastic: Elastic::isotropic(3.79e9, 0.36),
            density: Some(1260.0),
            strengths: Strengths::default().with(Strength::Xt, 38e6),
            toughness: Toughnesses::default(),
            eta: None,
            expansion: None,
        };
        assert!(m.check().is_ok());
        let heavy = Material { density: Some(f64::INFINITY), ..m.clone() };
        assert!(heavy.check().unwrap_err().to_string().contains("density must be positive and finite"));
        let brittle =
            Material { density: None, toughness: Toughnesses::default().with(Toughness::GIIc, 0.0), ..m.clone() };
        assert!(brittle.check().unwrap_err().to_string().contains("GIIc must be positive and finite"));
        let steep = Material { eta: Some(0.5), ..m.clone() };
        assert!(steep.check().unwrap_err().to_string().contains("at least 1, got 0.5"));
        assert_eq!(m.mass_density(), Ok(1260.0));
        assert!(brittle.mass_density().unwrap_err().to_string().contains("`m`: the mass of the plate needs a density"));
        let error = m.require(&[Strength::Xt, Strength::S12], "criterion `x`").unwrap_err().to_string();
        assert!(error.contains("S12") && !error.contains("Xt"), "{error}");
    }
}
