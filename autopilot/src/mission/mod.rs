//! A mission: the route that a ground station draws, and where along it the load is.
//!
//! ```text
//! items ──check──▶ kept ──about home──▶ a plan's waypoints ──build_route──▶ knots ──arm──▶ the rig's path
//! ```
//!
//! The knots are built into memory that the board lends, while not armed. Armed, the rig has them.

mod fence;
mod item;
mod lay;

pub use fence::Fence;
pub(crate) use item::WORDS;
pub use item::{DEGREES, Item, Kind, METRES, Refusal};
pub use lay::{Course, Mark, Plan};

use controller::{Built, FenceRegion, Follow, Knot, Mode, Passage, Route, Run, Table, Vector3, Waypoint};
use link::Home;
use link::dialect::MavMissionResult;
use rig::{AnyPath, HARMONICS, NoFormula, Rig, SetupError};

use crate::settings::Settings;
use fence::Keeping;

/// Most items of a mission, and of a fence.
pub const ITEMS: usize = 128;
/// Most waypoints: an item each, and the way back to the first.
const STOPS: usize = ITEMS + 1;

/// Items of a mission or fence.
pub type Items = heapless::Vec<Item, ITEMS>;

/// The path that the program flies, of parameters or of a mission.
pub type Flown<S = Laid> = AnyPath<f32, NoFormula, NoFormula, HARMONICS, S>;

/// Memory for a route of `KNOTS` knots, 60 bytes each: some 10 a waypoint, and as many more for
/// each doubling of a leg's length.
#[derive(Debug)]
pub struct Memory<const KNOTS: usize> {
    knots: [Knot<f32>; KNOTS],
    runs: [Run<f32>; STOPS],
    lists: Lists,
}

/// All that there is of a mission but its route.
#[derive(Debug)]
struct Lists {
    mission: Items,
    fence: Items,
    /// The items of an upload that have come.
    coming: Items,
    waypoints: [Waypoint<f32>; STOPS],
    /// Each waypoint's last item.
    numbers: [u16; STOPS],
    marks: heapless::Vec<Mark, STOPS>,
    /// The fence's regions in N.
    regions: Fence,
}

impl Lists {
    fn kept(&mut self, kind: Kind) -> &mut Items {
        match kind {
            Kind::Mission => &mut self.mission,
            Kind::Fence => &mut self.fence,
        }
    }

    /// Has what has come in place of what is kept, or the other way round.
    fn swap(&mut self, kind: Kind) {
        let Self { mission, fence, coming, .. } = self;
        core::mem::swap(coming, if kind == Kind::Mission { mission } else { fence });
    }
}

impl<const KNOTS: usize> Memory<KNOTS> {
    /// With nothing in it.
    #[must_use]
    pub const fn new() -> Self {
        let knot = Knot { point: [0.0; 3], step: [0.0; 3], normals: [[0.0; 3]; 2], speed: [0.0; 2], yaw: 0.0 };
        let run = Run { first: 0, knots: 0, is_closed: false, dwell: 0.0 };
        let lists = Lists {
            mission: Items::new(),
            fence: Items::new(),
            coming: Items::new(),
            waypoints: [Waypoint { point: [0.0; 3], corner: None, speed: 0.0, yaw: None, stop: None }; STOPS],
            numbers: [0; STOPS],
            marks: heapless::Vec::new(),
            regions: Fence::new(),
        };
        Self { knots: [knot; KNOTS], runs: [run; STOPS], lists }
    }
}

impl<const KNOTS: usize> Default for Memory<KNOTS> {
    fn default() -> Self {
        Self::new()
    }
}

/// A route in lent memory.
#[derive(Debug)]
pub struct Laid {
    knots: &'static mut [Knot<f32>],
    runs: &'static mut [Run<f32>],
    built: Built,
}

impl Table<f32> for Laid {
    #[inline]
    fn knots(&self) -> &[Knot<f32>] {
        self.knots
    }

    #[inline]
    fn runs(&self) -> &[Run<f32>] {
        self.runs.get(..self.built.runs).unwrap_or_default()
    }
}

