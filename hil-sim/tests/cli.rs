//! The program as its users meet it: commands, files, messages, exit statuses.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A folder of this test's own, empty.
fn folder(test: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder for the test");
    folder
}

fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_hil-sim"))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

fn evaluate(lines: &str) -> Output {
    let mut child = program()
        .arg("eval")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(lines.as_bytes()).expect("it reads");
    child.wait_with_output().expect("it ends")
}

/// A flight of half a second.
const SHORT: &str = r#"
duration_s = 0.5
path = { kind = "circle", radius = 5.0, p3 = -10.0, speed = -5.0 }
[controller]
law = "follow"
"#;

const POINT: &str = r#"{"law":"follow","arithmetic":"f32","vehicle":{"payload_mass":0.5,"uav_mass":2.5,"inertia":[0.03,0.03,0.05],"rod_length":2.0,"gravity":9.81},"path":{"kind":"circle","radius":5.0,"p3":-10.0,"speed":1.0},"x":[0,9,-10,0,0,0,0,0,0,0,0,0,0,0,0,0],"zeta":[0,0,0,0],"gains":{"k":[[64,192,240,160,60,12],[64,192,240,160,60,12],[1,5,10,10,5],[1,2]]}}"#;

/// Runs a scenario of this text, which is to be refused, and returns the message.
fn refused(test: &str, scenario: &str) -> String {
    let folder = folder(test);
    let file = folder.join("flight.toml");
    fs::write(&file, scenario).expect("a file");
    let output = program().arg("run").arg(&file).arg("--out").arg(folder.join("out")).output().expect("it starts");
    assert!(!output.status.success(), "{test} was accepted");
    assert!(!folder.join("out").exists(), "{test} left a report");
    text(&output.stderr)
}

#[test]
fn a_name_that_is_unknown_is_answered_with_those_that_are_known() {
    for (command, known) in
        [("run", "figure-eight"), ("check", "fig3a"), ("tune", "fig3a"), ("campaign", "ground-to-ground")]
    {
        let output = program().args([command, "fig-of-eight"]).output().expect("it starts");
        let message = text(&output.stderr);
        assert!(!output.status.success() && message.contains("fig-of-eight: "), "{message}");
        assert!(message.contains(known), "{message}");
    }
}

#[test]
fn help_has_examples_for_each_command() {
    for command in [&[][..], &["run"], &["figures"], &["eval"]] {
        let output = program().args(command).arg("--help").output().expect("it starts");
        assert!(output.status.success());
        assert!(text(&output.stdout).contains("Examples:"), "{command:?}");
    }
}

#[test]
fn unknown_commands_and_options_are_refused() {
    for arguments in [&["fly"][..], &["run"], &["--speed", "3"]] {
        let output = program().args(arguments).output().expect("it starts");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn a_run_leaves_log_figure_page_and_summary() {
    let folder = folder("run");
    fs::write(folder.join("short.toml"), SHORT).expect("a file");
    let out = folder.join("out");
    let output =
        program().arg("run").arg(folder.join("short.toml")).arg("--out").arg(&out).output().expect("it starts");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("short"));
    assert_eq!(text(&output.stderr), "", "no progress bar where standard error is no terminal");

    let names: Vec<String> =
        fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    for name in ["short.csv", "short.svg", "report.html", "summary.json"] {
        assert!(names.iter().any(|other| other == name), "{name} in {names:?}");
    }
    assert!(!names.iter().any(|name| name.ends_with(".partial")), "{names:?}");

    let log = fs::read_to_string(out.join("short.csv")).unwrap();
    // A line every 10 ms, the last and the heading; all as long as the heading.
    assert_eq!(log.lines().count(), 52);
    let fields = |line: &str| line.split(',').count();
    assert!(log.lines().all(|line| fields(line) == fields(log.lines().next().unwrap())));

    let summary: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    let run = &summary["runs"][0];
    assert_eq!((run["scenario"].as_str(), run["law"].as_str()), (Some("short"), Some("follow")));
    for key in ["effort_n_s", "peak_u", "min_thrust_n", "peak_torque_nm", "f32_f64_max_relative", "times_real_time"] {
        assert!(run[key].is_f64(), "{key} in {run}");
    }
    assert!(run.get("settle_s").is_none(), "4 m away after half a second: {run}");

    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        page.contains("id=\"flights\"") && !page.contains("src=") && !page.contains("href="),
        "the page is not self-contained"
    );
}

