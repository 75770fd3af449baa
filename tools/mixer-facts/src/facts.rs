//! What there is to say of a compiled airframe, once.

mod conditions;
mod frame;
mod hover;
mod inverse;
mod list;
mod units;

use list::List;
use mixer_compiler::Compiled;

pub use list::Fact;

/// All facts of an airframe: what it gives, what flying it leaves, how true it is, what it costs.
pub fn facts(compiled: &Compiled) -> Vec<Fact> {
    let mut list = List(Vec::new());
    frame::gives(&mut list, compiled);
    frame::thrust(&mut list, compiled);
    hover::hover(&mut list, compiled);
    units::dynamics(&mut list, compiled);
    units::rotor_out(&mut list, compiled);
    units::power(&mut list, compiled);
    units::model(&mut list, compiled);
    conditions::voltage(&mut list, compiled);
    conditions::air(&mut list, compiled);
    inverse::proven(&mut list, compiled);
    inverse::tables(&mut list, compiled);
    inverse::costs(&mut list, compiled);
    let warnings = mixer_compiler::lint(compiled).faults().len();
    list.say("warnings", warnings, "", "").in_verdict();
    list.0
}
