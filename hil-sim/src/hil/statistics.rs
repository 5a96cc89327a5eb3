//! What a flight over the link is judged by, besides the flight.

/// What the link and the target did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// From each state's sending to its command's arrival, s.
    pub latencies_s: Vec<f64>,
    /// Counts of the target's cycle counter, each step.
    pub cycles: Vec<u32>,
    /// Questions that had to be sent again.
    pub repeats: u64,
    /// Logged samples whose telemetry did not come.
    pub telemetry_lost: u64,
    /// Frames from the target that could not be used.
    pub bad_frames: u64,
    /// Times the line was down and came back.
    pub reconnections: u64,
    /// Real time: periods in which no command came.
    pub late: u64,
    /// Real time: how far this program was behind the clock at most, s.
    pub behind_s: f64,
    /// Bits of `LOAD_FAULT` that stood in any answer.
    pub faults: u32,
    /// What the target had to say.
    pub texts: Vec<String>,
}

impl Statistics {
    /// The latency that the share `p` of all answers kept, s; 0 if there was none.
    #[must_use]
    pub fn latency_s(&self, p: f64) -> f64 {
        let mut sorted = self.latencies_s.clone();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        sorted.get((p * last as f64).round() as usize).copied().unwrap_or_default()
    }
}