#[test]
fn quiet_is_silent() {
    let folder = folder("quiet");
    let arguments = ["run", "fig3a", "--quiet", "--out"];
    let output = program().args(arguments).arg(folder.join("out")).output().expect("it starts");
    assert!(output.status.success());
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
}

#[test]
fn scenario_errors_name_file_line_and_field() {
    let cases: [(&str, String, usize, &str); 13] = [
        ("unknown-key", SHORT.replace("duration_s", "duration"), 2, "duration"),
        ("unknown-controller-key", format!("{SHORT}speed = 3\n"), 6, "controller.speed"),
        ("unknown-path-key", SHORT.replace("radius", "radios"), 3, "path.radios"),
        ("radius", SHORT.replace("5.0, p3", "-5.0, p3"), 3, "path.radius"),
        ("duration", SHORT.replace("0.5", "-1"), 2, "duration_s"),
        ("no-number", SHORT.replace("0.5", "nan"), 2, "duration_s"),
        ("rate", format!("{SHORT}rate_hz = 1e6\n"), 6, "controller.rate_hz"),
        ("told-mass", format!("{SHORT}vehicle = {{ payload_mass = 0.0 }}\n"), 6, "controller.vehicle.payload_mass"),
        ("pole", format!("{SHORT}poles = [[-1], [-1], [-1], [-1]]\n"), 6, "controller.poles[0]"),
        ("type", format!("{SHORT}rate_hz = \"fast\"\n"), 6, "controller.rate_hz"),
        ("table", SHORT.replace("{ kind", "[] # { kind"), 3, "path: invalid length 0, expected a table"),
        ("kind", SHORT.replace("\"circle\"", "\"square\""), 3, "path.kind"),
        ("reference", SHORT.replace("path =", "reference ="), 3, "reference"),
    ];
    for (test, scenario, line, field) in cases {
        let message = refused(test, &scenario);
        assert!(message.contains(&format!("flight.toml:{line}: ")), "{test}: {message}");
        assert!(message.contains(field), "{test}: {message}");
    }
}

#[test]
fn values_out_of_range_are_refused_with_value_and_range() {
    let message = refused("range", &SHORT.replace("0.5", "-1"));
    assert!(message.contains("-1 is outside 0.01 to 100000"), "{message}");
}

#[test]
fn an_integral_gain_that_is_too_large_is_refused_with_its_limit() {
    // K̃ of Figs 5 and 6 with the poles of Fig. 3: stable below 42.2.
    let message = refused("integral", &format!("{SHORT}k_integral = [120.0, 100.0, 40.0]\n"));
    assert!(message.contains("controller.k_integral[0]") && message.contains("42.2"), "{message}");
}

#[test]
fn text_that_is_no_toml_is_refused_with_its_line() {
    let message = refused("toml", "duration_s = 1\npath = = 2\n");
    assert!(message.contains("flight.toml:2: "), "{message}");
}

#[test]
fn a_missing_file_is_named() {
    let output = program().args(["run", "nowhere.toml"]).output().expect("it starts");
    assert!(!output.status.success());
    assert!(text(&output.stderr).contains("nowhere.toml"));
}

#[test]
fn eval_answers_in_order_and_fails_at_the_end_if_a_line_was_bad() {
    let bad = POINT.replace("\"radius\":5.0", "\"radius\":-5.0");
    let output = evaluate(&format!("{POINT}\n{bad}\nnot json\n{POINT}"));
    assert_eq!(output.status.code(), Some(1));
    let stdout = text(&output.stdout);
    let lines: Vec<serde_json::Value> =
        stdout.lines().map(|line| serde_json::from_str(line).expect("an object a line")).collect();
    assert_eq!(lines.len(), 4);
    assert_eq!(lines[0], lines[3]);
    assert!(lines[1]["error"].as_str().is_some_and(|error| error.contains("path.radius")), "{}", lines[1]);
    assert!(lines[2]["error"].is_string());
    assert!((lines[0]["thrust"].as_f64().unwrap() - 29.43).abs() < 1e-4);
    assert_eq!(lines[0]["xi"].as_array().map(Vec::len), Some(19));
}

