//! The same flights with the law on emulated boards, bit for bit: `cargo test-emulated`. It needs
//! `qemu-system-arm` and a compiler for thumbv7em.

mod common;
mod failsafe;
mod mission;
mod route;

use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use common::{Ending, OPTIONS, flights, fly_here, fly_there, scenario};
use hil_sim::hil::{Emulator, Endpoint, HilError, Options, Target};

/// The firmware's images by QEMU's machines, built once.
fn images() -> &'static [(&'static str, PathBuf); 3] {
    static IMAGES: OnceLock<[(&str, PathBuf); 3]> = OnceLock::new();
    IMAGES.get_or_init(|| {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..");
        let build = |board: &str| {
            let status = Command::new(env!("CARGO"))
                .args(["xtask", "thumb", "build", "--quiet", "--release", "--package", "firmware"])
                .args(["--no-default-features", "--features", board])
                .current_dir(&root)
                .status()
                .expect("cargo runs");
            assert!(status.success(), "the firmware for {board} does not build");
            let built = root.join("firmware/target/thumbv7em-none-eabihf/release/firmware");
            let kept = std::env::temp_dir().join(format!("firmware-{board}-{}.elf", std::process::id()));
            std::fs::copy(built, &kept).expect("the image is where it is built");
            kept
        };
        let f405 = build("stm32f405");
        let mps2 = build("mps2");
        [("netduinoplus2", f405), ("mps2-an386", mps2.clone()), ("mps2-an500", mps2)]
    })
}

fn emulated(machine: &str, image: &Path, options: Options) -> Target {
    Target::emulated(Emulator::start(machine, image, false).unwrap(), options).unwrap()
}

/// Seconds of each figure that are flown in each emulator, or another number from the environment.
/// Fig. 2's obstacle is at 5 s; Figs 2 and 3 last 20 s and 10 s, and Figs 5 and 6, 132 s, are
/// steady by 20.
fn emulated_s(machine: &str) -> f64 {
    match std::env::var("EMULATED_S") {
        Ok(text) => text.parse().expect("EMULATED_S is a number of seconds"),
        Err(_) if machine == "netduinoplus2" => 20.0,
        Err(_) => 6.0,
    }
}

#[test]
fn the_figures_are_the_same_on_every_emulated_board() {
    for (machine, image) in images() {
        let mut target = emulated(machine, image, OPTIONS);
        for scenario in flights(emulated_s(machine)) {
            let (commands, back) = fly_there(&scenario, target);
            assert_eq!(commands.unwrap(), fly_here(&scenario), "{} on {machine}", scenario.name);
            target = back;
        }
    }
}

#[test]
fn a_mission_from_ground_to_ground_is_the_same_on_every_emulated_board() {
    let here = mission::fly_here();
    mission::check(&here);
    for (machine, image) in images() {
        let mut target = emulated(machine, image, OPTIONS);
        target.prepare(&mission::scenario()).unwrap();
        let there = mission::fly(|measured, request, t_s| target.fly(measured, request, t_s).unwrap());
        assert_eq!(there, here, "on {machine}");
    }
}

#[test]
fn on_its_instruments_an_emulated_board_flies_as_the_program_here() {
    // Up, found the rod, and on the path.
    let scenario = scenario("on-instruments", 25.0);
    let here = Target::connect(Endpoint::Here, None, OPTIONS).unwrap();
    let (here, _) = fly_there(&scenario, here);
    let [_, (machine, image), _] = images();
    let (there, _) = fly_there(&scenario, emulated(machine, image, OPTIONS));
    assert!(there.unwrap() == here.unwrap(), "another flight on {machine}");
}

#[test]
fn a_route_is_uploaded_and_flown_to_its_end_on_an_emulated_board() {
    let (here, there) = UnixStream::pair().expect("sockets");
    std::thread::spawn(move || hil_sim::hil::serve(there));
    let soft = Target::over(Endpoint::Unix("the other thread".into()), Box::new(here), OPTIONS).unwrap();
    let (here, ..) = route::flown_there(soft);
    let [(machine, image), ..] = images();
    let (there, ..) = route::flown_there(emulated(machine, image, OPTIONS));
    assert!(there == here, "another flight on {machine}");
}

#[test]
fn each_failsafe_has_its_end_on_an_emulated_board() {
    let [(machine, image), ..] = images();
    let mut emulator = Emulator::start(machine, image, false).unwrap();
    failsafe::fly(emulator.open(OPTIONS.patience).unwrap());
}

#[test]
fn a_killed_emulator_ends_the_flight() {
    let [(machine, image), ..] = images();
    let target = emulated(machine, image, OPTIONS);
    let process = target.emulator_id().expect("it is emulated").to_string();
    let killer = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_secs(3));
        Command::new("kill").args(["-9", &process]).status()
    });
    let begun = Instant::now();
    let (commands, _) = fly_there(&scenario("fig5", 1e3), target);
    let error = commands.expect_err("the emulator was killed");
    assert!(matches!(error, HilError::EmulatorDied { .. }), "{error}");
    assert!(begun.elapsed() < Duration::from_secs(3) + OPTIONS.patience + Duration::from_secs(5));
    assert!(killer.join().is_ok_and(|status| status.is_ok_and(|status| status.success())));
}

#[test]
fn a_cut_line_is_mended_and_nothing_is_lost() {
    let [_, (machine, image), _] = images();
    let path = std::env::temp_dir().join(format!("hil-test-{}-cut.sock", std::process::id()));
    let _ = std::fs::remove_file(&path);
    // As a user's own emulator, on a line that can be cut.
    let mut emulator = Command::new("qemu-system-arm")
        .args(["-machine", machine, "-display", "none", "-monitor", "none", "-kernel"])
        .arg(image)
        .args(["-serial", &format!("unix:{},server=on,wait=on", path.display())])
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let stream = (0..100)
        .find_map(|_| {
            std::thread::sleep(Duration::from_millis(50));
            UnixStream::connect(&path).ok()
        })
        .expect("the emulator opens its socket");
    let wire = Ending { stream: Some(stream), reads: 1_500 };
    let target = Target::over(Endpoint::Unix(path.clone()), Box::new(wire), OPTIONS).unwrap();
    let scenario = scenario("fig3a", 2.0);
    let (commands, target) = fly_there(&scenario, target);
    assert_eq!(commands.unwrap(), fly_here(&scenario));
    assert_eq!(target.statistics().reconnections, 1);
    let _ = emulator.kill();
    let _ = emulator.wait();
    let _ = std::fs::remove_file(path);
}