/// A mission, its fence, and the home that both are counted from.
#[derive(Debug)]
pub struct Mission {
    /// Not there where the board lends no memory.
    lists: Option<&'static mut Lists>,
    /// Nor while a rig has it.
    laid: Option<Laid>,
    home: Option<Home>,
    course: Course,
    /// The run that is flown first.
    first: usize,
}

/// How far a mission is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Waypoints that the load has passed, or rests at.
    pub passed: usize,
    /// It rests where nothing comes after.
    pub is_complete: bool,
}

impl Mission {
    pub(crate) const fn none() -> Self {
        let course = Course { is_closed: false, end: controller::End::Stay, lands: false };
        Self { lists: None, laid: None, home: None, course, first: 0 }
    }

    pub(crate) fn lend<const KNOTS: usize>(&mut self, memory: &'static mut Memory<KNOTS>) {
        let Memory { knots, runs, lists } = memory;
        self.lists = Some(lists);
        self.laid = Some(Laid { knots, runs, built: Built::default() });
    }

    /// The items that are kept.
    #[must_use]
    pub fn items(&self, kind: Kind) -> &[Item] {
        match (&self.lists, kind) {
            (Some(lists), Kind::Mission) => &lists.mission,
            (Some(lists), Kind::Fence) => &lists.fence,
            (None, _) => &[],
        }
    }

    fn marks(&self) -> &[Mark] {
        self.lists.as_ref().map_or(&[], |lists| &lists.marks)
    }

    /// The route that was laid last, for what looks along it; none while a rig flies it.
    #[must_use]
    pub fn table(&self) -> Option<&impl Table<f32>> {
        self.laid.as_ref()
    }

