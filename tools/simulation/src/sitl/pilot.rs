//! Who flies: arms, takes off and flies a manoeuvre; by MAVLink, as a ground station would.

use std::fmt;

use mavlink::dialects::common::{
    ATTITUDE_TARGET_DATA, COMMAND_ACK_DATA, COMMAND_LONG_DATA, MavAutopilot, MavCmd, MavMessage, MavModeFlag,
    MavResult, MavType,
};

use super::arguments::Arguments;
use super::link::Link;
use super::messages::{Texts, attitude, heartbeat, position};
use super::plan::{Hold, Manoeuvre, Plan, Target};
use super::world::World;

/// How a flight stack is flown by MAVLink.
#[derive(Debug)]
pub struct Stack {
    /// The mode in which it takes targets.
    pub guided: u32,
    /// The lowest bit of modes in `HEARTBEAT`.
    pub mode_bit: u32,
    /// How it says that its estimator has a position, where it would arm before.
    pub has_position: Option<&'static str>,
    /// Whether it takes off by a command, which ends with the first target; else by targets.
    pub is_sent_up: bool,
    /// Thrust setpoint of a level step in roll; that of hover where there is none.
    pub level_thrust: Option<f32>,
    /// The battery's component and message, where it simulates the motors' telemetry itself and has neither of the plant.
    pub battery: Option<(u8, Message)>,
}

/// A message about the vehicle.
pub type Message = fn(&World) -> MavMessage;

/// Height of the manoeuvre, m.
const HEIGHT_M: f64 = 5.0;

/// Periods, s.
const HEARTBEAT_S: f64 = 1.0;
const COMMAND_S: f64 = 1.0;
const BATTERY_S: f64 = 0.05;
const TARGET_S: f64 = 0.02;

/// Setpoints that come before the mode is asked for, s; PX4 needs some for Offboard.
const TARGETS_FIRST_S: f64 = 1.0;

/// Longest wait for a position, s.
const POSITION_S: f64 = 60.0;

/// Longest time until the vehicle hovers, s.
const PATIENCE_S: f64 = 120.0;

/// A hover: slower than this, m/s, for so long, s.
const STILL_M_S: f64 = 0.3;
const STILL_S: f64 = 3.0;

/// Number of `ATTITUDE_TARGET`, and of microseconds between two.
const ATTITUDE_TARGET: f32 = 83.0;
const ATTITUDE_TARGET_US: f32 = 20_000.0;

/// `FAILURE_UNIT_SYSTEM_MOTOR`, `FAILURE_TYPE_STUCK`: PX4's simulator then leaves out the motor's
/// telemetry, which it makes up itself.
const MOTOR: f32 = 101.0;
const STUCK: f32 = 2.0;

/// Where the flight is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// Until the motors are armed.
    Arming,
    /// Until the vehicle hovers; still since.
    Climbing(Option<f64>),
    /// The manoeuvre; since.
    Flying(f64),
}

/// The phase after a moment of the climb, still since a time: the manoeuvre, once the vehicle hovers above a height.
pub fn climbed(still_since_s: Option<f64>, least_m: f64, world: &World) -> Phase {
    let (time_s, height_m) = (world.time_s(), -world.state.position.z);
    let is_still = height_m > least_m && world.state.velocity.norm() < STILL_M_S;
    let still_since_s = is_still.then(|| still_since_s.unwrap_or(time_s));
    if still_since_s.is_some_and(|since_s| time_s - since_s > STILL_S) {
        eprintln!("{time_s:8.2} s  hovers at {height_m:.2} m");
        return Phase::Flying(time_s);
    }
    Phase::Climbing(still_since_s)
}

/// Pulse widths of the channels, us: roll, pitch, throttle, yaw, the switches of arming and of altitude hold, others.
pub type Channels = [u16; 16];

/// Who flies.
pub trait Pilot: fmt::Debug {
    /// Looks, and does what is due.
    ///
    /// # Errors
    /// A vehicle that does not hover in time; with what the stack has said last.
    fn update(&mut self, world: &World) -> Result<(), String>;

    /// The manoeuvre; `None` where none is flown.
    fn plan(&self) -> Option<&Plan>;

    /// Where the flight is.
    fn phase(&self) -> Phase;

    /// The thrust setpoint that the stack has reported last, or the throttle stick, 0 to 1; NaN before.
    fn thrust_setpoint(&self) -> f64;

    /// Connects where that is to be done before the stack starts.
    fn connect(&mut self) {}

    /// Tells the stack's simulated telemetry that a rotor has stopped.
    fn inject(&mut self, _output: usize) {}

