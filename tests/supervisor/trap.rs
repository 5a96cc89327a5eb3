//! The scalar that stops at the first invalid operation, in flight.

use hil_sim::run::{Arithmetic, fly_simply};
use hil_sim::scenario;

#[test]
fn a_flight_meets_no_invalid_operation_and_is_the_same_with_the_trap_set() {
    let scenario = scenario::builtin("fig2b").unwrap().unwrap();
    let plain = fly_simply(&scenario, Arithmetic::F32).unwrap();
    let trapped = fly_simply(&scenario, Arithmetic::Trapped).unwrap();
    assert!(!plain.log.is_empty());
    assert_eq!(plain.log, trapped.log);
}
