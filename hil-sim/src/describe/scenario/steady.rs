//! The steady motion on a horizontal circle, by differential flatness: the payload's path gives
//! rod, thrust and attitude.

use witness::plant::VehicleParameters;

/// The paper's coordinates of the motion on the circle of `radius` about n3 at height `p3`, at the
/// point (0, radius, p3), with `speed` (m/s) along (−p2, p1, 0)/r and yaw 0.
///
/// The payload's specific force v̇ − g e3 is λ q with λ < 0, and the rod's motion q̈ = κ b3 + c
/// λ q gives b3. Seen from the turning radius both are constant, so that their rates are those of
/// the turn.
pub(super) fn on_circle(vehicle: &VehicleParameters, radius: f64, p3: f64, speed: f64) -> [f64; 16] {
    // At (0, r) the radius is n2 and the motion along −n1; everything turns about n3 at this rate.
    let rate = speed / radius;
    let centripetal = rate * rate * radius;
    let force = centripetal.hypot(vehicle.gravity);
    let (rod_out, rod_down) = (centripetal / force, vehicle.gravity / force);

    // κ b3 = q̈ − c λ q with q̈ = −rate² times q's horizontal part, −λ = force.
    let coupling = vehicle.total_mass() / (vehicle.uav_mass * vehicle.rod_length);
    let (b3_out, b3_down) = (rod_out * (coupling * force - rate * rate), rod_down * coupling * force);
    let length = b3_out.hypot(b3_down);
    let (b3_out, b3_down) = (b3_out / length, b3_down / length);

    // q = (sinβ, −sinα cosβ, cosα cosβ) = (0, rod_out, rod_down); b3 = (sinθ cosφ, −sinφ,
    // cosθ cosφ) = (0, b3_out, b3_down).
    let alpha = -rod_out.atan2(rod_down);
    let phi = -b3_out.atan2(b3_down);
    // Turning brings their n1 components: q̇1 = −rate q2 = cosβ β̇ and ḃ31 = −rate b32 = cosθ
    // cosφ θ̇, at β = θ = 0.
    let beta_dot = -rate * rod_out;
    let theta_dot = -rate * b3_out / phi.cos();
    // ω = W⁻¹ (0, θ̇, 0) at ψ = 0.
    let body_rate = [0.0, phi.cos() * theta_dot, -phi.sin() * theta_dot];

    [
        0.0,
        radius,
        p3,
        alpha,
        0.0,
        phi,
        0.0,
        0.0,
        -speed,
        0.0,
        0.0,
        0.0,
        beta_dot,
        body_rate[0],
        body_rate[1],
        body_rate[2],
    ]
}

#[cfg(test)]
mod tests {
    use witness::plant::{VehicleParameters, index, rod};

    #[test]
    fn is_the_reference_state_of_figure_2() {
        let x = super::on_circle(&VehicleParameters::default(), 5.0, -10.0, -5.0);
        let reference =
            [0.0, 5.0, -10.0, -0.47136, 0.0, -0.40823, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 0.4541, 0.0, 0.39699, 0.17171];
        for (i, (computed, wanted)) in x.iter().zip(reference).enumerate() {
            // The reference is printed to five digits.
            assert!((computed - wanted).abs() < 5.1e-6, "coordinate {i}: {computed} against {wanted}");
        }
    }

    #[test]
    fn the_rod_leans_outwards_below_the_vehicle() {
        let x = super::on_circle(&VehicleParameters::default(), 5.0, -10.0, 2.0);
        let q = rod(&x);
        assert!(q[1] > 0.0 && q[2] > 0.9 && x[index::VELOCITY] == -2.0);
    }
}
