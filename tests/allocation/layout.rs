//! Random layouts and requests for proptest. They shrink towards one vertical unit with all rotors
//! working.

use std::cell::RefCell;
use std::fmt;
use std::rc::Rc;

use mixer_rt::Health;
use mixer_tests::frames::{self, AIRMODES, Options, Place};
use mixer_tests::request::{Frame, Request};
use proptest::prelude::*;

/// Most units of a layout.
const UNITS: usize = 8;

/// One unit, placed about the centre.
#[derive(Clone, Debug, PartialEq)]
struct Arm {
    /// Off an even distribution, as a share of the angle between neighbours.
    off: f64,
    length_m: f64,
    height_m: f64,
    /// x and y of the thrust axis, where the layout is tilted.
    tilt: [f64; 2],
    clockwise: bool,
    /// The rotors' outputs are the ranks of these.
    order: [u16; 2],
}

/// A layout with its priorities; shown as an airframe file.
#[derive(Clone, PartialEq)]
pub(crate) struct Layout {
    first_deg: f64,
    arms: Vec<Arm>,
    is_tilted: bool,
    airmode: &'static str,
    yaw_reserve_nm: f64,
    power_bias_nm_per_n: f64,
}

impl Layout {
    fn places(&self) -> Vec<Place> {
        let apart = 360.0 / self.arms.len() as f64;
        let arms = self.arms.iter().enumerate();
        arms.map(|(k, arm)| {
            let [x, y] = frames::polar(arm.length_m, self.first_deg + (k as f64 + arm.off) * apart);
            let [tilt_x, tilt_y] = if self.is_tilted { arm.tilt } else { [0.0; 2] };
            Place {
                position: [x, y, arm.height_m],
                axis: [tilt_x, tilt_y, -1.0],
                // Two units or more need both spins.
                clockwise: if k < 2 { k == 0 } else { arm.clockwise },
            }
        })
        .collect()
    }

    fn channels(&self) -> Vec<usize> {
        let order: Vec<u16> = self.arms.iter().flat_map(|arm| arm.order).collect();
        let rank = |rotor: usize| {
            (0..order.len())
                .filter(|&other| (order[other], other) < (order[rotor], rotor))
                .count()
        };
        (0..order.len()).map(rank).collect()
    }

    fn toml(&self) -> String {
        let options = Options {
            airmode: self.airmode,
            yaw_reserve_nm: self.yaw_reserve_nm,
            power_bias_nm_per_n: self.power_bias_nm_per_n,
        };
        frames::toml(&self.places(), &self.channels(), options)
    }

    /// The same with no power bias.
    pub(crate) fn without_power_bias(&self) -> Layout {
        Layout {
            power_bias_nm_per_n: 0.0,
            ..self.clone()
        }
    }

    /// The compiled frame; `None` where the compiler refuses it, as it does what cannot hover. The
    /// last one is kept, since shrinking asks for it again and again.
    pub(crate) fn frame(&self) -> Option<Rc<Frame>> {
        thread_local! {
            static LAST: RefCell<Option<(Layout, Option<Rc<Frame>>)>> = const { RefCell::new(None) };
        }
        LAST.with_borrow_mut(|last| match last {
            Some((layout, frame)) if layout == self => frame.clone(),
            _ => {
                let compiled = frames::compile_text(&self.toml()).ok();
                let frame = compiled.map(|compiled| Rc::new(Frame::new(compiled)));
                *last = Some((self.clone(), frame.clone()));
                frame
            }
        })
    }
}

impl fmt::Debug for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{}", self.toml())
    }
}

fn arm() -> impl Strategy<Value = Arm> {
    (
        -0.3..0.3,
        prop_oneof![4 => 0.2..0.7, 1 => 0.05..1.5],
        -0.05..0.05,
        prop::array::uniform2(-0.15..0.15),
        any::<bool>(),
        any::<[u16; 2]>(),
    )
        .prop_map(|(off, length_m, height_m, tilt, clockwise, order)| Arm {
            off,
            length_m,
            height_m,
            tilt,
            clockwise,
            order,
        })
}

/// Layouts of 1 to 8 units, half of them tilted, with any airmode, some with a yaw reserve.
pub(crate) fn layout() -> impl Strategy<Value = Layout> {
    (
        0.0..360.0,
        prop::collection::vec(arm(), 1..=UNITS),
        any::<bool>(),
        prop::sample::select(&AIRMODES),
        prop_oneof![2 => Just(0.0), 1 => 0.0..0.1],
    )
        .prop_map(|(first_deg, arms, is_tilted, airmode, yaw_reserve_nm)| Layout {
            first_deg,
            arms,
            is_tilted,
            airmode,
            yaw_reserve_nm,
            power_bias_nm_per_n: 0.0,
        })
}

