//! What the controller has to be told, out of the parameters. Its own checks are made where it is made.

use controller::{
    ApproachLimits, Band, EnvelopeParams, Gains, Lost, ObserverParams, OutOfRange, Policy, Sampling, TrackGains,
    Vehicle, VehicleParams,
};

use crate::parameters::{Parameter, Parameters};

pub fn vehicle(parameters: &Parameters) -> Result<Vehicle<f32>, OutOfRange<f32>> {
    Vehicle::new(VehicleParams {
        payload_mass: parameters.get(Parameter::PayloadMass),
        uav_mass: parameters.get(Parameter::UavMass),
        rod_length: parameters.get(Parameter::RodLength),
        inertia: parameters.run(Parameter::Inertia1),
        gravity: parameters.get(Parameter::Gravity),
    })
}

pub fn sampling(parameters: &Parameters) -> Sampling<f32> {
    Sampling {
        period: parameters.get(Parameter::Period),
        latency: parameters.get(Parameter::Latency),
        rotor_lag: parameters.get(Parameter::RotorLag),
        look_ahead: parameters.is_on(Parameter::LookAhead),
    }
}

pub fn gains(parameters: &Parameters) -> Gains<f32> {
    Gains {
        k1: parameters.run(Parameter::K1D0),
        k2: parameters.run(Parameter::K2D0),
        k3: parameters.run(Parameter::K3D0),
        k4: parameters.run(Parameter::K4D0),
        integral: parameters.run(Parameter::KI1),
    }
}

pub fn track_gains(parameters: &Parameters) -> TrackGains<f32> {
    TrackGains {
        position: [Parameter::K1D0, Parameter::K2D0, Parameter::K3D0].map(|first| parameters.run(first)),
        yaw: parameters.run(Parameter::K4D0),
    }
}

pub fn observer(parameters: &Parameters) -> ObserverParams<f32> {
    let [payload_bandwidth, rod_bandwidth, torque_bandwidth] = parameters.run(Parameter::ObserverPayload);
    let [payload_bound, rod_bound, torque_bound] = parameters.run(Parameter::ObserverPayloadBound);
    ObserverParams { payload_bandwidth, rod_bandwidth, torque_bandwidth, payload_bound, rod_bound, torque_bound }
}

pub fn envelope(parameters: &Parameters) -> EnvelopeParams<f32> {
    let band = |first| {
        let [warning, limit] = parameters.run(first);
        Band { warning, limit }
    };
    EnvelopeParams {
        rod_angle: band(Parameter::RodAngleWarning),
        thrust_angle: band(Parameter::ThrustAngleWarning),
        roll: band(Parameter::RollWarning),
        tension: band(Parameter::TensionWarning),
        thrust: band(Parameter::ThrustWarning),
        path: band(Parameter::PathWarning),
        reach: band(Parameter::ReachWarning),
    }
}

pub fn approach(parameters: &Parameters) -> ApproachLimits<f32> {
    ApproachLimits {
        speed: parameters.get(Parameter::ApproachSpeed),
        acceleration: parameters.get(Parameter::ApproachAcceleration),
        tilt: parameters.get(Parameter::ApproachTilt),
        rod_angle: parameters.get(Parameter::ApproachRodAngle),
        min_thrust: parameters.get(Parameter::ApproachThrustMin),
        max_thrust: parameters.get(Parameter::ApproachThrustMax),
    }
}

pub fn policy(parameters: &Parameters) -> Policy<f32> {
    let sink = parameters.get(Parameter::Sink);
    Policy {
        coast: parameters.get(Parameter::Coast),
        lost: if sink < 0.0 { Lost::Cut } else { Lost::Sink(sink) },
        resume: parameters.is_on(Parameter::Resume),
        calm: parameters.get(Parameter::Calm),
        descent: parameters.get(Parameter::Descent),
        payload_lost: parameters.get(Parameter::PayloadLost),
    }
}
