//! The summary as people read it.

use super::{ImpactSummary, ResultErrors};
use crate::cost::Cost;
use crate::words::{append, append_symmetry};
use fem_core::plugin::{Dimension, digits};
use std::fmt::Write as _;

/// Errors that are nothing but rounding.
const EXACT: f64 = 1e-9;

impl ImpactSummary {
    /// The summary as people read it, with what it cost.
    pub fn text(&self, cost: &Cost) -> String {
        let mut t = String::new();
        let mut line = |text: std::fmt::Arguments<'_>| {
            let _ = t.write_fmt(text);
            t.push('\n');
        };
        let m = &self.model;
        line(format_args!("{}", self.title));
        self.cautions.iter().for_each(|caution| line(format_args!("  caution   {caution}")));
        line(format_args!(
            "  model     {} {} x {} layers, {} plies, {}; {} unknowns{}, {} marched ({}){}",
            m.quads,
            m.shape,
            m.layers,
            m.plies,
            Dimension::LENGTH.of(m.thickness_mm * 1e-3),
            m.unknowns,
            append(m.substructures),
            m.unknowns_marched,
            self.fidelity,
            append_symmetry(m.symmetry)
        ));
        self.preload.line().iter().for_each(|preload| line(format_args!("{preload}")));
        for i in &self.impact {
            let name = i.name.as_ref().map_or(String::new(), |name| format!("{name}: "));
            let start = i.start_time_s.map_or(String::new(), |t| format!(", there at {}", Dimension::TIME.of(t)));
            line(format_args!(
                "  impact    {name}{} at {} = {} on a plate of {}{start}",
                Dimension::MASS.of(i.mass_kg),
                Dimension::VELOCITY.of(i.velocity_m_s),
                Dimension::ENERGY.of(i.energy_J),
                Dimension::MASS.of(m.plate_mass_g * 1e-3)
            ));
            line(format_args!(
                "  force     {name}peak {} at {}; deflection {} = {:.2} thicknesses; {} contact{}{}{}",
                Dimension::FORCE.of(i.peak_force_N),
                Dimension::TIME.of(i.peak_force_time_s),
                Dimension::LENGTH.of(i.peak_plate_displacement_m),
                i.peak_plate_displacement_over_thickness,
                i.contacts,
                if i.contacts == 1 { "" } else { "s" },
                i.contact_radius_m.map_or(String::new(), |a| format!(", up to {} in radius", Dimension::LENGTH.of(a))),
                i.dent_m.map_or(String::new(), |dent| format!(", leaving a dent of {}", Dimension::LENGTH.of(dent)))
            ));
        }
        if self.first_damage.is_empty() {
            let end = self.impact.first().map_or(0.0, |i| i.end_time_s);
            let judged = !self.not_reached.is_empty();
            let found =
                if judged { format!("none until {}", Dimension::TIME.of(end)) } else { "not looked for".to_owned() };
            line(format_args!("  damage    {found}"));
        } else {
            let regions = self.first_damage.iter().any(|d| d.event.region.is_some());
            let of = if regions { " of their region" } else { "" };
            line(format_args!("  damage    first onset of each mode (plies are counted from the bottom{of})"));
            line(format_args!(
                "            {:>9}  {:<15} {:<19} {:>7} {:>7}  {:>19}  {:>8}",
                "time", "criterion", "mode", "ply", "angle", "x, y", "force"
            ));
            for d in &self.first_damage {
                line(format_args!(
                    "            {:>9}  {:<15} {:<19} {:>7} {:>5.0}°  {:>19}  {:>8}",
                    Dimension::TIME.of(d.event.time_s),
                    d.event.criterion,
                    d.event.mode,
                    d.event.name_of_ply(),
                    d.event.angle_deg,
                    Dimension::LENGTH.list(&[d.event.x_m, d.event.y_m]),
                    Dimension::FORCE.of(d.contact_force_N)
                ));
            }
        }
        for n in &self.not_reached {
            line(format_args!(
                "            not reached: {} {}, largest index {:.3} at {}, ply {}",
                n.criterion,
                n.mode,
                n.largest_index,
                Dimension::TIME.of(n.time_s),
                n.ply
            ));
        }
        if !self.first_damage.is_empty() {
            line(format_args!(
                "  why       stress there at that time, MPa (plies: 1 along the fibres), and what it may grow by"
            ));
            line(format_args!(
                "            {:>9}  {:<15} {:<19} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7}  {:>7}",
                "time", "criterion", "mode", "11", "22", "33", "12", "23", "13", "reserve"
            ));
            for d in &self.first_damage {
                let s = &d.stress;
                // A zero has no sign: that of a rounding error is the machine's.
                let tenth = |stress: f64| (10.0 * stress).round() / 10.0 + 0.0;
                line(format_args!(
                    "            {:>9}  {:<15} {:<19} {:>7.1} {:>7.1} {:>7.1} {:>7.1} {:>7.1} {:>7.1}  {}",
                    Dimension::TIME.of(d.event.time_s),
                    d.event.criterion,
                    d.event.mode,
                    tenth(s.s11_MPa),
                    tenth(s.s22_MPa),
                    tenth(s.s33_MPa),
                    tenth(s.s12_MPa),
                    tenth(s.s23_MPa),
                    tenth(s.s13_MPa),
                    d.reserve_factor.map_or_else(|| "      -".to_owned(), |r| format!("{r:>7.4}"))
                ));
            }
        }
        if !self.onsets.is_empty() {
            line(format_args!("  when      how far these times are known"));
        }
        for band in &self.onsets {
            let (time, criterion, mode) = (Dimension::TIME.of(band.time_s), &band.criterion, &band.mode);
            line(format_args!("            {time:>9}  {criterion:<15} {mode:<19} {}", band.text()));
        }
        if !self.modes.is_empty() {
            line(format_args!("  modes     shares of each mode in the deflection at rest and in the plate's energies"));
            line(format_args!(
                "            {:>4} {:>12} {:>8} {:>8} {:>8}  {:>17}",
                "mode", "frequency", "at rest", "strain", "kinetic", "largest part"
            ));
            for (k, m) in self.modes.iter().enumerate() {
                line(format_args!(
                    "            {:>4} {:>12} {:>6.1} % {:>6.1} % {:>6.1} %  {:>17}",
                    k + 1,
                    Dimension::FREQUENCY.of(m.frequency_Hz),
                    m.static_share * 1e2,
                    m.strain_share * 1e2,
                    m.kinetic_share * 1e2,
                    Dimension::LENGTH.of(m.largest_m)
                ));
            }
        }
        if let Some(grown) = &self.delamination {
            grown.lines().iter().for_each(|one| line(format_args!("{one}")));
        }
        let of_plies = self.plies_J.iter().filter(|(_, energy)| **energy > 0.0);
        let of_plies = of_plies.map(|(mode, energy)| format!("{} {mode}", Dimension::ENERGY.of(*energy)));
        let of_plies: Vec<String> = of_plies.collect();
        if !of_plies.is_empty() {
            line(format_args!("  plies     {}", of_plies.join(", ")));
        }
        if !self.labelled.is_empty() {
            let each: Vec<String> = self
                .labelled
                .iter()
                .map(|(label, energy)| format!("{label} {}", Dimension::ENERGY.of(*energy)))
                .collect();
            line(format_args!("  energy    at the end: {}", each.join(", ")));
        }
        if let (Some(d), None) = (&self.delamination_threshold, &self.delamination) {
            let peak = self.impact.iter().map(|i| i.peak_force_N).fold(0.0, f64::max);
            let by = d.impactor.as_ref().map_or(String::new(), |name| format!(" by {name}"));
            let all = match d.interfaces {
                1 => String::new(),
                n => format!(
                    " for one delamination, {} for all {n} interfaces between unlike plies",
                    Dimension::FORCE.of(d.force_of_all_N)
                ),
            };
            let reached = match (d.time_of_all_s, d.time_s) {
                (Some(least), _) if d.interfaces == 1 => format!("first reached at {}{by}", Dimension::TIME.of(least)),
                (Some(least), Some(one)) => {
                    format!(
                        "first reached at {} (one) and {} (all){by}",
                        Dimension::TIME.of(one),
                        Dimension::TIME.of(least)
                    )
                }
                (Some(least), None) => format!("that of all first reached at {}{by}", Dimension::TIME.of(least)),
                (None, _) => format!("not reached: the peak is {:.2} of it", peak / d.force_of_all_N),
            };
            line(format_args!(
                "  delam.    threshold of the contact force {}{all} (Davies-Olsson, D* {} N m, GIIc {} J/m^2), {reached}; \
                 a threshold, not a stress criterion",
                Dimension::FORCE.of(d.force_N),
                digits(d.bending_stiffness_N_m),
                digits(d.toughness_GIIc_J_m2)
            ));
        }
        self.advised.iter().for_each(|advised| line(format_args!("  advised   {advised}")));
        line(format_args!(
            "  accuracy  energy error {:.1e} of the impact energy; step {}{}",
            self.accuracy.energy_error_relative,
            Dimension::TIME.of(self.accuracy.step_s),
            match self.accuracy.stable_step_s {
                Some(s) => format!(" (stable up to {})", Dimension::TIME.of(s)),
                None => " (no stability limit)".to_owned(),
            }
        ));
        if let (Some(parts), Some(shortest), Some(longest)) =
            (self.accuracy.step_parts, self.accuracy.shortest_part_s, self.accuracy.longest_part_s)
        {
            line(format_args!(
                "            steps in {parts} parts of {} to {}, by an estimate of their error",
                Dimension::TIME.of(shortest),
                Dimension::TIME.of(longest)
            ));
        }
        for estimate in self.estimates() {
            line(format_args!("            {estimate}"));
        }
        let w = &self.work;
        let newton = w.newton_iterations.map_or(String::new(), |count| format!(" of {count} Newton iterations"));
        line(format_args!(
            "  work      {} element matrices, {} factorisations, {} solves, {} steps{newton}, {} contact calls, {} criterion calls",
            w.elements, w.factorisations, w.solves, w.steps, w.contact_calls, w.criterion_calls
        ));
        line(format_args!("  time      {cost}"));
        for warning in &self.warnings {
            line(format_args!("  warning   {warning}"));
        }
        if let Some(why) = &self.stopped {
            line(format_args!("  STOPPED   {why}"));
        }
        t
    }

    /// What is known of the errors of step, reduction and mesh, each in a line.
    fn estimates(&self) -> Vec<String> {
        let (a, m) = (&self.accuracy, &self.model);
        if !self.completed {
            return vec!["errors of step, reduction and mesh are not estimated: the march has stopped".to_owned()];
        }
        let compared = a.compared_step_s.zip(a.compared_force_L2_relative);
        let step = match (a.step_error_force_L2_relative, compared) {
            (Some(error), Some((step, change))) => {
                format!("step: force within about {error:.1e} ({} it by {change:.1e})", {
                    let times = match step / a.step_s {
                        ratio if ratio < 1.0 => "half".to_owned(),
                        ratio if ratio < 3.0 => "twice".to_owned(),
                        ratio => format!("{ratio:.0} times"),
                    };
                    match a.step_parts {
                        None => format!("{times} the step changes"),
                        Some(_) => format!("parts {times} as long change"),
                    }
                })
            }
            _ => "step: error not estimated; a run with half the step would show it".to_owned(),
        };
        let reduction = if m.unknowns_marched == m.substructures.map_or(m.unknowns, |s| s.masters) {
            "reduction: none, all unknowns are marched".to_owned()
        } else {
            // What the richer plate does says it better than the energy of what is left out.
            let richer = a.results_of_reduction.map(|errors| errors.force_history_L2_relative);
            let force = richer.or(a.reduction_error_force_L2_relative).map_or_else(
                || "error of the force not estimated".to_owned(),
                |error| format!("force within about {error:.1e}"),
            );
            let energy = a.reduction_residual_energy_relative;
            let energy = energy.map_or(String::new(), |error| format!(", displacements within {error:.1e} in energy"));
            let stiffness = a.reduction_flexibility_error_relative;
            let stiffness = stiffness.map_or(String::new(), |error| match error {
                rounding if rounding < EXACT => "; stiffness at the contact exact".to_owned(),
                error => format!("; stiffness at the contact within {error:.1e}"),
            });
            format!("reduction: {force}{energy}{stiffness}")
        };
        let mesh = a.mesh_error_relative.map_or_else(
            || "mesh: error not estimated; `fem study` shows it".to_owned(),
            |error| format!("mesh: at rest under the contact within {error:.1e} in energy norm"),
        );
        vec![self.results(), step, reduction, mesh]
    }

    /// What the main results are worth.
    fn results(&self) -> String {
        let a = &self.accuracy;
        let Some(all) = a.results else {
            return "results: errors not estimated; `fem study` shows them".to_owned();
        };
        let of = |errors: Option<ResultErrors>| errors.map_or(0.0, |errors| errors.force_history_L2_relative);
        let sources = [
            ("step", a.results_of_step),
            ("reduction", a.results_of_reduction),
            ("mesh", a.results_of_mesh),
            ("layers", a.results_of_layers),
        ];
        let most = sources.into_iter().max_by(|x, y| of(x.1).total_cmp(&of(y.1))).map_or("mesh", |(name, _)| name);
        let percent = |error: f64| format!("{:.2} %", 1e2 * error);
        format!(
            "results: peak force within about {}, force history {}, impulse {}, deflection {}; most from the {most}",
            percent(all.peak_force_relative),
            percent(all.force_history_L2_relative),
            percent(all.impulse_relative),
            percent(all.deflection_relative),
        )
    }
}