/// [`layout`] with a power bias of either sign, the largest more than the pair can give at most
/// thrusts.
pub(crate) fn biased_layout() -> impl Strategy<Value = Layout> {
    (layout(), 0.0005..0.02, any::<bool>()).prop_map(|(layout, size, is_negative): (_, f64, _)| Layout {
        power_bias_nm_per_n: if is_negative { -size } else { size },
        ..layout
    })
}

/// Shares of the range for every rotor of the largest layout.
type Shares = [f64; 2 * UNITS];

#[derive(Clone, Debug)]
enum Asked {
    /// Shares of the authority.
    Shares([f64; 4]),
    /// What these throttles give, times a factor.
    Throttles(Shares, f64),
    /// These numbers.
    Numbers([f32; 4]),
}

/// A request that suits any frame.
#[derive(Clone, Debug)]
pub(crate) struct Draw {
    asked: Asked,
    /// Share of the range of voltage; a little beyond it, too.
    volts: f64,
    /// Rotors that are out.
    out: Vec<prop::sample::Index>,
}

impl Draw {
    /// The request to a frame.
    pub(crate) fn of(&self, frame: &Frame) -> Request {
        let rotors = frame.physics.rotors();
        let health = self.out.iter().fold(Health::GOOD, |health, index| {
            health.with_failed(index.index(rotors) as u8)
        });
        let [low, high] = frame.physics.voltage_range().unwrap_or([14.0, 14.0]);
        let volts = (low + self.volts * (high - low)) as f32;
        let wrench = match &self.asked {
            Asked::Shares(shares) => {
                std::array::from_fn(|axis| (shares[axis] * frame.authority[axis]) as f32)
            }
            Asked::Throttles(shares, factor) => {
                let throttles = frame.physics.throttles(shares.iter().copied(), health);
                frame
                    .physics
                    .wrench(&throttles, volts)
                    .map(|value| (factor * value) as f32)
            }
            Asked::Numbers(numbers) => *numbers,
        };
        Request {
            wrench,
            volts,
            density: None,
            health,
        }
    }
}

/// Throttles with a distance of `margin` to the ends of the range; without a margin some are at the
/// ends.
fn shares(margin: f64) -> BoxedStrategy<Shares> {
    let inside = margin..1.0 - margin;
    if margin > 0.0 {
        prop::array::uniform16(inside).boxed()
    } else {
        prop::array::uniform16(prop_oneof![4 => inside, 1 => Just(0.0), 1 => Just(1.0)]).boxed()
    }
}

/// Torques of some or all axes up to `size` times the authority, thrust from below zero to above
/// the ceiling.
fn scaled(size: f64) -> impl Strategy<Value = Asked> {
    let torque = || prop_oneof![1 => Just(0.0), 3 => -size..size];
    (torque(), torque(), torque(), -0.05..1.2)
        .prop_map(|(roll, pitch, yaw, thrust)| Asked::Shares([roll, pitch, yaw, thrust]))
}

fn number() -> impl Strategy<Value = f32> {
    let numbers = [0.0, -0.0, 1e-45, 1e-30, 1e-6, 0.1, 1.0, 40.0, 1e4, 1e30, f32::MAX];
    (prop::sample::select(numbers.to_vec()), any::<bool>())
        .prop_map(|(x, negative)| if negative { -x } else { x })
}

/// None out, one or two.
fn out(most: usize) -> impl Strategy<Value = Vec<prop::sample::Index>> {
    prop::collection::vec(any::<prop::sample::Index>(), 0..=most)
}

/// Requests of every kind, with up to `out_most` rotors out.
pub(crate) fn any_request(out_most: usize) -> impl Strategy<Value = Draw> {
    let asked = prop_oneof![
        4 => scaled(0.3),
        4 => scaled(1.0),
        3 => (shares(0.0), 0.8..1.3).prop_map(|(shares, factor)| Asked::Throttles(shares, factor)),
        1 => prop::array::uniform4(number()).prop_map(Asked::Numbers),
    ];
    (asked, -0.2..1.2, out(out_most)).prop_map(|(asked, volts, out)| Draw { asked, volts, out })
}

/// Wrenches of throttles with a distance of `margin` to the ends of their range.
pub(crate) fn attainable_request(margin: f64) -> impl Strategy<Value = Draw> {
    (shares(margin), 0.0..1.0).prop_map(|(shares, volts)| Draw {
        asked: Asked::Throttles(shares, 1.0),
        volts,
        out: Vec::new(),
    })
}