    /// The sticks, where the pilot has some.
    fn sticks(&self) -> Channels {
        [1500; 16]
    }

    /// Time of the manoeuvre, s; `None` before.
    fn manoeuvre_s(&self, time_s: f64) -> Option<f64> {
        match self.phase() {
            Phase::Flying(since_s) => Some(time_s - since_s),
            _ => None,
        }
    }

    /// The target at a time of the simulation.
    fn wanted(&self, time_s: f64) -> Option<Target> {
        let manoeuvre_s = self.manoeuvre_s(time_s)?;
        self.plan().map(|plan| plan.target(manoeuvre_s))
    }

    /// Whether the manoeuvre is over.
    fn is_done(&self, time_s: f64) -> bool {
        let end_s = self.plan().map(|plan| plan.end_s);
        self.manoeuvre_s(time_s)
            .zip(end_s)
            .is_some_and(|(now_s, end_s)| now_s >= end_s)
    }
}

/// A pilot by MAVLink.
#[derive(Debug)]
pub struct Station {
    stack: &'static Stack,
    link: Link,
    plan: Option<Plan>,
    phase: Phase,
    /// System and component of the stack, and since when they are known, s.
    peer: Option<([u8; 2], f64)>,
    armed: bool,
    has_position: bool,
    mode: u32,
    /// When something periodic is due next, s.
    heartbeat_s: f64,
    command_s: f64,
    battery_s: f64,
    target_s: f64,
    thrust_setpoint: f64,
    texts: Texts,
    last_text: String,
}

/// Whether something periodic is due, next at `next_s`.
fn is_due(next_s: &mut f64, time_s: f64, period_s: f64) -> bool {
    let is_due = time_s >= *next_s;
    if is_due {
        *next_s = time_s + period_s;
    }
    is_due
}

impl Station {
    /// A pilot on a link.
    pub fn new(stack: &'static Stack, link: Link, arguments: &Arguments) -> Station {
        Station {
            stack,
            link,
            plan: arguments.fly.map(Manoeuvre::plan),
            phase: Phase::Arming,
            peer: None,
            armed: false,
            has_position: stack.has_position.is_none(),
            mode: 0,
            heartbeat_s: 0.0,
            command_s: 0.0,
            battery_s: 0.0,
            target_s: 0.0,
            thrust_setpoint: f64::NAN,
            texts: Texts::default(),
            last_text: String::new(),
        }
    }