#[test]
fn eval_of_good_lines_succeeds() {
    let output = evaluate(&format!("\u{feff}{POINT}\n{POINT}\n"));
    assert!(output.status.success(), "a byte order mark is no fault");
    assert_eq!(text(&output.stdout).lines().count(), 2);
}

/// An answer for each line, so that who counts them is not mistaken; and nothing guessed.
#[test]
fn eval_answers_empty_lines_and_refuses_what_could_be_meant_in_two_ways() {
    let twice = POINT.replace("\"radius\":5.0", "\"radius\":5.0,\"radius\":6.0");
    let list = POINT.replace(
        "{\"payload_mass\":0.5,\"uav_mass\":2.5,\"inertia\":[0.03,0.03,0.05],\"rod_length\":2.0,\"gravity\":9.81}",
        "[0.5,2.5,2.0,[0.03,0.03,0.05],9.81]",
    );
    assert!(list != POINT);
    let output = evaluate(&format!("{POINT}\n\n{twice}\n{list}\n[]\n{POINT}\n"));
    assert_eq!(output.status.code(), Some(1));
    let stdout = text(&output.stdout);
    let lines: Vec<serde_json::Value> =
        stdout.lines().map(|line| serde_json::from_str(line).expect("an object a line")).collect();
    assert_eq!(lines.len(), 6);
    assert_eq!(lines[0], lines[5]);
    for (line, message) in
        [(1, "empty"), (2, "\"radius\" is given twice"), (3, "vehicle: a list"), (4, "line: a list")]
    {
        assert!(lines[line]["error"].as_str().is_some_and(|error| error.contains(message)), "{}", lines[line]);
    }
}

/// Below zero, too, which is a value and no option.
#[test]
fn a_number_that_an_option_does_not_take_is_answered_with_its_range() {
    for (arguments, range) in [
        (&["campaign", "--runs", "-1"][..], "a whole number from 1 to 100000000"),
        (&["campaign", "--seed", "-1"], "a whole number from 0 to 18446744073709551615"),
        (&["compare", "--jobs", "0"], "a whole number from 1 to 4096"),
        (&["compare", "--bandwidth", "nan"], "a number from 0.01 to 100 rad/s"),
        (&["estimate", "--runs", "1e9"], "a whole number from 1 to 100000"),
        (&["policies", "--runs", "0"], "a whole number from 1 to 100000"),
        (&["tune", "--scales", "-1,2"], "a number from 0.01 to 100"),
        (&["tune", "--bandwidths", "4,1e9"], "a number from 0 to 100 rad/s"),
        (&["fit", "points.csv", "--tolerance", "-1"], "a number from 0.000001 to 1000 m"),
        (&["route", "points.csv", "--terrain", "-1e9"], "a number from -10000 to 10000 m"),
        (&["replay", "log.csv", "--from", "nan"], "a number from -10000000000 to 10000000000 s"),
        (&["hil", "--baud", "0"], "a whole number from 300 to 20000000 baud"),
        (&["hil", "--patience", "-1"], "a number from 0.1 to 3600 s"),
        (&["calibrate", "log.csv", "--uav-mass", "-1", "--payload-mass", "1"], "a number from 0.01 to 1000 kg"),
    ] {
        let output = program().args(arguments).output().expect("it starts");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = text(&output.stderr);
        assert!(said.lines().next().is_some_and(|line| line.ends_with(range)), "{arguments:?}: {said}");
    }
}

#[test]
fn a_ground_station_that_nothing_reaches_is_named() {
    for address in ["nowhere", "127.0.0.1:0"] {
        let output = program().args(["hil", &format!("--station={address}"), "--quiet"]).output().expect("it starts");
        assert_eq!(output.status.code(), Some(1), "{address}");
        assert!(text(&output.stderr).contains(address), "{}", text(&output.stderr));
    }
}

