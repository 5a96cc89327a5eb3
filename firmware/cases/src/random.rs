//! Random numbers that are the same on every machine: integers, and floats made of them without
//! rounding.

/// Marsaglia's xorshift32 (shifts 13, 17, 5): period 2³² − 1, and enough for drawing states.
pub struct Random(u32);

impl Random {
    /// Every seed but 0 starts its own place of the one cycle.
    pub const fn new(seed: u32) -> Self {
        Self(if seed == 0 { 1 } else { seed })
    }

    /// The next 32 bits.
    pub fn bits(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    /// Uniform in [−amplitude, amplitude): 24 random bits, as many as a single holds.
    pub fn around_zero(&mut self, amplitude: f32) -> f32 {
        let centred = (self.bits() >> 8) as i32 - (1 << 23);
        amplitude * (centred as f32 / (1 << 23) as f32)
    }

    /// Three of them.
    pub fn vector(&mut self, amplitude: f32) -> controller::Vector3<f32> {
        controller::Vector3::from_fn(|_, _| self.around_zero(amplitude))
    }
}
