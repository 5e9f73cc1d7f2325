//! Neither a step nor its observation allocates memory.

use crate::prelude::*;

#[test]
fn steps_and_their_observation_allocate_nothing() {
    for q in 0..=5 {
        let mut simulation = of_any_order(experiment((0.0, 0.0), 9), of_degree(q));
        let mut level = DgLevel::new(simulation.space());
        let info = allocation_counter::measure(|| {
            while simulation.step(1.0).unwrap().is_some() {
                let t = 0.5 * (simulation.old_level().t + simulation.t());
                assert!(simulation.value(Field::V, 0.3, t).unwrap().is_finite());
                assert!(simulation.level_into(t, &mut level));
                let energy = simulation.energy(&level).total() + simulation.balance().residual;
                assert!(energy.is_finite());
            }
        });
        assert_eq!(info.count_total, 0, "q = {q}");
        assert!(simulation.events().len() >= 3 && simulation.work().factorizations > 5);
    }
}
