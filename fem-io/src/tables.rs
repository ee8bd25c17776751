//! Result tables: histories and events as CSV, summaries as JSON.
//!
//! SI units throughout. Numbers are written with the fewest digits that read back as the same `f64`.

use crate::files::{FileError, OutputDir};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::io;

/// One instant of an impact: a row of `history.csv`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct HistoryRow {
    /// Time since the beginning, s; an impactor without `start` touches the plate then.
    pub time_s: f64,
    /// Of each impactor.
    pub impactors: Vec<ImpactorRow>,
    /// Kinetic energy of the impactors, J.
    pub impactor_kinetic_j: f64,
    /// Kinetic energy of the plate, J.
    pub plate_kinetic_j: f64,
    /// Strain energy of the plate, J.
    pub plate_strain_j: f64,
    /// Recoverable energy of the contacts, J.
    pub contact_stored_j: f64,
    /// Energy lost in the contacts, J.
    pub contact_dissipated_j: f64,
    /// What effects keep account of, one value per column of theirs.
    pub effects: Vec<f64>,
    /// Sum of the energies less that at the beginning, J; zero but for the integrator's error.
    pub energy_balance_j: f64,
}

impl HistoryRow {
    /// All contact forces together, N.
    pub fn contact_force_n(&self) -> f64 {
        self.impactors.iter().map(|impactor| impactor.contact_force_n).sum()
    }

    /// Its values in the order of [`history_columns`].
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let of_each = self.impactors.iter().flat_map(|impactor| {
            [
                impactor.contact_force_n,
                impactor.impactor_displacement_m,
                impactor.impactor_velocity_m_s,
                impactor.plate_displacement_m,
            ]
        });
        let energies = [
            self.impactor_kinetic_j,
            self.plate_kinetic_j,
            self.plate_strain_j,
            self.contact_stored_j,
            self.contact_dissipated_j,
        ];
        let effects = self.effects.iter().copied().chain([self.energy_balance_j]);
        [self.time_s].into_iter().chain(of_each).chain(energies).chain(effects)
    }
}

/// One impactor at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ImpactorRow {
    /// Contact force, N.
    pub contact_force_n: f64,
    /// Displacement of the impactor along the plate's normal, m; 0 where it would touch the plate at rest.
    pub impactor_displacement_m: f64,
    /// Velocity of the impactor, m/s.
    pub impactor_velocity_m_s: f64,
    /// Displacement of the plate at the contact, m.
    pub plate_displacement_m: f64,
}

/// First damage by one criterion and mode: a row of `events.csv`, and part of a summary's `first_damage`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EventRow {
    /// Name of the criterion.
    pub criterion: String,
    /// Failure mode.
    pub mode: String,
    /// Time, s.
    pub time_s: f64,
    /// Substructure of a deck, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub substructure: Option<u64>,
    /// Region of the plate from whose bottom plies are counted, where plies of one number do not lie at one height in all of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<String>,
    /// Cell, by its number in the mesh file; of a deck its element.
    pub cell: u64,
    /// Ply counted from the bottom, such as `3`, or the two plies of an interface, `3|4`.
    pub ply: String,
    /// Fibre angle of the ply, degrees.
    pub angle_deg: f64,
    /// Place, m.
    pub x_m: f64,
    /// Place, m.
    pub y_m: f64,
    /// Place, m.
    pub z_m: f64,
    /// Failure index, 1 at failure; it may be infinite, which JSON cannot hold.
    #[serde(skip)]
    pub index: f64,
}

/// A failure index at a place: a row of `index_maxima.csv`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IndexRow {
    /// Name of the criterion.
    pub criterion: String,
    /// Failure mode.
    pub mode: String,
    /// Region of the plate from whose bottom plies are counted, where plies of one number do not lie at one height in all of them.
    pub region: Option<String>,
    /// Cell, by its number in the mesh file.
    pub cell: u64,
    /// Ply counted from the bottom, such as `3`, or the two plies of an interface, `3|4`.
    pub ply: String,
    /// Centre of the place, m.
    pub position_m: [f64; 3],
    /// Failure index, 1 at failure; it may be infinite.
    pub index: f64,
}

