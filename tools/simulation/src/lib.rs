//! Flight simulation of the ISAE X8 with its coaxial mixer and with the conventional one.
//!
//! The paper's section V-B flew one X8 twice through the same manoeuvre, the mixer being the only
//! difference. This repeats it in simulation: [`plant`] is the vehicle, [`controller`] the same
//! cascade for both mixers, [`manoeuvre`] the hover with steps in z and a yaw profile, [`tracking`]
//! Table II.
//!
//! [`sitl`] is another simulation: the vehicle of any airframe file for PX4, ArduPilot and Betaflight.
//!
//! # What this can show, and what it cannot
//!
//! The plant *is* the coaxial map that the coaxial mixer inverts. Given that map, the simulation
//! shows how far each mixer's command is from the thrust that flies (Fig. 10), how the conventional
//! mixer's errors couple yaw into the altitude, and how both loops respond with rotors that are flywheels,
//! differ by 1 % and run on a sagging battery.
//!
//! It cannot show that the map is right: in flight the model's own error adds to the coaxial
//! mixer's (the paper sees 2 N). It knows nothing of ground effect, drag, sensor noise, the
//! estimator or the real gains and manoeuvre, none of which the paper prints, and its unsteady air
//! has an assumed size. So absolute errors are not comparable with Table II; ratios are, with these
//! reservations.

pub mod air;
pub mod battery;
pub mod controller;
pub mod figures;
pub mod flight;
pub mod integrator;
pub mod log;
pub mod manoeuvre;
pub mod mixer;
pub mod motor;
pub mod pair;
pub mod plant;
pub mod sitl;
pub mod state;
pub mod table;
pub mod tracking;
pub mod vehicle;
