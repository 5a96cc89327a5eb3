//! Prints every parameter: as MAVLink's component metadata, or with `--page` as a page.

fn main() -> Result<(), core::fmt::Error> {
    let mut text = String::new();
    if std::env::args().any(|argument| argument == "--page") {
        autopilot::metadata_page(&mut text)?;
    } else {
        autopilot::File::Parameters.write(&mut text)?;
    }
    print!("{text}");
    Ok(())
}