/// The same at a time: a row of `index_history.csv`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IndexHistoryRow {
    /// Time, s.
    pub time_s: f64,
    /// The index.
    pub index: IndexRow,
}

/// A stress that brings a material to failure: a row of `envelope.csv`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EnvelopeRow {
    /// Id of the criterion.
    pub criterion: String,
    /// Failure mode that governs.
    pub mode: String,
    /// Angle of the direction, degrees, once each stress is divided by its scale.
    pub angle_deg: f64,
    /// The two stresses: `s1`, `s2`, `s3`, `s12`, `s23` or `s13`.
    pub components: [&'static str; 2],
    /// Their values at failure, MPa.
    pub stresses_mpa: [f64; 2],
}

/// Names of the columns of `history.csv`, with their units: those of the impactors begin with name and point where there are several.
pub fn history_columns(impactors: &[&str], effects: &[&str]) -> Vec<String> {
    const OF_EACH: [&str; 4] =
        ["contact_force_N", "impactor_displacement_m", "impactor_velocity_m_s", "plate_displacement_m"];
    let of_each = impactors.iter().flat_map(|name| {
        OF_EACH.map(|column| if impactors.len() == 1 { column.to_owned() } else { format!("{name}.{column}") })
    });
    const ENERGIES: [&str; 5] =
        ["impactor_kinetic_J", "plate_kinetic_J", "plate_strain_J", "contact_stored_J", "contact_dissipated_J"];
    let energies = ENERGIES.iter().chain(effects).chain(&["energy_balance_J"]).map(|name| (*name).to_owned());
    ["time_s".to_owned()].into_iter().chain(of_each).chain(energies).collect()
}

/// Writes `history.csv`; every row has as many impactors as `impactors` has names, and as many values of effects as `effects`
/// has. Its columns are [`history_columns`].
///
/// # Errors
/// A value that is not finite, and as [`OutputDir::write`].
pub fn write_history(
    dir: &OutputDir,
    impactors: &[&str],
    effects: &[&str],
    rows: &[HistoryRow],
) -> Result<(), FileError> {
    let header = history_columns(impactors, effects);
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    let values = |row: &HistoryRow| row.values().map(TableValue::Number).collect();
    write_columns(dir, "history.csv", &header, rows.iter().map(values))
}

/// Writes `events.csv`; without events it holds the header alone.
///
/// # Errors
/// A value that is not finite, and as [`OutputDir::write`].
pub fn write_events(dir: &OutputDir, rows: &[EventRow]) -> Result<(), FileError> {
    write_table(dir, "events.csv", rows)
}

/// A cell of an interface that is damaged.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DelaminationRow {
    /// `4|5`, between these two plies.
    pub interface: String,
    /// Number of the cell in the mesh file.
    pub cell: u64,
    /// Its centre, m.
    pub x_m: f64,
    /// Its centre, m.
    pub y_m: f64,
    /// Its area, m².
    pub area_m2: f64,
    /// Share of its area that holds no more.
    pub delaminated: f64,
    /// Mean share of its cohesion that it has lost.
    pub damage: f64,
    /// When a point of it first held no more, s; nothing where all hold.
    pub since_s: Option<f64>,
}

/// Writes `delaminations.csv`.
///
/// # Errors
/// A value that is not finite, and as [`OutputDir::write`].
pub fn write_delaminations(dir: &OutputDir, rows: &[DelaminationRow]) -> Result<(), FileError> {
    write_table(dir, "delaminations.csv", rows)
}

/// Writes `index_maxima.csv`.
///
/// # Errors
/// A value that is not finite, indices apart, and as [`OutputDir::write`].
pub fn write_index_maxima(dir: &OutputDir, rows: &[IndexRow]) -> Result<(), FileError> {
    write_table(dir, "index_maxima.csv", rows)
}

/// Writes `index_history.csv`.
///
/// # Errors
/// A value that is not finite, indices apart, and as [`OutputDir::write`].
pub fn write_index_history(dir: &OutputDir, rows: &[IndexHistoryRow]) -> Result<(), FileError> {
    write_table(dir, "index_history.csv", rows)
}