/// Long before the hours that the flights would take.
#[test]
fn a_folder_that_cannot_be_written_to_is_named_before_anything_is_flown() {
    let folder = folder("unwritable");
    let endless = SHORT.replace("duration_s = 0.5", "duration_s = 100000.0\nlog_period_s = 10.0");
    fs::write(folder.join("endless.toml"), endless).expect("a file");
    fs::write(folder.join("file"), "").expect("a file");
    fs::write(folder.join("points.csv"), "1,0,-10\n0,2,-10\n-1,0,-10\n0,-2,-11\n").expect("a file");
    let out = folder.join("file/out");
    let commands: [&[&str]; 7] = [
        &["run", "endless.toml"],
        &["tune", "endless.toml", "--runs", "100000"],
        &["compare", "--runs", "100000"],
        &["policies", "--runs", "100000"],
        &["estimate", "--runs", "100000"],
        &["campaign", "--runs", "100000000"],
        &["fit", "points.csv"],
    ];
    for arguments in commands {
        let output =
            program().current_dir(&folder).args(arguments).arg("--out").arg(&out).output().expect("it starts");
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(text(&output.stderr).contains("file/out"), "{arguments:?}: {}", text(&output.stderr));
    }
}

/// A law that is called five times a second is no law for this vehicle.
#[test]
fn a_flight_that_is_lost_ends_with_a_report_of_numbers_that_says_so() {
    let folder = folder("lost");
    let slow = SHORT.replace("duration_s = 0.5", "duration_s = 40.0") + "rate_hz = 5.0\n";
    fs::write(folder.join("slow.toml"), slow.replace("speed = -5.0", "speed = 1.0")).expect("a file");
    let out = folder.join("out");
    let output =
        program().arg("run").arg(folder.join("slow.toml")).arg("--out").arg(&out).output().expect("it starts");
    assert_eq!(output.status.code(), Some(1));
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    let failure = summary["runs"][0]["failure"].as_str().expect("a failure");
    assert!(failure.starts_with("lost at ") && failure.ends_with(" s"), "{failure}");
    for said in [text(&output.stderr), fs::read_to_string(out.join("report.html")).unwrap()] {
        assert!(said.contains(failure), "{failure} in {said}");
    }
    let log = fs::read_to_string(out.join("slow.csv")).unwrap();
    assert!(!log.contains("NaN") && !log.contains("inf"), "{log}");
}

