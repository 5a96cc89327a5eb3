//! Parameters and missions in flash: kept over resets, whatever write was cut short where.

use std::cell::Cell;
use std::rc::Rc;

use autopilot::{Autopilot, Boot, Flash, FlashFault, Item, Kind, Memory, NotKept, RECORD, Settings, Store};
use rig::parameter;

const RECORDS: usize = 96;

/// Flash whose power fails after so many bytes, in the middle of a write or an erasure.
#[derive(Clone)]
pub struct Torn {
    pages: [[u8; RECORDS * RECORD]; 2],
    /// Bytes until the power fails.
    left: Rc<Cell<usize>>,
}

impl Torn {
    pub fn new() -> Self {
        // As it comes: anything.
        Self { pages: [[0x5A; RECORDS * RECORD]; 2], left: Rc::new(Cell::new(usize::MAX)) }
    }

    /// Whether power is left for another byte.
    fn spend(&self) -> bool {
        let left = self.left.get();
        self.left.set(left.saturating_sub(1));
        left > 0
    }
}

impl Flash for Torn {
    const RECORDS: usize = RECORDS;

    fn read(&self, page: usize, record: usize) -> [u8; RECORD] {
        self.pages[page][record * RECORD..][..RECORD].try_into().unwrap()
    }

    fn write(&mut self, page: usize, record: usize, bytes: &[u8; RECORD]) -> Result<(), FlashFault> {
        for (index, &byte) in bytes.iter().enumerate() {
            if !self.spend() {
                return Err(FlashFault);
            }
            let slot = &mut self.pages[page][record * RECORD + index];
            assert_eq!(*slot, 0xFF, "only what is erased is written");
            *slot = byte;
        }
        Ok(())
    }

    fn erase(&mut self, page: usize) -> Result<(), FlashFault> {
        for index in 0..RECORDS * RECORD {
            if !self.spend() {
                return Err(FlashFault);
            }
            self.pages[page][index] = 0xFF;
        }
        Ok(())
    }
}

fn mass(settings: &Settings) -> f32 {
    settings.rig().get(parameter!("VEH_M_LOAD"))
}

/// Starts, sets the payload's mass to each of `masses`, and keeps it. Returns the flash and what
/// the program believes is kept.
fn session(flash: Torn, masses: &[f32]) -> (Option<Torn>, f32, Vec<Result<(), NotKept>>) {
    let mut settings = Settings::default();
    let Ok(mut store) = Store::open(flash, &mut settings) else { return (None, mass(&settings), vec![]) };
    let kept = masses.iter().map(|&value| {
        let index = settings.set_by_name("VEH_M_LOAD", value).unwrap();
        store.keep(&settings, index)
    });
    let kept = kept.collect();
    (Some(store.flash().clone()), mass(&settings), kept)
}

#[test]
fn what_is_kept_is_there_after_a_reset() {
    let (flash, ..) = session(Torn::new(), &[]);
    let (flash, ..) = session(flash.unwrap(), &[0.7, 0.8]);
    let (flash, found, _) = session(flash.unwrap(), &[]);
    assert_eq!(found, 0.8);
    // The default too.
    let (flash, ..) = session(flash.unwrap(), &[0.5]);
    assert_eq!(session(flash.unwrap(), &[]).1, 0.5);
}

#[test]
fn a_full_page_is_said_and_tidied_up_at_the_next_start() {
    let mut flash = session(Torn::new(), &[]).0.unwrap();
    for round in 0..10 {
        let masses: Vec<f32> = (0..RECORDS).map(|i| 0.1 + 0.01 * (i + round) as f32).collect();
        let (after, _, kept) = session(flash, &masses);
        let count = kept.iter().filter(|kept| kept.is_ok()).count();
        assert!((RECORDS / 2 - 2..RECORDS).contains(&count), "{count}");
        assert!(kept[count..].iter().all(|kept| *kept == Err(NotKept::Full)));
        flash = after.unwrap();
        assert_eq!(session(flash.clone(), &[]).1, masses[count - 1]);
    }
}

/// Power fails after every number of bytes in turn: at the next start there is the value before or
/// the one that was being written, and storing goes on.
#[test]
fn power_may_fail_at_any_byte() {
    for full in [1, RECORDS / 2, RECORDS - 2] {
        let mut flash = session(Torn::new(), &[]).0.unwrap();
        let before: Vec<f32> = (0..full).map(|i| 0.6 + 0.001 * i as f32).collect();
        flash = session(flash, &before).0.unwrap();
        let last = session(flash.clone(), &[]).1;
        for bytes in 0..3 * RECORDS * RECORD {
            let torn = Torn { pages: flash.pages, left: Rc::new(Cell::new(bytes)) };
            let mut settings = Settings::default();
            // What is in the chip when the power fails, whether the program came through its start
            // or not.
            let chip = Rc::new(Cell::new(None));
            let watched = Watched { flash: torn, chip: Rc::clone(&chip) };
            if let Ok(mut store) = Store::open(watched, &mut settings) {
                let index = settings.set_by_name("VEH_M_LOAD", 0.9).unwrap();
                let _ = store.keep(&settings, index);
            }
            let pages = chip.take().unwrap_or(flash.pages);
            let after = Torn { pages, left: Rc::new(Cell::new(usize::MAX)) };
            let found = session(after.clone(), &[]).1;
            let (again, _, kept) = session(after, &[0.95]);
            assert!(found == last || found == 0.9, "{full} {bytes}: {found}");
            assert_eq!(kept, [Ok(())], "{full} {bytes}");
            assert_eq!(session(again.unwrap(), &[]).1, 0.95);
        }
    }
}