/// Writes `envelope.csv`, all rows of the plane of the first; its stresses alone are in MPa.
///
/// # Errors
/// A value that is not finite, and as [`OutputDir::write`].
pub fn write_envelopes(dir: &OutputDir, rows: &[EnvelopeRow]) -> Result<(), FileError> {
    write_table(dir, "envelope.csv", rows)
}

/// Writes `value` as indented JSON to the file `name`.
///
/// # Errors
/// As [`json_text`] and [`OutputDir::write`].
pub fn write_json<T: Serialize>(dir: &OutputDir, name: &str, value: &T) -> Result<(), FileError> {
    let text = json_text(name, value)?;
    dir.write(name, |out| out.write_all(text.as_bytes()))
}

/// `value` as indented JSON, which errors call `name`.
///
/// JSON has no NaN and no infinity, and serde_json writes null for them: null is refused altogether, so optional
/// values need `#[serde(skip_serializing_if = "Option::is_none")]`.
///
/// # Errors
/// A value that is not finite, or of a type that JSON cannot hold.
pub fn json_text<T: Serialize>(name: &str, value: &T) -> Result<String, FileError> {
    let json_error = |cause| FileError::Json { file: name.to_owned(), cause };
    let value = serde_json::to_value(value).map_err(json_error)?;
    if let Some(key) = find_null(&value) {
        return Err(FileError::Null { file: name.to_owned(), key: key.join(".") });
    }
    let mut text = serde_json::to_string_pretty(&value).map_err(json_error)?;
    text.push('\n');
    Ok(text)
}

/// Keys and indices that lead to the first null, if there is one.
fn find_null(value: &Value) -> Option<Vec<String>> {
    let within = |key: String, value| {
        let mut path = find_null(value)?;
        path.insert(0, key);
        Some(path)
    };
    match value {
        Value::Null => Some(Vec::new()),
        Value::Array(items) => items.iter().enumerate().find_map(|(i, v)| within(i.to_string(), v)),
        Value::Object(items) => items.iter().find_map(|(k, v)| within(k.clone(), v)),
        _ => None,
    }
}

/// A value of a table.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(untagged)]
#[allow(missing_docs)]
pub enum TableValue<'a> {
    Number(f64),
    /// A number that may be infinite, written `inf`.
    Index(f64),
    Count(u64),
    Text(&'a str),
}

impl From<TableValue<'_>> for Value {
    fn from(field: TableValue<'_>) -> Self {
        match field {
            TableValue::Number(value) => value.into(),
            TableValue::Index(value) if value.is_finite() => value.into(),
            TableValue::Index(_) => "inf".into(),
            TableValue::Count(value) => value.into(),
            TableValue::Text(text) => text.into(),
        }
    }
}

impl EnvelopeRow {
    /// Its values by the names of their columns.
    pub fn named(&self) -> Map<String, Value> {
        named(self)
    }
}

impl EventRow {
    /// The ply, and the region from whose bottom it is counted where that is said.
    pub fn name_of_ply(&self) -> String {
        self.region.as_ref().map_or_else(|| self.ply.clone(), |region| format!("{} {region}", self.ply))
    }

    /// Its values by the names of their columns; an infinite index is `"inf"`.
    pub fn named(&self) -> Map<String, Value> {
        named(self)
    }
}

fn named<R: Row>(row: &R) -> Map<String, Value> {
    row.fields().into_iter().map(|(name, field)| (name.to_owned(), field.into())).collect()
}

/// A row of a table: its columns with their values, in order.
trait Row: Default {
    fn fields(&self) -> Vec<(&'static str, TableValue<'_>)>;
}

