//! What a figure tells at the pointer, by the name that the page's script knows.

/// What a figure tells at the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hover {
    /// Nothing.
    Nothing,
    /// All curves at one x.
    Curves,
    /// Thrust and torque of the place itself.
    Plane,
    /// The values of the nearest point.
    Dots,
    /// Thrust and torque at throttles.
    Forward,
    /// Throttles at thrust and torque.
    Inverse,
    /// The error of the inverse in thrust.
    ErrorThrust,
    /// In torque.
    ErrorTorque,
}

impl Hover {
    /// Its name in the page's script.
    pub(super) fn name(self) -> &'static str {
        match self {
            Hover::Nothing => "",
            Hover::Curves => "curves",
            Hover::Plane => "plane",
            Hover::Dots => "dots",
            Hover::Forward => "forward",
            Hover::Inverse => "inverse",
            Hover::ErrorThrust => "error-thrust",
            Hover::ErrorTorque => "error-torque",
        }
    }

    /// Whether the Tab key reaches the curves; else it reaches the picture.
    pub(super) fn is_along_curves(self) -> bool {
        matches!(self, Hover::Curves | Hover::Plane)
    }
}
