//! The examples fly, and end where they say.
// Each example has its plant.
#![allow(clippy::duplicate_mod)]

#[path = "../examples/circle.rs"]
mod circle;
#[path = "../examples/fitted_loop.rs"]
mod fitted_loop;
#[path = "../examples/own_curve.rs"]
mod own_curve;
#[path = "../examples/rotors.rs"]
mod rotors;
#[path = "../examples/route.rs"]
mod route;
#[path = "../examples/task.rs"]
mod task;
#[path = "../examples/tracking.rs"]
mod tracking;

macro_rules! flies {
    ($($name:ident),*) => {$(
        #[test]
        fn $name() {
            $name::main().expect(stringify!($name));
        }
    )*};
}

flies!(circle, fitted_loop, own_curve, rotors, route, task, tracking);