impl Row for EventRow {
    fn fields(&self) -> Vec<(&'static str, TableValue<'_>)> {
        let mut fields = vec![
            ("time_s", TableValue::Number(self.time_s)),
            ("criterion", TableValue::Text(&self.criterion)),
            ("mode", TableValue::Text(&self.mode)),
        ];
        fields.extend(self.substructure.map(|number| ("substructure", TableValue::Count(number))));
        fields.extend(self.region.as_ref().map(|name| ("region", TableValue::Text(name))));
        fields.extend([
            ("cell", TableValue::Count(self.cell)),
            ("ply", TableValue::Text(&self.ply)),
            ("angle_deg", TableValue::Number(self.angle_deg)),
            ("x_m", TableValue::Number(self.x_m)),
            ("y_m", TableValue::Number(self.y_m)),
            ("z_m", TableValue::Number(self.z_m)),
            ("index", TableValue::Index(self.index)),
        ]);
        fields
    }
}

impl Row for DelaminationRow {
    fn fields(&self) -> Vec<(&'static str, TableValue<'_>)> {
        vec![
            ("interface", TableValue::Text(&self.interface)),
            ("cell", TableValue::Count(self.cell)),
            ("x_m", TableValue::Number(self.x_m)),
            ("y_m", TableValue::Number(self.y_m)),
            ("area_m2", TableValue::Number(self.area_m2)),
            ("delaminated", TableValue::Number(self.delaminated)),
            ("damage", TableValue::Number(self.damage)),
            ("since_s", self.since_s.map_or(TableValue::Text(""), TableValue::Number)),
        ]
    }
}

impl Row for IndexRow {
    fn fields(&self) -> Vec<(&'static str, TableValue<'_>)> {
        let [x, y, z] = self.position_m;
        let mut fields = vec![("criterion", TableValue::Text(&self.criterion)), ("mode", TableValue::Text(&self.mode))];
        fields.extend(self.region.as_ref().map(|name| ("region", TableValue::Text(name))));
        fields.extend([
            ("cell", TableValue::Count(self.cell)),
            ("ply", TableValue::Text(&self.ply)),
            ("x_m", TableValue::Number(x)),
            ("y_m", TableValue::Number(y)),
            ("z_m", TableValue::Number(z)),
            ("index", TableValue::Index(self.index)),
        ]);
        fields
    }
}

impl Row for IndexHistoryRow {
    fn fields(&self) -> Vec<(&'static str, TableValue<'_>)> {
        let mut fields = vec![("time_s", TableValue::Number(self.time_s))];
        fields.extend(self.index.fields());
        fields
    }
}

impl Row for EnvelopeRow {
    fn fields(&self) -> Vec<(&'static str, TableValue<'_>)> {
        let column = |name| match name {
            "s1" => "s1_MPa",
            "s2" => "s2_MPa",
            "s3" => "s3_MPa",
            "s12" => "s12_MPa",
            "s23" => "s23_MPa",
            _ => "s13_MPa",
        };
        vec![
            ("criterion", TableValue::Text(&self.criterion)),
            ("mode", TableValue::Text(&self.mode)),
            ("angle_deg", TableValue::Number(self.angle_deg)),
            (column(self.components[0]), TableValue::Number(self.stresses_mpa[0])),
            (column(self.components[1]), TableValue::Number(self.stresses_mpa[1])),
        ]
    }
}

fn write_table<R: Row>(dir: &OutputDir, file: &str, rows: &[R]) -> Result<(), FileError> {
    let none = R::default();
    let header: Vec<_> = rows.first().unwrap_or(&none).fields().into_iter().map(|(column, _)| column).collect();
    let values = rows.iter().map(|row| row.fields().into_iter().map(|(_, value)| value).collect());
    write_columns(dir, file, &header, values)
}

/// Writes a table of the columns `header` to `file`; every row has as many values.
///
/// # Errors
/// A value that is not finite, and as [`OutputDir::write`].
pub fn write_columns<'a>(
    dir: &OutputDir,
    file: &str,
    header: &[&str],
    rows: impl Iterator<Item = Vec<TableValue<'a>>> + Clone,
) -> Result<(), FileError> {
    for (row, values) in rows.clone().enumerate() {
        for (column, value) in header.iter().zip(values) {
            let refused = match value {
                TableValue::Number(value) => (!value.is_finite()).then_some(value),
                TableValue::Index(value) => (!(value > f64::NEG_INFINITY)).then_some(value),
                _ => None,
            };
            if let Some(value) = refused {
                return Err(FileError::NonFinite { file: file.into(), row: row + 1, column: (*column).into(), value });
            }
        }
    }
    dir.write(file, |out| {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(header).map_err(cause)?;
        for row in rows {
            table.serialize(row).map_err(cause)?;
        }
        table.flush()
    })
}

