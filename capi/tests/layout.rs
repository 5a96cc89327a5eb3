//! The header's structures are laid out as the library's: every size and offset, as a C compiler
//! has them.

use std::fmt::Write as _;
use std::mem::{offset_of, size_of};
use std::process::Command;

use capi::types::{
    SlungError, SlungEstimate, SlungFix, SlungMounting, SlungNavigated, SlungNavigationSettings, SlungOutput,
    SlungPace, SlungParameter, SlungProgress, SlungState, SlungTelemetry, SlungUav, SlungWaypoint, SlungWrench,
};

/// What `layout.c` prints, by Rust.
fn layout() -> String {
    let mut text = String::new();
    macro_rules! lay {
        ($($name:literal $type:ident { $($field:ident)* })*) => {
            $(
                writeln!(text, "{} {}", $name, size_of::<$type>()).unwrap();
                $(writeln!(text, "{}.{} {}", $name, stringify!($field), offset_of!($type, $field)).unwrap();)*
            )*
        };
    }
    lay! {
        "slung_error" SlungError { struct_size status field value min max waypoint }
        "slung_parameter" SlungParameter { struct_size default_value min max name unit text }
        "slung_uav" SlungUav { position_world_m velocity_world_m_s quaternion_body_to_world body_rate_rad_s }
        "slung_state" SlungState { payload_position_ned_m payload_velocity_ned_m_s rod_ned rod_rate_ned_1_s attitude_frd_to_ned body_rate_frd_rad_s }
        "slung_wrench" SlungWrench { thrust_n torque_frd_n_m }
        "slung_output" SlungOutput { struct_size mode fault warning limited thrust_n torque_frd_n_m angular_acceleration_frd_rad_s2 body_rate_setpoint_frd_rad_s thrust_normalized torque_normalized_frd rotor }
        "slung_progress" SlungProgress { struct_size run runs rests is_over speed_factor nearest_ned_m }
        "slung_telemetry" SlungTelemetry { struct_size law_flew xi nu u_zeta_m_s6 zeta margin_rod margin_thrust_axis margin_lambda_m_s2 margin_kappa_1_s2 margin_path margin_reach payload_force_ned_n uav_force_ned_n torque_frd_n_m implied_payload_mass_kg }
        "slung_waypoint" SlungWaypoint { point_ned_m corner_m speed_m_s yaw_rad stop_s }
        "slung_pace" SlungPace { acceleration_m_s2 stop_rate_1_s rise_s }
        "slung_mounting" SlungMounting { hook_frd_m imu_frd_m uav_drag payload_drag }
        "slung_estimate" SlungEstimate { struct_size validity taut tension_n rod_deviation_rad rate_deviation_1_s state uav }
        "slung_navigation_settings" SlungNavigationSettings { struct_size imu_frd_m antenna_frd_m declination_rad accelerometer_m_s2_rthz gyro_rad_s_rthz accelerometer_walk_m_s2_rts gyro_walk_rad_s_rts fix_position_m fix_velocity_m_s heading_rad barometer_m barometer_time_s start_position_m start_velocity_m_s start_tilt_rad start_heading_rad start_gyro_rad_s start_accelerometer_m_s2 }
        "slung_fix" SlungFix { position_world_m velocity_world_m_s position_deviation_m velocity_deviation_m_s age_s }
        "slung_navigated" SlungNavigated { struct_size blind resets fix_age_s position_deviation_m velocity_deviation_m_s tilt_deviation_rad gyro_bias_body_rad_s accelerometer_bias_body_m_s2 specific_force_body_m_s2 uav }
    }
    text
}

#[test]
fn a_c_compiler_lays_the_structures_out_as_the_library_does() {
    let folder = env!("CARGO_MANIFEST_DIR");
    let program = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("layout");
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let compiled = Command::new(&compiler)
        .args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-I"])
        .arg(format!("{folder}/include"))
        .arg(format!("{folder}/tests/layout.c"))
        .arg("-o")
        .arg(&program)
        .output()
        .unwrap_or_else(|error| panic!("{compiler}: {error}"));
    assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
    let printed = String::from_utf8(Command::new(&program).output().unwrap().stdout).unwrap();
    // Storage that is the caller's: large enough, or for knots and runs, just so large.
    let lent = [
        "slung_parameters ",
        "slung_controller ",
        "slung_route ",
        "slung_estimator ",
        "slung_navigation ",
        "slung_knot ",
        "slung_run ",
    ];
    let (instances, structures): (Vec<_>, Vec<_>) =
        printed.lines().partition(|line| lent.iter().any(|name| line.starts_with(name)));
    let bytes = |line: &&str| line.rsplit(' ').next().unwrap().parse::<usize>().unwrap();
    let [knot, run] = [size_of::<controller::Knot<f32>>(), size_of::<controller::Run<f32>>()];
    assert_eq!(
        instances.iter().map(bytes).collect::<Vec<_>>(),
        [
            capi::PARAMETERS_BYTES,
            capi::CONTROLLER_BYTES,
            capi::ROUTE_BYTES,
            capi::ESTIMATOR_BYTES,
            capi::NAVIGATION_BYTES,
            knot,
            run
        ]
    );
    assert!(capi::slung_parameters_bytes() <= capi::PARAMETERS_BYTES);
    assert!(capi::slung_controller_bytes() <= capi::CONTROLLER_BYTES);
    assert!(capi::slung_route_bytes() <= capi::ROUTE_BYTES);
    assert!(capi::slung_estimator_bytes() <= capi::ESTIMATOR_BYTES);
    assert!(capi::slung_navigation_bytes() <= capi::NAVIGATION_BYTES);
    assert_eq!(structures.join("\n") + "\n", layout());
}
