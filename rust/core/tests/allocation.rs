//! The step does not allocate once the active set has been as large before.

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

use bipenalty::group::Group;
use bipenalty::history::Record;
use bipenalty::model::Model;
use bipenalty::penalty::{Damping, Mass};
use common::{blocks, cd_lagrange, forward_increment, method, predictor_corrector, start};

struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: hands every request to the system allocator unchanged; it only counts.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|c| c.set(c.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.with(|c| c.set(c.get() + 1));
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(work: impl FnOnce()) -> usize {
    let before = COUNT.with(Cell::get);
    work();
    COUNT.with(Cell::get) - before
}

#[test]
fn a_repeated_collision_allocates_nothing() {
    // At p_s = 30 rows with a mass penalty open and close all the time: many patterns, among them new ones.
    for method in [
        method(3.0, Mass::None, Damping::None),
        method(3.0, Mass::None, Damping::Factor(1e-3)),
        method(30.0, Mass::RatioFromStep(0.9), Damping::None),
        method(30.0, Mass::RatioFromStep(0.9), Damping::Ratio(1.0)),
        cd_lagrange(),
        forward_increment(),
        predictor_corrector(30.0, 0.6),
    ] {
        for passes in [1, 2] {
            let model = Arc::new(Model::new(blocks(true, passes)).unwrap());
            let mut group = start(&model, method, 0, [0.3, -2.0], 0.5);
            group.runs[0].record = Record { every: 0, energy_every: 0, snapshots: Vec::new() };
            let initial = group.state.clone();
            let mut most = 0;
            let mut collide = |group: &mut Group| {
                allocations(|| {
                    for _ in 0..800 {
                        group.advance(1);
                        most = most.max(group.lanes[0].rows.len());
                    }
                })
            };
            assert!(collide(&mut group) > 0, "the first collision makes room");
            group.state = initial;
            let again = collide(&mut group);
            let searches = group.lanes[0].search.count;
            assert!(most >= 5 && searches > 2, "{most} rows, {searches} searches");
            assert_eq!(again, 0, "{method:?}, {passes} passes");
        }
    }
}