    /// How that ends.
    #[must_use]
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// The fence's regions in N.
    pub fn regions(&self, settings: &Settings) -> impl Iterator<Item = FenceRegion<'_, f32>> {
        self.lists.iter().flat_map(|lists| lists.regions.regions(settings))
    }

    /// Where N has its origin.
    #[must_use]
    pub fn home(&self) -> Option<&Home> {
        self.home.as_ref()
    }

    /// Whether it lands where it ends.
    pub(crate) fn lands(&self) -> bool {
        self.course.lands
    }

    /// Counts from `home` from now on. What can't be laid about it, or without one, arming refuses.
    pub(crate) fn set_home(&mut self, home: Option<Home>, settings: &Settings) {
        self.home = home;
        let _ = self.lay(settings);
    }

    /// Begins to take items in.
    ///
    /// # Errors
    /// There is no memory for them.
    pub(crate) fn begin(&mut self) -> Result<(), Refusal> {
        self.lists.as_mut().ok_or_else(no_memory)?.coming.clear();
        Ok(())
    }

    /// How many items have come.
    pub(crate) fn coming(&self) -> usize {
        self.lists.as_ref().map_or(0, |lists| lists.coming.len())
    }

    /// Takes the next item in.
    ///
    /// # Errors
    /// No mission or fence can have it.
    pub(crate) fn take(&mut self, kind: Kind, item: Item) -> Result<(), Refusal> {
        item.check(kind).map_err(|refusal| refusal.at(kind, self.coming()))?;
        let lists = self.lists.as_mut().ok_or_else(no_memory)?;
        lists.coming.push(item).map_err(|_| Refusal::no_space(format_args!("mission: too many items")))
    }

    /// Keeps the items that have come in place of what there was. Returns what there is to say
    /// about it.
    ///
    /// # Errors
    /// They make no route; nothing has changed.
    pub(crate) fn keep(&mut self, kind: Kind, settings: &Settings) -> Result<Option<Refusal>, Refusal> {
        self.lists.as_mut().ok_or_else(no_memory)?.swap(kind);
        match self.lay(settings) {
            Ok(()) => {
                self.first = 0;
                Ok(self.passed_over().filter(|_| kind == Kind::Mission))
            }
            // It is laid again when it is to be flown: the home may come later.
            Err(refusal) if refusal.result == MavMissionResult::MAV_MISSION_ERROR => Ok(Some(refusal)),
            Err(refusal) => {
                if let Some(lists) = &mut self.lists {
                    lists.swap(kind);
                }
                let _ = self.lay(settings);
                Err(refusal)
            }
        }
    }

    /// What is kept and not done: cameras' items, by the first of them.
    fn passed_over(&self) -> Option<Refusal> {
        let items = self.items(Kind::Mission);
        let number = items.iter().position(Item::is_for_camera)?;
        let command = items.get(number)?.command;
        let text = format_args!("command {command}: no camera, passed over");
        Some(Refusal::new(MavMissionResult::MAV_MISSION_ACCEPTED, text).at(Kind::Mission, number))
    }

    /// Takes `items` that were kept over a reset, whatever they are: to lay them comes next.
    pub(crate) fn recall(&mut self, kind: Kind, items: impl Iterator<Item = Item>) {
        let Some(lists) = &mut self.lists else { return };
        let kept = lists.kept(kind);
        kept.clear();
        // None are kept that do not fit.
        kept.extend(items.take(ITEMS));
    }

    /// Forgets what there is of a kind.
    pub(crate) fn clear(&mut self, kind: Kind, settings: &Settings) {
        if let Some(lists) = &mut self.lists {
            lists.kept(kind).clear();
        }
        self.first = 0;
        let _ = self.lay(settings);
    }

    /// Lays the fence, whatever path is to be flown.
    ///
    /// # Errors
    /// It can't be, and keeps nothing out.
    pub(crate) fn lay_fence(&mut self) -> Result<(), Refusal> {
        let Some(lists) = &mut self.lists else { return Ok(()) };
        lists.regions.lay(&lists.fence, self.home.as_ref())
    }

    /// Lays the fence, and the route if there is a mission.
    ///
    /// # Errors
    /// One of them can't be, or the route does not keep the fence's margin.
    pub(crate) fn lay(&mut self, settings: &Settings) -> Result<(), Refusal> {
        let Self { lists, home, laid, course, .. } = self;
        let Lists { mission, fence, waypoints, numbers, marks, regions, .. } =
            &mut **lists.as_mut().ok_or_else(no_memory)?;
        marks.clear();
        regions.lay(fence, home.as_ref())?;
        if mission.is_empty() {
            return Ok(());
        }
        let laid = laid.as_mut().ok_or_else(no_memory)?;
        let plan = Plan::read(mission, home.as_ref(), settings, waypoints, numbers)?;
        *course = *plan.course();
        laid.built = plan.build(laid.knots, laid.runs, |mark| {
            let _ = marks.push(mark);
        })?;
        let mut route = Route::new(&*laid).map_err(|error| Refusal::invalid(format_args!("route: {error}")))?;
        regions.allows(&mut route, marks, settings)
    }

    /// Whether load, UAV and cable keep half of the margin from the fence: the other half is what
    /// it takes to stop. From the ground, where it `rises`, the least height is yet to be reached.
    pub(crate) fn keeps_fence(&self, bodies: &[Vector3<f32>; 2], rises: bool, settings: &Settings) -> bool {
        let Some(lists) = &self.lists else { return true };
        let Keeping { margin, up: [low, high] } = Keeping::of(settings, 0.5);
        let low = if rises { f32::NEG_INFINITY } else { low };
        lists.regions.keeps(bodies, &Keeping { margin, up: [low, high] })
    }

    /// What of load, UAV and cable does not keep the margin on the straight way between two places
    /// of load and UAV. A cable that is moved without turning is bounded by those ways and its two
    /// ends.
    pub(crate) fn way_breach(
        &self,
        from: &[Vector3<f32>; 2],
        to: &[Vector3<f32>; 2],
        settings: &Settings,
    ) -> Option<&'static str> {
        let lists = self.lists.as_ref()?;
        let keeping = Keeping::of(settings, 1.0);
        let [load, uav] = [0, 1].map(|body: usize| [from, to].map(|at| at.get(body).copied().unwrap_or_default()));
        [("the load", load), ("the UAV", uav), ("the cable", *from), ("the cable", *to)]
            .into_iter()
            .find_map(|(what, way)| (!lists.regions.keeps(&way, &keeping)).then_some(what))
    }

    /// The rig that flies the mission.
    pub(crate) fn rig(&mut self, settings: &Settings) -> Result<Rig<f32, Flown>, NoRig> {
        if self.items(Kind::Mission).is_empty() {
            let text = format_args!("PATH_KIND is a route, and there is no mission");
            return Err(NoRig::Mission(Refusal::new(MavMissionResult::MAV_MISSION_ERROR, text)));
        }
        self.lay(settings).map_err(NoRig::Mission)?;
        // Whatever is refused is refused of a borrowed table: a lent one would be lost with it.
        let borrowed = self.laid.as_ref().map(Route::new);
        let Some(Ok(route)) = borrowed else { return Err(NoRig::Mission(no_memory())) };
        Rig::on(Flown::Route(route), settings.rig()).map_err(NoRig::Setup)?;
        let Some(laid) = self.laid.take() else { return Err(NoRig::Mission(no_memory())) };
        let mut route = Route::new(laid).map_err(|error| NoRig::Setup(error.into()))?;
        route = route.resumed().with_end(self.course.end);
        route.begin_run(self.first);
        Rig::on(Flown::Route(route), settings.rig()).map_err(NoRig::Setup)
    }

    /// Takes the memory back from a rig that is done with.
    pub(crate) fn take_back(&mut self, rig: Rig<f32, Flown>) {
        if let Some(Flown::Route(route)) = rig.into_path() {
            self.laid = Some(route.into_table());
        }
    }

    /// The next flight begins where the mission does.
    pub(crate) fn begin_again(&mut self) {
        self.first = 0;
    }

    /// How many waypoints lie before the run that `rig` flies, or else is to begin with.
    pub(crate) fn before_run(&self, rig: Option<&Rig<f32, Flown>>) -> usize {
        let run = match rig.and_then(Rig::following).map(Follow::path) {
            Some(Flown::Route(route)) => route.run(),
            _ => self.first,
        };
        self.marks().iter().take_while(|mark| mark.at.run < run).count()
    }

    /// Where `rig` is along the mission, if it flies that.
    #[must_use]
    pub(crate) fn progress(&self, rig: &Rig<f32, Flown>) -> Option<Progress> {
        let law = rig.following()?;
        let Flown::Route(route) = law.path() else { return None };
        let (run, parameter) = (route.run(), route.parameter());
        // In hold the law does not see what becomes of the load.
        let rests = law.rests() && rig.mode() == Mode::Follow;
        let is_passed = |mark: &&Mark| {
            let Passage { run: of, span } = mark.at;
            of < run || of == run && (rests || span as f32 <= parameter)
        };
        let passed = self.marks().iter().take_while(is_passed).count();
        Some(Progress { passed, is_complete: rests && route.is_last_run() })
    }

    /// The item of the `index`-th waypoint, or of the last one.
    #[must_use]
    pub(crate) fn item_of(&self, index: usize) -> Option<u16> {
        self.marks().get(index).or(self.marks().last()).map(|mark| mark.item)
    }

    /// The speed of the leg to the `index`-th waypoint, m/s.
    #[must_use]
    pub(crate) fn speed_to(&self, index: usize) -> Option<f32> {
        self.marks().get(index).or(self.marks().last()).map(|mark| mark.speed)
    }

    /// Has the mission go on with the run that leads to `item`.
    pub(crate) fn set_current(&mut self, item: u16, rig: Option<&mut Rig<f32, Flown>>) -> Result<(), &'static str> {
        if usize::from(item) >= self.items(Kind::Mission).len() {
            return Err("mission: no such item");
        }
        let Some(mark) = self.marks().iter().find(|mark| mark.item >= item) else {
            return Err("mission: not laid yet");
        };
        self.first = mark.at.run;
        if let Some(Flown::Route(route)) = rig.and_then(Rig::following_mut).map(Follow::path_mut) {
            route.begin_run(self.first);
        }
        Ok(())
    }
}

/// Why a mission makes no rig.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NoRig {
    Mission(Refusal),
    Setup(SetupError<f32>),
}

fn no_memory() -> Refusal {
    Refusal::no_space(format_args!("this board has no memory for missions"))
}
