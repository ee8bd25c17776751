//! The registry of plug-ins: one table that scenes, lists and documentation read.

use crate::effect::{EffectInfo, EffectPlugin, LedgerColumn, Wish};
use crate::effects;
use fem_core::plugin::{Built, Kind, ParamError, ParamForm, ParamInfo, Params, Plugin, PluginInfo, Value, unknown_key};
use fem_io::cache::Cache;
use fem_io::scene::{EFFECT_SETTINGS, EffectSpec, Key, SceneError, SceneValue};
use fem_io::units::{self, UnitError};
use std::fmt;
use std::sync::Arc;
use tracing::debug;

/// The name of no reduction: the full model is marched.
pub const NO_REDUCTION: &str = "none";

/// Plug-ins by kind and name, in the order of registration.
///
/// ```
/// use fem::Registry;
/// use fem::core::plugin::Kind;
///
/// let registry = Registry::standard();
/// assert!(registry.list(Kind::Contact).any(|info| info.name == "sun-yang"));
/// ```
#[derive(Debug, Clone, Default)]
pub struct Registry {
    entries: Vec<Entry>,
    effects: Vec<EffectEntry>,
    clashes: Vec<(Kind, &'static str)>,
    cache: Option<Cache>,
}

#[derive(Clone)]
struct Entry {
    info: PluginInfo,
    build: Arc<Build>,
}

/// Makes a plug-in from its parameters.
type Build = dyn Fn(&Params) -> Result<Built, ParamError> + Send + Sync;

impl fmt::Debug for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.info, f)
    }
}

#[derive(Debug, Clone, Copy)]
struct EffectEntry {
    info: &'static EffectInfo,
    read: fn(&SceneValue<'_>) -> Result<Wish, SceneError>,
}

/// Why a plug-in was not built.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum RegistryError {
    /// No plug-in of that name.
    Unknown {
        /// What was asked for.
        kind: Kind,
        /// Its name.
        name: String,
        /// Nearest match and what there is.
        hint: String,
    },
    /// It does not take these parameters.
    Param(ParamError),
    /// A quantity of its parameters cannot be read.
    Unit {
        /// The parameter.
        key: String,
        /// What is wrong.
        error: UnitError,
        /// What to write instead.
        help: String,
    },
    /// Two plug-ins of one kind share the name.
    Clash {
        /// The kind.
        kind: Kind,
        /// The name.
        name: String,
    },
}

impl fmt::Display for RegistryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { kind, name, .. } => write!(f, "there is no {kind} `{name}`"),
            Self::Param(e) => e.fmt(f),
            Self::Unit { key, error, .. } => write!(f, "`{key}`: {error}"),
            Self::Clash { kind, name } => write!(f, "two plug-ins are registered as the {kind} `{name}`"),
        }
    }
}
impl std::error::Error for RegistryError {}

impl Registry {
    /// A registry without plug-ins.
    pub fn empty() -> Self {
        Self::default()
    }

    /// The same, with a folder in which plates of models are kept for later runs.
    #[must_use]
    pub fn with_cache(self, cache: Option<Cache>) -> Self {
        Self { cache, ..self }
    }

    /// Where plates are kept, if they are.
    pub fn cache(&self) -> Option<&Cache> {
        self.cache.as_ref()
    }

