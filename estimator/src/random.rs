//! Numbers for the tests.

use model::Vector3;

/// Uniform in ±1, by the multiplier of Knuth's MMIX.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, most: f64) -> Vector3<f64> {
        Vector3::new(self.next(), self.next(), self.next()) * most
    }
}
