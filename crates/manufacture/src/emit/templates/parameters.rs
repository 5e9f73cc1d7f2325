use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

@LINES@
fn current(parameter: &AtomicU64) -> f64 {
@READY@    f64::from_bits(parameter.load(Relaxed))
}