    fn hear(&mut self, system: u8, component: u8, message: MavMessage, time_s: f64) {
        match message {
            MavMessage::HEARTBEAT(beat)
                if beat.mavtype != MavType::MAV_TYPE_GCS
                    && beat.autopilot != MavAutopilot::MAV_AUTOPILOT_INVALID =>
            {
                self.peer.get_or_insert(([system, component], time_s));
                self.armed = beat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED);
                self.mode = (beat.custom_mode >> self.stack.mode_bit) & 0xff;
            }
            MavMessage::ATTITUDE_TARGET(ATTITUDE_TARGET_DATA { thrust, .. }) => {
                self.thrust_setpoint = thrust.into();
            }
            MavMessage::STATUSTEXT(text) => {
                let Some(text) = self.texts.join(&text) else {
                    return;
                };
                self.has_position |= self.stack.has_position.is_some_and(|words| text.ends_with(words));
                if !text.is_empty() && text != self.last_text {
                    eprintln!("{time_s:8.2} s  {text}");
                    self.last_text = text;
                }
            }
            MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { command, result, .. })
                if result != MavResult::MAV_RESULT_ACCEPTED
                    && command != MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL
                    && command != MavCmd::MAV_CMD_COMPONENT_ARM_DISARM =>
            {
                eprintln!("{time_s:8.2} s  {command:?}: {result:?}");
            }
            _ => {}
        }
    }

    fn fly(&mut self, world: &World, peer: [u8; 2], time_s: f64, since_s: f64) -> Result<(), String> {
        let wait_s = if self.has_position {
            TARGETS_FIRST_S
        } else {
            POSITION_S
        };
        match self.phase {
            Phase::Arming => {
                if self.armed && self.mode == self.stack.guided {
                    self.phase = Phase::Climbing(None);
                } else if time_s > since_s + wait_s && is_due(&mut self.command_s, time_s, COMMAND_S) {
                    self.arm(peer);
                }
            }
            Phase::Climbing(still_since_s) => {
                self.phase = climbed(still_since_s, 0.5 * HEIGHT_M, world);
                if world.on_ground && is_due(&mut self.command_s, time_s, COMMAND_S) {
                    if !self.armed {
                        self.phase = Phase::Arming;
                    } else if self.stack.is_sent_up {
                        let parameters = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, HEIGHT_M as f32];
                        self.command(peer, MavCmd::MAV_CMD_NAV_TAKEOFF, parameters);
                    }
                }
            }
            Phase::Flying(_) => {}
        }
        if let Some(trouble) = self.trouble(world, time_s, since_s) {
            let told = match self.last_text.as_str() {
                "" => String::new(),
                text => format!("; it said last: {text}"),
            };
            return Err(format!("{trouble}{told}"));
        }
        let takes_targets = !self.stack.is_sent_up || matches!(self.phase, Phase::Flying(_));
        if takes_targets && is_due(&mut self.target_s, time_s, TARGET_S) {
            let target = self.wanted(time_s).unwrap_or_default();
            let level = self.stack.level_thrust.unwrap_or(self.thrust_setpoint as f32);
            self.link.send(&match target.hold {
                Hold::Place => position(target, HEIGHT_M, peer, time_s),
                Hold::Attitude => attitude(target, level, peer, time_s),
                Hold::FullThrust => attitude(target, 1.0, peer, time_s),
            });
        }
        Ok(())
    }

    /// Why the manoeuvre is not flown any more.
    fn trouble(&self, world: &World, time_s: f64, since_s: f64) -> Option<String> {
        let Some(flown_s) = self.manoeuvre_s(time_s) else {
            let state = if self.armed { "armed" } else { "not armed" };
            let is_late = time_s - since_s > PATIENCE_S;
            return is_late.then(|| format!("no hover within {PATIENCE_S} s, the stack is {state}"));
        };
        let guided = self.stack.guided;
        let what = if !self.armed {
            "the stack has disarmed".to_owned()
        } else if self.mode != guided {
            format!(
                "the stack has left mode {guided}, which the pilot flies in, for {}",
                self.mode
            )
        } else if world.on_ground {
            "the vehicle has landed by itself".to_owned()
        } else {
            return None;
        };
        Some(format!(
            "{what} at {flown_s:.2} s of the manoeuvre, which ends there"
        ))
    }

    /// Asks for the mode, then for armed motors.
    fn arm(&mut self, peer: [u8; 2]) {
        let mode = self.stack.guided;
        if self.mode == mode {
            self.command(peer, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0]);
        } else {
            // 1: the mode is one of the stack's own.
            self.command(peer, MavCmd::MAV_CMD_DO_SET_MODE, [1.0, mode as f32]);
        }
    }

    /// Sends a command; parameters that are not given are 0.
    fn command<const P: usize>(&mut self, peer: [u8; 2], command: MavCmd, given: [f32; P]) {
        let [target_system, target_component] = peer;
        let mut all = [0.0; 7];
        all[..P].copy_from_slice(&given);
        let [param1, param2, param3, param4, param5, param6, param7] = all;
        self.link.send(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1,
            param2,
            param3,
            param4,
            param5,
            param6,
            param7,
            command,
            target_system,
            target_component,
            confirmation: 0,
        }));
    }
}

impl Pilot for Station {
    fn update(&mut self, world: &World) -> Result<(), String> {
        let time_s = world.time_s();
        self.link.connect();
        for (header, message) in self.link.receive() {
            self.hear(header.system_id as u8, header.component_id, message, time_s);
        }
        let Some((peer, since_s)) = self.peer else {
            return Ok(());
        };
        if is_due(&mut self.heartbeat_s, time_s, HEARTBEAT_S) {
            self.link.send(&heartbeat());
            let parameters = [ATTITUDE_TARGET, ATTITUDE_TARGET_US];
            self.command(peer, MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, parameters);
        }
        if let Some((component, battery)) = self.stack.battery
            && is_due(&mut self.battery_s, time_s, BATTERY_S)
        {
            self.link.send_as([peer[0], component], &battery(world));
        }
        if self.plan.is_none() {
            return Ok(());
        }
        self.fly(world, peer, time_s, since_s)
    }

    fn plan(&self) -> Option<&Plan> {
        self.plan.as_ref()
    }

    fn phase(&self) -> Phase {
        self.phase
    }

    fn thrust_setpoint(&self) -> f64 {
        self.thrust_setpoint
    }

    fn connect(&mut self) {
        self.link.connect();
    }

    fn inject(&mut self, output: usize) {
        if let (Some(_), Some((peer, _))) = (self.stack.battery, self.peer) {
            let motor = output as f32 + 1.0;
            self.command(peer, MavCmd::MAV_CMD_INJECT_FAILURE, [MOTOR, STUCK, motor]);
        }
    }
}
