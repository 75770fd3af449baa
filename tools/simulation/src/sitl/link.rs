//! The MAVLink of a ground station: for the pilot, and for PX4's battery.

use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream, UdpSocket};
use std::time::Duration;

use mavlink::MavHeader;
use mavlink::dialects::common::MavMessage;

use super::frames::{Frames, frame};

/// System and component of a ground station.
const STATION: [u8; 2] = [255, 190];

/// Longest wait for ArduPilot's port to open, per try.
const CONNECT: Duration = Duration::from_millis(100);

/// Whether nothing has come, so far.
pub fn is_silence(error: &std::io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}

/// A UDP port of this machine for `whom`, which is read without waiting, or waits for so long.
///
/// # Errors
/// A port that is taken; `mend` says what else would do.
pub fn listen(port: u16, wait: Option<Duration>, whom: &str, mend: &str) -> Result<UdpSocket, String> {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, port)).and_then(|socket| {
        socket.set_read_timeout(wait)?;
        socket.set_nonblocking(wait.is_none())?;
        Ok(socket)
    });
    socket.map_err(|error| format!("UDP port {port} for {whom}: {error}; end what uses it{mend}"))
}

/// A link, connected or not yet.
#[derive(Debug)]
pub struct Link {
    way: Way,
    frames: Frames,
    sequence: u8,
}

#[derive(Debug)]
enum Way {
    /// To whom the last datagram came from.
    Udp(UdpSocket, Option<SocketAddr>),
    /// To a server that may not be there yet; what it has not taken yet.
    Tcp(u16, Option<TcpStream>, Vec<u8>),
}

impl Link {
    /// Listens to PX4.
    ///
    /// # Errors
    /// A port that is taken.
    pub fn udp(port: u16) -> Result<Link, String> {
        let socket = listen(port, None, "PX4's MAVLink", ", or give --link another port")?;
        Ok(Link::new(Way::Udp(socket, None)))
    }

    /// Connects to ArduPilot as soon as it is there.
    pub fn tcp(port: u16) -> Link {
        Link::new(Way::Tcp(port, None, Vec::new()))
    }

    fn new(way: Way) -> Link {
        Link {
            way,
            frames: Frames::default(),
            sequence: 0,
        }
    }

    /// Tries to connect where that is still to do.
    pub fn connect(&mut self) {
        let Way::Tcp(port, stream, _) = &mut self.way else {
            return;
        };
        if stream.is_none() {
            let address = SocketAddr::from((Ipv4Addr::LOCALHOST, *port));
            *stream = TcpStream::connect_timeout(&address, CONNECT)
                .and_then(|stream| {
                    stream.set_nonblocking(true)?;
                    stream.set_nodelay(true)?;
                    Ok(stream)
                })
                .ok();
        }
    }

    /// The messages that have come.
    pub fn receive(&mut self) -> Vec<(MavHeader, MavMessage)> {
        let mut bytes = [0; 4096];
        loop {
            let count = match &mut self.way {
                Way::Udp(socket, peer) => socket.recv_from(&mut bytes).map(|(count, from)| {
                    *peer = Some(from);
                    count
                }),
                Way::Tcp(_, Some(stream), _) => stream.read(&mut bytes),
                Way::Tcp(..) => break,
            };
            match count {
                Ok(count) if count > 0 => self.frames.push(&bytes[..count]),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                _ => break,
            }
        }
        self.frames.by_ref().collect()
    }

    /// Sends as a ground station.
    pub fn send(&mut self, message: &MavMessage) {
        self.send_as(STATION, message);
    }

    /// Sends as a system and component. What cannot be sent is lost, as on any such link.
    pub fn send_as(&mut self, who: [u8; 2], message: &MavMessage) {
        let frame = frame(&mut self.sequence, who, message);
        match &mut self.way {
            Way::Udp(socket, Some(peer)) => {
                let _ = socket.send_to(&frame, *peer);
            }
            Way::Udp(..) | Way::Tcp(_, None, _) => {}
            Way::Tcp(_, Some(stream), waiting) => {
                waiting.extend(frame);
                // Without waiting: the stack may be waiting for the simulator.
                if let Ok(count) = stream.write(waiting) {
                    waiting.drain(..count);
                }
            }
        }
    }
}