/// Flash that shows what it holds after each change.
struct Watched {
    flash: Torn,
    chip: Rc<Cell<Option<[[u8; RECORDS * RECORD]; 2]>>>,
}

impl Flash for Watched {
    const RECORDS: usize = RECORDS;

    fn read(&self, page: usize, record: usize) -> [u8; RECORD] {
        self.flash.read(page, record)
    }

    fn write(&mut self, page: usize, record: usize, bytes: &[u8; RECORD]) -> Result<(), FlashFault> {
        let written = self.flash.write(page, record, bytes);
        self.chip.set(Some(self.flash.pages));
        written
    }

    fn erase(&mut self, page: usize) -> Result<(), FlashFault> {
        let erased = self.flash.erase(page);
        self.chip.set(Some(self.flash.pages));
        erased
    }
}

/// Waypoints 5 m apart, the last at `last` m.
fn items(count: usize, last: f32) -> Vec<Item> {
    const WAYPOINT: u16 = 16;
    let item = |index: usize| Item {
        command: WAYPOINT,
        frame: 1,
        current: u8::from(index == 0),
        autocontinue: 1,
        // No yaw is stated.
        params: [0.0, 0.0, 0.0, f32::NAN],
        x: 50_000 * index as i32,
        y: -7,
        z: if index + 1 == count { last } else { -10.0 },
    };
    (0..count).map(item).collect()
}

/// With NaN equal to itself.
fn text(items: &[Item]) -> String {
    format!("{items:?}")
}

fn kept<F: Flash>(store: &Store<F>, kind: Kind) -> String {
    text(&store.items(kind).collect::<Vec<_>>())
}

pub fn open(flash: Torn) -> Store<Torn> {
    Store::open(flash, &mut Settings::default()).unwrap()
}

#[test]
fn missions_are_there_after_a_reset() {
    let mut store = open(Torn::new());
    assert_eq!(kept(&store, Kind::Mission), "[]");
    let (route, fence) = (items(3, -10.0), items(4, -20.0));
    store.keep_items(Kind::Mission, &items(2, -30.0)).unwrap();
    store.keep_items(Kind::Fence, &fence).unwrap();
    store.keep_items(Kind::Mission, &route).unwrap();
    let mut store = open(store.flash().clone());
    assert_eq!((kept(&store, Kind::Mission), kept(&store, Kind::Fence)), (text(&route), text(&fence)));
    // The same again takes no room.
    for _ in 0..RECORDS {
        store.keep_items(Kind::Mission, &route).unwrap();
    }

    // The autopilot that starts has them.
    let mut autopilot = Autopilot::new(Boot::default()).with_memory(Box::leak(Box::new(Memory::<256>::new())));
    // Waypoints make no fence, which is said.
    autopilot.recall(&store).unwrap_err();
    assert_eq!(text(autopilot.mission().items(Kind::Mission)), text(&route));

    store.keep_items(Kind::Mission, &[]).unwrap();
    let store = open(store.flash().clone());
    assert_eq!((kept(&store, Kind::Mission), kept(&store, Kind::Fence)), ("[]".to_owned(), text(&fence)));
}

#[test]
fn a_page_full_of_missions_is_said_and_tidied_up() {
    let (mut flash, mut kept_last) = (Torn::new(), String::new());
    for round in 0..10 {
        let mut settings = Settings::default();
        let mut store = Store::open(flash, &mut settings).unwrap();
        assert!(round == 0 || kept(&store, Kind::Mission) == kept_last && mass(&settings) == 0.7);
        let index = settings.set_by_name("VEH_M_LOAD", 0.7).unwrap();
        store.keep(&settings, index).unwrap();
        let mut count = 0;
        loop {
            let route = items(3, -(round * 100 + count) as f32);
            match store.keep_items(Kind::Mission, &route) {
                Ok(()) => kept_last = text(&route),
                Err(why) => break assert_eq!(why, NotKept::Full),
            }
            count += 1;
        }
        assert!(count > 0);
        flash = store.flash().clone();
    }
}

/// Power fails after every number of bytes in turn: at the next start there is the mission before
/// or the one that was being written, whole.
#[test]
fn power_may_fail_in_the_middle_of_a_mission() {
    for before in [0, 2, 5] {
        let mut store = open(Torn::new());
        let (old, new) = (items(before, -10.0), items(3, -20.0));
        store.keep_items(Kind::Mission, &old).unwrap();
        let pages = store.flash().pages;
        // All of a start that tidies up, and all that is written then.
        for bytes in 0..RECORDS * (RECORD + 1) + 40 * RECORD {
            let torn = Torn { pages, left: Rc::new(Cell::new(bytes)) };
            let chip = Rc::new(Cell::new(None));
            let watched = Watched { flash: torn, chip: Rc::clone(&chip) };
            if let Ok(mut store) = Store::open(watched, &mut Settings::default()) {
                let _ = store.keep_items(Kind::Mission, &new);
            }
            let left = Rc::new(Cell::new(usize::MAX));
            let mut store = open(Torn { pages: chip.take().unwrap_or(pages), left });
            let found = kept(&store, Kind::Mission);
            assert!([text(&old), text(&new)].contains(&found), "{before} {bytes}: {found}");
            store.keep_items(Kind::Mission, &new).unwrap();
            assert_eq!(kept(&open(store.flash().clone()), Kind::Mission), text(&new));
        }
    }
}
