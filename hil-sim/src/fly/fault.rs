//! Faults in words.

use controller::Fault;

/// A fault in a word or two.
#[must_use]
pub fn describe(fault: Fault) -> String {
    match fault {
        Fault::NoState => "no state".to_owned(),
        Fault::State(channel) => format!("state: {channel:?}").to_lowercase(),
        Fault::Margin(margin) => format!("margin: {margin:?}"),
        Fault::NotFinite => "answer not finite".to_owned(),
        Fault::NoPath => "no path".to_owned(),
        Fault::Slack => "cable slack, or shorter than told".to_owned(),
        Fault::PayloadLost => "payload lost".to_owned(),
        Fault::Contradiction => "load, rod and UAV disagree".to_owned(),
        Fault::Caught => "hanging from its cable, load caught".to_owned(),
        other => format!("{other:?}").to_lowercase(),
    }
}
