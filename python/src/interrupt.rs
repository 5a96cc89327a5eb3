//! Long work without Python's lock, that Ctrl-C ends.

use hil_sim::fly::flight::Control;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// How often Python is asked whether somebody pressed Ctrl-C.
const LOOK: Duration = Duration::from_millis(50);

/// Does `work` on a thread of its own while Python's others go on. Once it is interrupted, the
/// control's `stop` is true, what `work` then answers is dropped, and the interrupt raised.
pub fn interruptible<A: Send>(py: Python<'_>, work: impl FnOnce(Control<'_>) -> A + Send) -> PyResult<A> {
    let stop = AtomicBool::new(false);
    thread::scope(|scope| {
        let (sender, mut receiver) = channel();
        let stop = &stop;
        let worker = scope.spawn(move || {
            let answer = work(Control { stop, progress: &|_| {} });
            // The receiver stays until this is sent or dropped.
            let _ = sender.send(answer);
        });
        let mut interrupt = Ok(());
        loop {
            let waiting = &mut receiver;
            match py.detach(move || waiting.recv_timeout(LOOK)) {
                Ok(answer) => break interrupt.map(|()| answer),
                Err(RecvTimeoutError::Timeout) => {
                    if interrupt.is_ok() {
                        interrupt = py.check_signals();
                        stop.store(interrupt.is_err(), Ordering::Relaxed);
                    }
                }
                // It panicked: so does this.
                Err(RecvTimeoutError::Disconnected) => {
                    break match worker.join() {
                        Err(panic) => std::panic::resume_unwind(panic),
                        Ok(()) => interrupt.and(Err(crate::error::whole("the flight was not answered"))),
                    };
                }
            }
        }
    })
}
