//! How a plug-in introduces itself and receives its parameters.

mod dimension;
mod figure;
mod params;
mod row;
mod value;

pub use crate::words::spelling::unknown_key;
pub use dimension::Dimension;
pub use figure::{DisplayUnit, digits};
pub use params::Params;
pub use row::{ParamDefault, ParamForm, ParamInfo, Role, Unit};
pub use value::{ParamError, Value};

use crate::contracts::contact::ContactLaw;
use crate::contracts::element::Element;
use crate::contracts::failure::FailureCriterion;
use crate::contracts::interface_law::InterfaceLaw;
use crate::contracts::ply_law::PlyLaw;
use crate::contracts::reduction::Reduction;
use crate::contracts::time::Integrator;
use std::fmt;

/// The table of kinds: contract, name, name of several, what a scene names one for.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident: $contract:ident, $name:literal, $plural:literal, $purpose:literal;)*) => {
        /// Kind of a plug-in; a name is unique within its kind.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum Kind { $($(#[$doc])* $kind,)* }

        impl Kind {
            /// All kinds.
            pub const ALL: &[Self] = &[$(Self::$kind,)*];

            /// What one is called, "contact law".
            pub const fn name(self) -> &'static str {
                match self { $(Self::$kind => $name,)* }
            }

            /// What several are called on the command line, "contact-laws".
            pub const fn plural(self) -> &'static str {
                match self { $(Self::$kind => $plural,)* }
            }

            /// What a scene names one for, "`contact.law`".
            pub const fn purpose(self) -> &'static str {
                match self { $(Self::$kind => $purpose,)* }
            }
        }

        /// A built plug-in of whichever kind.
        #[derive(Debug, Clone)]
        #[non_exhaustive]
        pub enum Built { $($(#[$doc])* $kind(Box<dyn $contract>),)* }
    };
}

kinds! {
    /// A finite element.
    Element: Element, "element", "elements", "`element.kind`";
    /// A failure criterion.
    Criterion: FailureCriterion, "criterion", "criteria", "`failure.criteria`";
    /// A contact law.
    Contact: ContactLaw, "contact law", "contact-laws", "`contact.law`";
    /// A time integrator.
    Integrator: Integrator, "integrator", "integrators", "`march.integrator`";
    /// A reduction.
    Reduction: Reduction, "reduction", "reductions", "`reduction.method`";
    /// A law of a ply.
    PlyLaw: PlyLaw, "ply law", "ply-laws", "`law` of a material";
    /// A law of an interface.
    InterfaceLaw: InterfaceLaw, "interface law", "interface-laws", "the interfaces between plies";
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One entry of the registry: what lists, documentation and scene errors show.
#[derive(Debug, Clone, Copy)]
pub struct PluginInfo {
    /// What it is.
    pub kind: Kind,
    /// Name in scenes, kebab-case.
    pub name: &'static str,
    /// One line for people.
    pub summary: &'static str,
    /// Where it comes from.
    pub source: &'static str,
    /// Its parameters.
    pub params: &'static [ParamInfo],
}

impl PluginInfo {
    /// Its parameters of a role.
    pub fn params_of(&self, role: Role) -> impl Iterator<Item = &'static ParamInfo> {
        self.params.iter().filter(move |row| row.role == role)
    }
}

/// A plug-in: an entry for the registry and a constructor from parameters.
///
/// ```
/// use fem_core::plugin::{Built, Kind, ParamError, Params, Plugin, PluginInfo};
/// # use fem_core::contact::{ContactForce, ContactHistory, ContactLaw};
/// # use fem_core::energy::Energy;
/// # #[derive(Debug, Clone)] struct Spring;
/// # impl ContactLaw for Spring {
/// #   fn force(&self, _: &ContactHistory, a: f64) -> ContactForce { ContactForce { force: a.max(0.0), tangent: 1.0 } }
/// #   fn commit(&self, _: &mut ContactHistory, _: f64) {}
/// #   fn energy(&self, _: &ContactHistory, _: f64) -> Energy { Energy::default() }
/// # }
/// impl Plugin for Spring {
///     const INFO: PluginInfo = PluginInfo {
///         kind: Kind::Contact,
///         name: "my-spring",
///         summary: "unit spring",
///         source: "an example",
///         params: &[],
///     };
///     fn build(_: &Params) -> Result<Built, ParamError> {
///         Ok(Built::Contact(Box::new(Spring)))
///     }
/// }
/// ```
pub trait Plugin {
    /// Entry in the registry.
    const INFO: PluginInfo;

    /// Builds it from parameters that [`Params`] reads by their rows; a registry has held all of them against
    /// [`PluginInfo::params`] before.
    ///
    /// # Errors
    /// A parameter that is missing or that its row does not allow; parameters that do not fit together.
    fn build(params: &Params) -> Result<Built, ParamError>;
}