/// 39.2 N to lift, 36 N of rotors.
#[test]
fn a_vehicle_that_cannot_lift_its_load_is_refused_by_check_and_run_alike() {
    let folder = folder("overweight");
    let rotors = "[actuators.rotors]\nlayout = \"quad-x\"\narm_m = 0.2\ndrag_m = 0.02\nmax_thrust = 9.0\n";
    let heavy =
        SHORT.replace("speed = -5.0", "speed = 1.0").replace("path =", "vehicle = { payload_mass = 1.5 }\npath =");
    fs::write(folder.join("heavy.toml"), heavy + rotors).expect("a file");
    let out = folder.join("out");
    let ask = |arguments: &[&str]| {
        program().current_dir(&folder).args(arguments).arg("--out").arg(&out).output().expect("it starts")
    };
    for command in ["check", "run"] {
        let output = ask(&[command, "heavy.toml"]);
        assert_eq!(output.status.code(), Some(1), "{command}");
        let said = text(&output.stderr);
        assert!(said.contains("thrust 39.2") && said.contains("limit of 36.000 N"), "{command}: {said}");
        assert!(!out.exists(), "{command}");
    }
    let flown = ask(&["run", "heavy.toml", "--unchecked"]);
    assert!(flown.status.success() && text(&flown.stderr).contains("36.000 N"), "{}", text(&flown.stderr));
    assert!(out.join("heavy.csv").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_complete_files_of_the_flights_that_were_done() {
    use std::time::{Duration, Instant};
    let folder = folder("interrupt");
    // More flight than a test would wait for.
    let endless = SHORT.replace("duration_s = 0.5", "duration_s = 50000.0\nlog_period_s = 10.0");
    fs::write(folder.join("endless.toml"), endless).expect("a file");
    let out = folder.join("out");
    let mut child = program()
        .arg("run")
        .arg(folder.join("endless.toml"))
        .arg("--out")
        .arg(&out)
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .expect("the program starts");
    std::thread::sleep(Duration::from_millis(500));
    let asked = Instant::now();
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is there");
    assert!(kill.success());
    let status = child.wait().expect("it ends");
    assert!(asked.elapsed() < Duration::from_secs(5), "it took {:?} to stop", asked.elapsed());
    assert_eq!(status.code(), Some(130));
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["runs"].as_array().map(Vec::len), Some(0));
    assert!(out.join("report.html").exists());
}

#[test]
fn the_examples_of_eval_can_be_evaluated() {
    let help = text(&program().args(["eval", "--help"]).output().expect("it starts").stdout);
    let lines: Vec<&str> = help.split('\'').filter(|part| part.starts_with("{\"law\"")).collect();
    assert_eq!(lines.len(), 2);
    let output = evaluate(&lines.join("\n"));
    assert!(output.status.success(), "{}", text(&output.stdout));
}

#[test]
fn what_a_target_can_not_fly_is_named_before_anything_is_flown() {
    let output = program()
        .args(["hil", "fig3a", "bent", "--connect", "unix:/no/such/socket"])
        .output()
        .expect("the program starts");
    assert!(!output.status.success());
    let errors = text(&output.stderr);
    assert!(errors.contains("bent: a curve by formula"), "{errors}");
}

#[test]
fn without_a_name_a_target_flies_what_it_can() {
    let output = program().args(["hil", "--connect", "unix:/no/such/socket"]).output().expect("the program starts");
    let errors = text(&output.stderr);
    assert!(errors.contains("cannot connect to unix:/no/such/socket"), "{errors}");
}

/// Something that is called as the emulator is, and says its process number.
#[cfg(target_os = "linux")]
#[test]
fn a_killed_program_takes_its_emulator_with_it() {
    use std::os::unix::fs::PermissionsExt;
    use std::time::{Duration, Instant};
    let folder = folder("orphan");
    let (emulator, number) = (folder.join("qemu-system-arm"), folder.join("number"));
    let script = format!("#!/bin/sh\necho $$ > {}.new\nmv {0}.new {0}\nexec sleep 600\n", number.display());
    fs::write(&emulator, script).expect("a file");
    fs::set_permissions(&emulator, fs::Permissions::from_mode(0o755)).expect("it can be run");
    let path = format!("{}:{}", folder.display(), std::env::var("PATH").expect("a path"));
    let mut child = program()
        .env("PATH", path)
        .args(["hil", "fig3a", "--patience", "60", "--emulate"])
        .arg(&emulator)
        .arg("--out")
        .arg(folder.join("out"))
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let begun = Instant::now();
    let process = loop {
        match fs::read_to_string(&number) {
            Ok(text) => break text.trim().to_owned(),
            Err(_) => assert!(begun.elapsed() < Duration::from_secs(20), "no emulator was started"),
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let runs = || {
        let state = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
        !(state.is_empty() || state.contains(") Z "))
    };
    assert!(runs());
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    let killed = Instant::now();
    while runs() {
        assert!(killed.elapsed() < Duration::from_secs(5), "the emulator runs on");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn a_mission_becomes_a_scenario_that_is_checked_and_flown() {
    let folder = folder("mission");
    let (file, route, map) = (folder.join("m.csv"), folder.join("route.toml"), folder.join("map.svg"));
    fs::write(&file, "lat,lon,alt_rel\n53.527,-113.529,10\n53.5272,-113.529,10\n53.5272,-113.5286,12\n")
        .expect("a file");
    let run = |arguments: &[&str]| program().current_dir(&folder).args(arguments).output().expect("it starts");
    let unplaced = run(&["route", "m.csv"]);
    assert!(!unplaced.status.success() && text(&unplaced.stderr).contains("--home"), "{}", text(&unplaced.stderr));
    let home = "--home=53.527,-113.529,668";
    let written = run(&["route", "m.csv", home, "--out", "route.toml", "--svg", "map.svg"]);
    assert!(written.status.success(), "{}", text(&written.stderr));
    assert!(fs::read_to_string(&map).expect("a map").starts_with("<svg"));
    for (option, begin) in [("--rust", "/// The route of m.csv"), ("--c", "/* The route of m.csv")] {
        let printed = run(&["route", "m.csv", home, option, "--quiet"]);
        assert!(printed.status.success() && text(&printed.stdout).starts_with(begin), "{option}");
    }
    let points = text(&run(&["route", "m.csv", home, "--c", "--quiet"]).stdout);
    assert!(points.contains("static const slung_waypoint route_points["), "{points}");
    for (option, value, range) in [("--speed", "-2", "0.05 to 100 m/s"), ("--corner", "0", "0.02 to 1000 m")] {
        let refused = run(&["route", "m.csv", home, option, value]);
        assert!(!refused.status.success() && text(&refused.stderr).contains(range), "{}", text(&refused.stderr));
    }
    fs::write(folder.join("words.toml"), "duration_s = \"ten\"\n").expect("a file");
    let refused = text(&run(&["check", "words.toml"]).stderr);
    assert!(refused.contains("duration_s: ") && refused.trim_end().ends_with("expected a number"), "{refused}");
    assert!(run(&["check", "route.toml", "--quiet"]).status.success());
    assert!(run(&["run", "route.toml", "--quiet"]).status.success());
    let summary = fs::read_to_string(folder.join("out/summary.json")).expect("a summary");
    for key in ["dc_max_m", "dc_rms_m", "stop_error_m", "thrust_step_max"] {
        assert!(summary.contains(key), "{key}: {summary}");
    }
    // Refused before it is flown where a fence is not kept.
    let fenced = fs::read_to_string(&route).expect("the route")
        + "\n[fence]\ninside = [{ center = [0.0, 0.0], radius = 15.0 }]\n";
    fs::write(folder.join("fenced.toml"), fenced).expect("a file");
    let refused = run(&["run", "fenced.toml", "--out", "none"]);
    assert!(!refused.status.success() && text(&refused.stderr).contains("leg"), "{}", text(&refused.stderr));
    assert!(!folder.join("none").exists());
}

#[test]
fn a_log_is_replayed_beside_it_and_named_where_it_can_not_be() {
    let folder = folder("replay");
    fs::write(folder.join("short.toml"), SHORT).expect("a file");
    let run = |arguments: &[&str]| program().args(arguments).current_dir(&folder).output().expect("it starts");
    assert!(run(&["run", "short.toml", "--quiet"]).status.success());
    let flown = fs::read(folder.join("out/short.csv")).expect("a log");

    let unknown = text(&run(&["replay", "out/short.csv"]).stderr);
    assert!(unknown.contains("no built-in scenario is called short") && unknown.contains("--with"), "{unknown}");
    let replayed = run(&["replay", "out/short.csv", "--with", "short.toml"]);
    assert!(replayed.status.success(), "{}", text(&replayed.stderr));
    let said = text(&replayed.stdout);
    assert!(said.contains("thrust, replayed less logged") && said.contains("no f1 … f3"), "{said}");
    assert_eq!(fs::read(folder.join("out/short.csv")).expect("a log"), flown);
    let again = fs::read_to_string(folder.join("out/short-replay.csv")).expect("a log");
    assert!(again.lines().next().is_some_and(|names| names.contains(",logged_thrust,")));
    let summary = fs::read_to_string(folder.join("out/summary.json")).expect("a summary");
    assert!(summary.contains("\"thrust_n\""), "{summary}");

    // A clock that jumps, as at a first fix, leaves no flight of a century.
    let (names, rows) = text(&flown).split_once('\n').map(|(a, b)| (a.to_owned(), b.to_owned())).expect("rows");
    let jump = rows.trim_end().lines().last().expect("a row").split_once(',').expect("columns").1.to_owned();
    fs::write(folder.join("jump.csv"), format!("{names}\n{rows}1.7e9,{jump}\n")).expect("a file");
    let jumped = run(&["replay", "jump.csv", "--with", "short.toml"]);
    assert_eq!(jumped.status.code(), Some(1));
    assert!(text(&jumped.stderr).contains("has the log's clock jumped?"), "{}", text(&jumped.stderr));

    fs::write(folder.join("poor.csv"), "t_s,p1,p2,p3\n0,1,2,3\n").expect("a file");
    let poor = text(&run(&["replay", "poor.csv", "--with", "short.toml"]).stderr);
    assert!(poor.contains("poor.csv: the log lacks uav_p1") && poor.contains("vehicle_attitude"), "{poor}");
}