    /// All plug-ins of the framework.
    pub fn standard() -> Self {
        use {fem_dynamics::contact, fem_dynamics::integrate, fem_dynamics::reduce, fem_failure as failure};
        Self::empty()
            .with::<fem_elements::HermitePrism>()
            .with::<fem_elements::Hex20>()
            .with::<fem_elements::Wedge15>()
            .with::<fem_elements::Mitc4>()
            .with::<fem_elements::HermiteHex>()
            .with::<fem_elements::WebsterBeam>()
            .with::<contact::SunYang>()
            .with::<contact::YigitChristoforou>()
            .with::<contact::Hertz>()
            .with::<contact::Linear>()
            .with::<integrate::Rk1>()
            .with::<integrate::Rk2>()
            .with::<integrate::Rk3>()
            .with::<integrate::Rk4>()
            .with::<integrate::DormandPrince>()
            .with::<integrate::CentralDifference>()
            .with::<integrate::Newmark>()
            .with::<integrate::HhtAlpha>()
            .with::<integrate::GeneralizedAlpha>()
            .with::<integrate::EnergyConserving>()
            .with::<reduce::Guyan>()
            .with::<reduce::Irs>()
            .with::<reduce::CraigBampton>()
            .with::<reduce::ModalTruncation>()
            .with::<reduce::Ritz>()
            .with::<failure::HashinReport>()
            .with::<failure::Hashin1980>()
            .with::<failure::HashinRotem>()
            .with::<failure::MaxStress>()
            .with::<failure::MaxStrain>()
            .with::<failure::TsaiHill>()
            .with::<failure::TsaiWu>()
            .with::<failure::Hoffman>()
            .with::<failure::Christensen>()
            .with::<failure::ChangChang>()
            .with::<failure::ChangLessard>()
            .with::<failure::ChoiChang>()
            .with::<failure::Puck>()
            .with::<failure::Puck2d>()
            .with::<failure::Larc03>()
            .with::<failure::Larc05>()
            .with::<failure::Cuntze>()
            .with::<failure::Cuntze2d>()
            .with::<failure::Octahedral>()
            .with::<failure::QuadraticStress>()
            .with::<failure::MaxStressInterface>()
            .with::<failure::BrewerLagace>()
            .with::<failure::Expression>()
            .with::<failure::laws::HahnTsai>()
            .with::<failure::laws::CrackBand>()
            .with::<failure::laws::Bilinear>()
            .with_effect::<effects::Membrane>()
            .with_effect::<effects::NoInertia>()
            .with_effect::<effects::ViscousDamping>()
            .with_effect::<effects::Gravity>()
            .with_effect::<effects::Cure>()
            .with_effect::<effects::Preload>()
    }

    /// The registry with one plug-in more.
    #[must_use]
    pub fn with<P: Plugin>(self) -> Self {
        self.with_built(P::INFO, P::build as fn(&Params) -> Result<Built, ParamError>)
    }

    /// The registry with one plug-in more that no type stands for, such as one that was written in another language: `build` makes it,
    /// as [`Plugin::build`] does.
    #[must_use]
    pub fn with_built(
        mut self,
        info: PluginInfo,
        build: impl Fn(&Params) -> Result<Built, ParamError> + Send + Sync + 'static,
    ) -> Self {
        if self.find(info.kind, info.name).is_some() {
            self.clashes.push((info.kind, info.name));
        }
        self.entries.push(Entry { info, build: Arc::new(build) });
        self
    }

    /// The registry with one effect more.
    #[must_use]
    pub fn with_effect<E: EffectPlugin>(mut self) -> Self {
        self.effects.push(EffectEntry { info: &E::INFO, read: E::read });
        self
    }

    /// The effects, in the order in which they act.
    pub fn effects(&self) -> impl Iterator<Item = &'static EffectInfo> + '_ {
        self.effects.iter().map(|entry| entry.info)
    }

