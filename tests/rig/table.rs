//! The table of parameters: every range and default is the controller's, every name its own, and
//! every number its own place.

use std::collections::HashSet;

use controller::{ApproachLimits, EnvelopeParams, ObserverParams, Policy, Sampling, VehicleParams, ranges};
use rig::{COUNT, Kind, Parameter, Parameters, Refused, Rig, Shape, Tabled, parameter, run};

#[test]
fn defaults_are_the_controllers() {
    fn of<T: Tabled>() -> Parameters<T> {
        Parameters::default()
    }
    let get = |parameter| of::<f64>().get(parameter);
    let VehicleParams { payload_mass, uav_mass, rod_length, inertia, gravity } = VehicleParams::<f64>::paper();
    assert_eq!(of::<f64>().run(run!("VEH_M_LOAD" to "VEH_ROD")), [payload_mass, uav_mass, rod_length]);
    assert_eq!((of::<f64>().run(run!("VEH_J1" to "VEH_J3")), get(parameter!("VEH_G"))), (inertia, gravity));
    let Sampling { period, latency, rotor_lag, look_ahead } = Sampling::every(get(parameter!("CTL_PERIOD")));
    assert_eq!(of::<f64>().run(run!("CTL_PERIOD" to "CTL_LAG")), [period, latency, rotor_lag]);
    assert_eq!(of::<f64>().is_on(parameter!("CTL_AHEAD")), look_ahead);
    let observer = ObserverParams::with_bandwidth(get(parameter!("OBS_W_LOAD")));
    assert_eq!(of::<f64>().observer(), observer);
    assert_eq!(of::<f64>().envelope(), EnvelopeParams::wide());
    assert_eq!(of::<f32>().envelope(), EnvelopeParams::wide());
    assert_eq!(of::<f64>().approach(), ApproachLimits::gentle());
    assert_eq!(of::<f32>().approach(), ApproachLimits::gentle());
    assert_eq!(of::<f64>().policy(), Policy::default());
    assert_eq!(of::<f32>().policy(), Policy::default());
    assert_eq!(of::<f64>().gains(), controller::Gains::spread(ranges::BANDWIDTH.default()).unwrap());
}

/// What the controller's constructors take alone, at its ends and just beyond, is what the table
/// takes.
#[test]
fn the_controller_takes_each_number_up_to_the_table_s_ends() {
    // Those that also depend on others: bands on each other, a law on its gains, the rotors' and
    // the thrusts' on what can hover, a route on its table.
    let dependent = |name: &str| {
        ["ENV_", "ROT_", "LIM_", "K", "CTL_LAW", "VEH_", "FOU_", "PATH_NRM", "PATH_MAJ", "PATH_KIND"]
            .iter()
            .any(|prefix| name.starts_with(prefix))
    };
    for (index, (entry, _)) in Parameters::<f64>::default().iter().enumerate() {
        let name = entry.name.as_str();
        for end in [entry.min, entry.max] {
            let mut parameters = Parameters::default();
            let parameter = Parameter::at(index).unwrap();
            parameters.set(parameter, end).unwrap();
            // A latency is at most so many periods.
            if name == "CTL_LATENCY" {
                parameters.set(parameter!("CTL_PERIOD"), 0.02).unwrap();
            }
            for shape in Shape::ALL {
                if name != "PATH_KIND" {
                    parameters.set(parameter!("PATH_KIND"), f64::from(shape as u8)).unwrap();
                }
                let made = Rig::new(&parameters);
                let bent_is_shorter = shape == Shape::Bent && matches!(name, "PATH_A" | "PATH_B");
                assert!(made.is_ok() || dependent(name) || bent_is_shorter, "{name} = {end}: {made:?}");
            }
        }
        let mut parameters = Parameters::default();
        for beyond in [entry.min.next_down(), entry.max.next_up(), f64::NAN] {
            let refused = parameters.set(Parameter::at(index).unwrap(), beyond);
            assert!(matches!(refused, Err(Refused::OutOfRange(..))), "{name} = {beyond}");
        }
    }
}

#[test]
fn a_refused_number_is_told_by_its_parameter_s_name() {
    for (parameter, value, name) in [
        (parameter!("ENV_TENS_LIM"), 0.5, "ENV_TENS_WARN"),
        (parameter!("ENV_ROD_WARN"), 1.3, "ENV_ROD_WARN"),
        (parameter!("ROT_W_MIN"), 1000.0, "ROT_W_MIN"),
        (parameter!("LIM_T_MAX"), 20.0, "max_thrust"),
        (parameter!("K2_3"), -1.0, "K2_0"),
        (parameter!("KI_3"), 1e6, "KI_3"),
    ] {
        let mut parameters = Parameters::<f32>::default();
        parameters.set(parameter, value).unwrap();
        let refused = Rig::new(&parameters).expect_err(name).to_string();
        assert!(refused.starts_with(name) && refused.len() <= 50, "{refused}");
    }
}

#[test]
fn names_are_its_own_and_fit_mavlink() {
    let names: HashSet<&str> = f32::table().iter().map(|entry| entry.name.as_str()).collect();
    assert_eq!(names.len(), COUNT);
    for (index, (narrow, wide)) in f32::table().iter().zip(f64::table()).enumerate() {
        let name = narrow.name.as_str();
        assert!(name.len() <= 16 && Parameter::find(name).map(Parameter::index) == Some(index), "{name}");
        assert_eq!((narrow.default, narrow.min, narrow.max), (wide.default as f32, wide.min as f32, wide.max as f32));
        assert!(narrow.text.ends_with('.') && narrow.text.len() <= 110, "{name}: {}", narrow.text);
    }
    assert_eq!(Parameter::find("FOU_S8_3"), Some(parameter!("FOU_S8_3")));
}

#[test]
fn what_takes_whole_numbers_takes_no_others() {
    for (index, entry) in f32::table().iter().enumerate() {
        let between = Parameters::default()
            .set(Parameter::at(index).unwrap(), entry.min + 0.5 * (entry.max - entry.min).min(1.0));
        assert_eq!(
            matches!(between, Err(Refused::NotWhole(..))),
            entry.kind != Kind::Real,
            "{}",
            entry.name.as_str()
        );
    }
}

#[test]
fn every_shape_is_made_of_its_own_fields() {
    for shape in Shape::ALL {
        assert_eq!(Shape::named(shape.name()), Some(shape));
        let mut parameters = Parameters::<f64>::default();
        parameters.set(parameter!("PATH_KIND"), f64::from(shape as u8)).unwrap();
        assert_eq!(Shape::of(&parameters), shape);
        // Each of its fields makes another curve; of a direction, only what turns it.
        let curve = |parameters: &Parameters<f64>| rig::AnyCurve::<f64>::new(parameters).unwrap();
        for field in shape.fields() {
            let makes_another = field.parameters().any(|parameter| {
                let mut other = parameters.clone();
                other.set(parameter, parameters.get(parameter) + 1.0).unwrap();
                curve(&other) != curve(&parameters)
            });
            assert!(makes_another, "{} {}", shape.name(), field.name);
        }
    }
}