/// The system's error behind a CSV error; the conversion of csv itself drops its kind, by which a full disk is known.
fn cause(error: csv::Error) -> io::Error {
    let text = error.to_string();
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        _ => io::Error::other(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    use proptest::prelude::*;
    use std::fs;

    fn read(dir: &OutputDir, name: &str) -> String {
        fs::read_to_string(dir.path().join(name)).unwrap()
    }

    fn numbers(v: [f64; 11]) -> HistoryRow {
        HistoryRow {
            time_s: v[0],
            impactors: vec![ImpactorRow {
                contact_force_n: v[1],
                impactor_displacement_m: v[2],
                impactor_velocity_m_s: v[3],
                plate_displacement_m: v[4],
            }],
            impactor_kinetic_j: v[5],
            plate_kinetic_j: v[6],
            plate_strain_j: v[7],
            contact_stored_j: v[8],
            contact_dissipated_j: v[9],
            effects: Vec::new(),
            energy_balance_j: v[10],
        }
    }

    #[test]
    fn history_has_its_columns_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        write_history(&dir, &["one"], &[], &[numbers([5e-7, 1.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, -1e-17])])
            .unwrap();
        assert_eq!(
            read(&dir, "history.csv"),
            "time_s,contact_force_N,impactor_displacement_m,impactor_velocity_m_s,plate_displacement_m,\
             impactor_kinetic_J,plate_kinetic_J,plate_strain_J,contact_stored_J,contact_dissipated_J,energy_balance_J\n\
             5e-7,1.5,3.0,4.0,5.0,6.0,7.0,8.0,9.0,10.0,-1e-17\n"
        );
    }

    #[test]
    fn effects_have_columns_of_their_own() {
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        let row = HistoryRow {
            effects: vec![0.5, -0.25],
            ..numbers([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0])
        };
        write_history(&dir, &["one"], &["damping_dissipated_J", "gravity_potential_J"], &[row]).unwrap();
        let text = read(&dir, "history.csv");
        let want = "contact_dissipated_J,damping_dissipated_J,gravity_potential_J,energy_balance_J\n";
        assert!(text.contains(want) && text.ends_with(",9.0,0.5,-0.25,10.0\n"), "{text}");
    }

    #[test]
    fn columns_of_several_impactors_bear_their_names() {
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        let mut row = numbers([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0]);
        row.impactors.push(ImpactorRow { contact_force_n: 12.0, ..row.impactors[0] });
        assert_eq!(row.contact_force_n(), 14.0);
        write_history(&dir, &["one", "two, late"], &[], &[row]).unwrap();
        assert_eq!(
            read(&dir, "history.csv"),
            "time_s,one.contact_force_N,one.impactor_displacement_m,one.impactor_velocity_m_s,one.plate_displacement_m,\
             \"two, late.contact_force_N\",\"two, late.impactor_displacement_m\",\"two, late.impactor_velocity_m_s\",\
             \"two, late.plate_displacement_m\",impactor_kinetic_J,plate_kinetic_J,plate_strain_J,contact_stored_J,\
             contact_dissipated_J,energy_balance_J\n\
             1.0,2.0,3.0,4.0,5.0,12.0,3.0,4.0,5.0,6.0,7.0,8.0,9.0,10.0,11.0\n"
        );
    }

    #[test]
    fn events_quote_what_needs_it_and_keep_the_header_without_rows() {
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        let header = "time_s,criterion,mode,cell,ply,angle_deg,x_m,y_m,z_m,index\n";
        write_events(&dir, &[]).unwrap();
        assert_eq!(read(&dir, "events.csv"), header);
        let event = EventRow {
            substructure: None,
            region: None,
            time_s: 2.2e-4,
            criterion: "octahedral".into(),
            mode: "tension, \"resin\"".into(),
            cell: u64::MAX,
            ply: "3|4".into(),
            angle_deg: -45.0,
            x_m: 1e-3,
            y_m: -0.0,
            z_m: 2.0,
            index: 1.02,
        };
        write_events(&dir, &[event]).unwrap();
        let row = "0.00022,octahedral,\"tension, \"\"resin\"\"\",18446744073709551615,3|4,-45.0,0.001,-0.0,2.0,1.02\n";
        assert_eq!(read(&dir, "events.csv"), format!("{header}{row}"));
    }

    #[test]
    fn an_index_may_be_infinite_but_not_nan() {
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        let index = |index| IndexRow { mode: "m".into(), position_m: [1.0, 2.0, 3.0], index, ..Default::default() };
        write_index_maxima(&dir, &[index(f64::INFINITY), index(0.5)]).unwrap();
        let header = "criterion,mode,cell,ply,x_m,y_m,z_m,index\n";
        assert_eq!(read(&dir, "index_maxima.csv"), format!("{header},m,0,,1.0,2.0,3.0,inf\n,m,0,,1.0,2.0,3.0,0.5\n"));
        write_index_history(&dir, &[IndexHistoryRow { time_s: 0.25, index: index(f64::INFINITY) }]).unwrap();
        assert_eq!(read(&dir, "index_history.csv"), format!("time_s,{header}0.25,,m,0,,1.0,2.0,3.0,inf\n"));
        for bad in [f64::NAN, f64::NEG_INFINITY] {
            let error = write_index_maxima(&dir, &[index(bad)]).unwrap_err().to_string();
            assert!(error.starts_with("index_maxima.csv, row 1, column index"), "{error}");
        }
    }

    proptest! {
        #[test]
        fn numbers_read_back_exactly(v in proptest::array::uniform11(POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO)) {
            let folder = tempfile::tempdir().unwrap();
            let dir = OutputDir::create(folder.path()).unwrap();
            write_history(&dir, &["one"], &[], &[numbers(v)]).unwrap();
            let text = read(&dir, "history.csv");
            let back = text.lines().nth(1).unwrap().split(',').map(|x| x.parse::<f64>().unwrap().to_bits());
            prop_assert_eq!(back.collect::<Vec<_>>(), v.map(f64::to_bits));
        }
    }

    #[test]
    fn a_number_that_is_none_is_named_and_nothing_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        let rows = [numbers([0.0; 11]), HistoryRow { plate_strain_j: f64::NAN, ..numbers([0.0; 11]) }];
        let error = write_history(&dir, &["one"], &[], &rows).unwrap_err().to_string();
        assert_eq!(error, "history.csv, row 2, column plate_strain_J: NaN is not a finite number");
        assert!(!folder.path().join("history.csv").exists());
    }

    #[test]
    fn a_full_disk_is_still_known_as_one() {
        assert_eq!(cause(io::Error::from(io::ErrorKind::StorageFull).into()).kind(), io::ErrorKind::StorageFull);
    }

    #[test]
    fn json_is_indented_ordered_and_finite() {
        #[derive(Serialize)]
        struct Summary {
            peak: f64,
            #[serde(skip_serializing_if = "Option::is_none")]
            first: Option<f64>,
            ledger: Vec<(&'static str, f64)>,
        }
        let folder = tempfile::tempdir().unwrap();
        let dir = OutputDir::create(folder.path()).unwrap();
        let mut summary = Summary { peak: 0.1, first: None, ledger: vec![("strain", 2.5)] };
        write_json(&dir, "summary.json", &summary).unwrap();
        assert_eq!(
            read(&dir, "summary.json"),
            "{\n  \"peak\": 0.1,\n  \"ledger\": [\n    [\n      \"strain\",\n      2.5\n    ]\n  ]\n}\n"
        );
        summary.ledger.push(("balance", f64::INFINITY));
        let error = write_json(&dir, "summary.json", &summary).unwrap_err().to_string();
        assert!(error.starts_with("summary.json, `ledger.1.1`: not a finite number"), "{error}");
    }
}