    /// Their columns in `history.csv`.
    pub fn columns(&self) -> Vec<&'static LedgerColumn> {
        self.effects().chain([&effects::NonlinearPlies::INFO]).flat_map(|info| info.columns).collect()
    }

    /// Their keys.
    pub fn effect_keys(&self) -> Vec<Key> {
        self.effects().map(|info| info.key).collect()
    }

    /// Reads an effect that a scene names.
    ///
    /// # Errors
    /// An unknown name, two effects of that name, a value that the effect does not take.
    pub(crate) fn read_effect(&self, spec: &EffectSpec) -> Result<Wish, SceneError> {
        let mut entries = self.effects.iter().filter(|entry| entry.info.key.name == spec.name());
        let Some(entry) = entries.next() else {
            let settings = EFFECT_SETTINGS.iter().map(|setting| setting.key.name);
            return Err(spec.unknown(settings.chain(self.effects().map(|info| info.key.name))));
        };
        let value = spec.value(&entry.info.key);
        match entries.next() {
            None => (entry.read)(&value),
            Some(_) => {
                Err(value.error("two effects are registered under this name", "rename or remove one of the two"))
            }
        }
    }

    /// Plug-ins of a kind.
    pub fn list(&self, kind: Kind) -> impl Iterator<Item = &PluginInfo> {
        self.entries.iter().map(|e| &e.info).filter(move |i| i.kind == kind)
    }

    /// The entry of the plug-in `name` of `kind`.
    pub fn info(&self, kind: Kind, name: &str) -> Option<&PluginInfo> {
        self.find(kind, name).map(|entry| &entry.info)
    }

    /// What the plug-in `name` of `kind` says of its parameter `key`.
    pub fn param(&self, kind: Kind, name: &str, key: &str) -> Option<&ParamInfo> {
        self.info(kind, name)?.params.iter().find(|p| p.name == key)
    }

    /// Parameters of the plug-in `name` of `kind` with quantities that are texts in SI; `None` for another plug-in, or a text that is none.
    pub(crate) fn in_si(&self, kind: Kind, name: &str, params: &Params) -> Option<(Params, &'static [ParamInfo])> {
        let rows = self.info(kind, name)?.params;
        Some((in_si(params, rows).ok()?, rows))
    }

    /// What a scene can name: the plug-ins of a kind and, instead of a reduction, [`NO_REDUCTION`].
    pub fn choices(&self, kind: Kind) -> Vec<PluginInfo> {
        const FULL: PluginInfo = PluginInfo {
            kind: Kind::Reduction,
            name: NO_REDUCTION,
            summary: "the full model",
            source: "",
            params: &[],
        };
        self.list(kind).copied().chain((kind == Kind::Reduction).then_some(FULL)).collect()
    }

    fn find(&self, kind: Kind, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|e| e.info.kind == kind && e.info.name == name)
    }

    /// Builds the plug-in `name` of `kind`; quantities among its parameters may be texts with a unit.
    ///
    /// # Errors
    /// An unknown name, two plug-ins of that name, an unknown parameter, a value that is not allowed.
    pub fn build(&self, kind: Kind, name: &str, params: &Params) -> Result<Built, RegistryError> {
        if self.clashes.contains(&(kind, name)) {
            return Err(RegistryError::Clash { kind, name: name.to_owned() });
        }
        let entry = self.find(kind, name).ok_or_else(|| RegistryError::Unknown {
            kind,
            name: name.to_owned(),
            hint: format!("`{name}` {}", unknown_key(name, self.choices(kind).iter().map(|info| info.name))),
        })?;
        let params = in_si(params, entry.info.params)?;
        params.check(entry.info.params).map_err(RegistryError::Param)?;
        debug!(%kind, name, ?params, "plug-in");
        (entry.build)(&params).map_err(RegistryError::Param)
    }
}

/// The parameters with the quantities among them, by their rows, in SI.
fn in_si(params: &Params, rows: &[ParamInfo]) -> Result<Params, RegistryError> {
    let mut read = params.clone();
    for row in rows.iter().filter(|row| matches!(row.form, ParamForm::Quantity(_))) {
        if let Some(Value::Text(text)) = params.get(row.name) {
            let (value, dimension) = units::parse_quantity(text).map_err(|error| {
                let help = error.remedy(row.dimension());
                RegistryError::Unit { key: row.name.to_owned(), error, help }
            })?;
            read.insert(row.name, Value::Quantity(value, dimension));
        }
    }
    Ok(read)
}
