//! The shape of `mixer-rt`'s interface until the crate is there; a few float operations instead of a mixer.
#![no_std]

#[derive(Clone, Copy)]
pub struct Wrench {
    pub roll_nm: f32,
    pub pitch_nm: f32,
    pub yaw_nm: f32,
    pub thrust_n: f32,
}

#[derive(Clone, Copy)]
pub struct Saturation(u16);

impl Saturation {
    pub fn bits(self) -> u16 {
        self.0
    }
}

pub struct Mix<const N: usize> {
    pub throttle: [f32; N],
    pub achieved: Wrench,
    pub saturation: Saturation,
}

#[derive(Debug)]
pub struct SetpointError;

#[inline]
pub fn mix<const N: usize>(
    table: &[[f32; 4]; N],
    setpoint: &Wrench,
    voltage_v: f32,
) -> Result<Mix<N>, SetpointError> {
    let u = [
        setpoint.roll_nm,
        setpoint.pitch_nm,
        setpoint.yaw_nm,
        setpoint.thrust_n,
    ];
    if u.iter().any(|x| !x.is_finite()) {
        return Err(SetpointError);
    }
    let mut throttle = [0.0; N];
    let mut bits = 0;
    for (t, row) in throttle.iter_mut().zip(table) {
        let x = row[0] * u[0] + row[1] * u[1] + row[2] * u[2] + row[3] * u[3];
        *t = (x / voltage_v).clamp(0.1, 1.0);
        if *t != x / voltage_v {
            bits = 1;
        }
    }
    let mut a = [0.0; 4];
    for (t, row) in throttle.iter().zip(table) {
        for (a, r) in a.iter_mut().zip(row) {
            *a += r * *t;
        }
    }
    Ok(Mix {
        throttle,
        achieved: Wrench {
            roll_nm: a[0],
            pitch_nm: a[1],
            yaw_nm: a[2],
            thrust_n: a[3],
        },
        saturation: Saturation(bits),
    })
}
