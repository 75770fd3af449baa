"""Mixers of coaxial multirotors on numpy arrays: what ``cargo mixer`` does, with the same results.

Wrenches have the columns roll, pitch, yaw (N m, forward-right-down) and thrust (N, upwards). Throttles are
0 to 1, a column per output. Arrays have a row per setpoint; one setpoint may be given alone.

>>> mixer = coaxial_mixer.compile("airframes/isae-x8.toml")
>>> mixer.mix([0.5, 0.0, 0.1, 40.0]).throttles
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import version
from typing import Any, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from . import _native
from ._native import MixerError, Native

__all__ = [
    "Conventional",
    "ConventionalMix",
    "Identified",
    "Mix",
    "Mixer",
    "MixerError",
    "__version__",
    "compile",
    "conventional",
    "identify",
    "predict",
]

__version__ = version("coaxial-mixer")

Path = Union[str, "os.PathLike[str]"]
Failed = Iterable[Union[int, bool]]
F32 = npt.NDArray[np.float32]
F64 = npt.NDArray[np.float64]


class Mix(NamedTuple):
    """What a mixer makes of N setpoints, to the bit as the firmware does."""

    throttles: F32
    """Throttle per output, (N, rotors); 0 of a rotor that is out."""
    achieved: F32
    """The wrench that the throttles give, (N, 4)."""
    saturation: npt.NDArray[np.uint16]
    """Sums of flags, (N,); 0 where everything was delivered: 1 roll, 4 pitch, 16 yaw, 64 thrust is below the
    setpoint; 2, 8, 32, 128 above it; 256 the voltage was clamped into its range, 512 the density."""


class ConventionalMix(NamedTuple):
    """What the conventional mixer makes of N setpoints."""

    throttles: F32
    """Throttle per output, (N, rotors)."""
    within: npt.NDArray[np.bool_]
    """Whether no throttle was clipped, (N,)."""


class Identified(NamedTuple):
    """A pair that was identified or predicted."""

    tables: str
    """The tables of an airframe file; with ``frame`` a whole airframe for :func:`compile`."""
    report: str
    """What the command prints."""
    details: str
    """What it prints with ``--verbose``."""
    json: dict[str, Any]
    """What it prints with ``--json``."""
    notes: list[str]
    """Rows that were refused."""


class _Airframe:
    """An airframe with its physics."""

    def __init__(self, name: str, text: bytes) -> None:
        self._source = (name, text)
        self._native = Native(name, text)

    def __reduce__(self) -> tuple[Any, ...]:
        # Compiled anew: the same text gives the same tables.
        return type(self), self._source

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}, {self.rotors} rotors>"

    @property
    def name(self) -> str:
        """The airframe's name."""
        return self._native.name

    @property
    def channels(self) -> list[tuple[int, ...]]:
        """Outputs of the upper and of the lower rotor of every unit; one of a single rotor."""
        return self._native.channels

    @property
    def rotors(self) -> int:
        """The number of rotors, and of outputs."""
        return sum(map(len, self._native.channels))

    def wrench(
        self,
        throttles: npt.ArrayLike,
        volts: npt.ArrayLike | None = None,
        failed: Failed = (),
        density: npt.ArrayLike | None = None,
    ) -> F64:
        """The wrench that throttles (N, rotors) of any mixer give by the airframe's physics: (N, 4).

        A table with names is read by the columns throttle_0, .. in any order.
        Without ``volts`` (V) and ``density`` (kg/m3), a number or (N,), those of the bench are taken. ``failed``
        has the outputs of rotors that stand still, or a boolean for every output. Raises :class:`MixerError` outside the airframe's ranges.
        """
        return self._native.wrench(self._rows(np.float64, throttles, self._outputs(), volts, density, failed))

    def efforts(
        self,
        throttles: npt.ArrayLike,
        volts: npt.ArrayLike | None = None,
        failed: Failed = (),
        density: npt.ArrayLike | None = None,
    ) -> F64:
        """Thrust (N) and torque (N m, as on the bench) of every unit: (N, units, 2). Arguments as :meth:`wrench`."""
        return self._native.efforts(self._rows(np.float64, throttles, self._outputs(), volts, density, failed))

    def _outputs(self) -> list[str]:
        return [f"throttle_{channel}" for channel in range(self.rotors)]

    def _out(self, failed: Failed) -> list[int]:
        """The outputs of rotors that are out, of outputs or of a mask of all of them."""
        needed = f"outputs, 0 to {self.rotors - 1}, or {self.rotors} booleans"
        try:
            out = list(failed)
        except TypeError:
            raise MixerError(f"failed = {failed!r} where a list is needed: {needed}") from None
        if any(isinstance(one, (bool, np.bool_)) for one in out):
            if len(out) != self.rotors or not all(isinstance(one, (bool, np.bool_)) for one in out):
                raise MixerError(f"failed = {failed!r} is no mask: {needed}")
            return [channel for channel, one in enumerate(out) if one]
        if not all(isinstance(one, (int, np.integer)) and 0 <= one < self.rotors for one in out):
            raise MixerError(f"failed = {failed!r} has what is no output: {needed}")
        if len(set(out)) < len(out):
            raise MixerError(f"failed = {failed!r} names an output twice; a mask has booleans, not 0 and 1: {needed}")
        return [int(one) for one in out]

    def _rows(
        self,
        dtype: Any,
        table: Any,
        columns: Sequence[str],
        volts: Any,
        density: Any = None,
        failed: Failed = (),
    ) -> _native.Rows:
        names = _names(table)
        if names is None:
            rows = _numbers("the array", table, dtype)
        else:
            missing = [name for name in columns if name not in names]
            if missing:
                raise MixerError(f"a table without {', '.join(missing)}: its columns are {', '.join(map(str, names))}")
            read = [_numbers(name, table[name], dtype) for name in columns]
            if len({column.shape for column in read}) > 1:
                lengths = [f"{name} {column.size}" for name, column in zip(columns, read)]
                raise MixerError(f"columns of different lengths: {', '.join(lengths)}")
            rows = np.stack(read, axis=-1)
            volts = _condition("volts", volts, "voltage_v", table, names)
            density = _condition("density", density, "density_kg_m3", table, names)
        shape, rows = rows.shape, np.atleast_2d(rows)
        if rows.ndim != 2 or rows.shape[1] != len(columns):
            raise MixerError(f"an array of shape {shape} where (N, {len(columns)}) is needed: {', '.join(columns)}")

        def column(name: str, values: Any) -> Any:
            if values is None:
                return None
            values = _numbers(name, values, dtype)
            if values.shape not in [(), (1,), (len(rows),)]:
                raise MixerError(f"{name} of shape {values.shape} where a number or ({len(rows)},) is needed")
            return np.broadcast_to(values, (len(rows),))

        return rows, column("volts", volts), column("density", density), self._out(failed)


_WRENCH = ("roll_nm", "pitch_nm", "yaw_nm", "thrust_n")


def _names(table: Any) -> list[Any] | None:
    """The columns of a table that has names: a DataFrame or a row of one, a structured array, a dict."""
    if isinstance(table, Mapping):
        return list(table)
    names = getattr(table, "columns", None)
    if names is None:
        names = getattr(getattr(table, "dtype", None), "names", None)
    if names is None and not callable(getattr(table, "index", None)):
        names = getattr(table, "index", None)
    if names is None or not any(isinstance(name, str) for name in names):
        return None
    return list(names)


def _condition(name: str, given: Any, column: str, table: Any, names: list[Any]) -> Any:
    """What the argument gives, or the table's column."""
    if column not in names:
        return given
    if given is not None:
        raise MixerError(f"{name} is given, and the table has {column}: leave one of them out")
    return table[column]


def _numbers(name: str, values: Any, dtype: Any) -> Any:
    """An array of real numbers."""
    if np.ma.is_masked(values):
        raise MixerError(f"{name} has masked values: fill them, or leave their rows out")
    try:
        array = np.asarray(values)
        if array.dtype.kind in "cSUMm":
            raise MixerError(f"{name} has values of type {array.dtype}, no real numbers")
        return array.astype(dtype)
    except (TypeError, ValueError, OverflowError) as error:
        if isinstance(error, MixerError):
            raise
        raise MixerError(f"{name} is no array of numbers: {error}") from None


class Mixer(_Airframe):
    """A compiled airframe: :func:`compile` makes it."""

    @property
    def verdict(self) -> str:
        """What ``cargo mixer check`` says: thrust, hover, margins."""
        return self._native.verdict

    @property
    def warnings(self) -> list[str]:
        """What is probably a mistake, a line each."""
        return self._native.warnings

    @property
    def json(self) -> dict[str, Any]:
        """What ``cargo mixer check --json`` prints, without the time."""
        numbers: dict[str, Any] = json.loads(self._native.json)
        return numbers

    @property
    def rust(self) -> str:
        """The generated Rust, as ``cargo mixer expand`` prints it."""
        return self._native.rust

    def mix(
        self,
        wrenches: npt.ArrayLike,
        volts: npt.ArrayLike | None = None,
        failed: Failed = (),
        density: npt.ArrayLike | None = None,
    ) -> Mix:
        """The throttles for wrenches (N, 4), by the runtime and the tables of the firmware.

        A table with names, as a DataFrame, is read by the columns roll_nm, pitch_nm, yaw_nm, thrust_n, and voltage_v and
        density_kg_m3 where it has them, in any order.
        Without ``volts`` (V) and ``density`` (kg/m3), a number or (N,), those of the bench are taken. ``failed``
        has the outputs of rotors that are out, or a boolean for every output. Raises :class:`MixerError` for what is not finite.
        """
        return Mix(*self._native.mix(self._rows(np.float32, wrenches, _WRENCH, volts, density, failed)))

    def mix_dynamic(
        self,
        wrenches: npt.ArrayLike,
        time_s: npt.ArrayLike | None = None,
        volts: npt.ArrayLike | None = None,
        failed: Failed = (),
        density: npt.ArrayLike | None = None,
    ) -> Mix:
        """The throttles for the wrenches (N, 4) of one flight at times (N,), s, each after the one before, for rotors that are
        under way.

        The first row's rotors turn as it asks. A table with names has a column time_s. What is achieved, and saturation, are those of
        :meth:`mix`, as are the other arguments.
        """
        if time_s is not None:
            if _names(wrenches) is not None:
                raise MixerError("time_s beside a table with names: a column of it")
            rows = np.asarray(wrenches, np.float32)
            times = np.asarray(time_s, np.float32)
            if rows.ndim != 2 or times.shape != rows.shape[:1]:
                raise MixerError(f"time_s of shape {times.shape} for wrenches of shape {rows.shape}")
            wrenches = np.column_stack([rows, times])
        return Mix(*self._native.mix_dynamic(self._rows(np.float32, wrenches, [*_WRENCH, "time_s"], volts, density, failed)))


class Conventional(_Airframe):
    """The mixer of today's flight stacks on an airframe: :func:`conventional` makes it."""

    def mix(self, wrenches: npt.ArrayLike, volts: npt.ArrayLike | None = None) -> ConventionalMix:
        """The throttles for wrenches (N, 4), every rotor taken as isolated. Arguments as :meth:`Mixer.mix`."""
        return ConventionalMix(*self._native.conventional(self._rows(np.float32, wrenches, _WRENCH, volts)))


def _read(toml: Path | bytes) -> tuple[str, bytes]:
    if isinstance(toml, bytes):
        return "airframe", toml
    try:
        if isinstance(toml, str) and "\n" in toml:
            return "airframe", toml.encode()
        name = os.fspath(toml)
        with open(name, "rb") as file:
            return name, file.read()
    except (OSError, TypeError, ValueError) as error:
        raise MixerError(str(error)) from error


def compile(toml: Path | bytes) -> Mixer:
    """Compiles an airframe: the path of a file, its text, which has several lines, or its bytes.

    Raises :class:`MixerError` with all faults of the file, each at its line.
    """
    return Mixer(*_read(toml))


def conventional(toml: Path | bytes) -> Conventional:
    """The conventional mixer of an airframe, to compare with. The argument is that of :func:`compile`."""
    return Conventional(*_read(toml))


def identify(*files: Path, **options: Any) -> Identified:
    """The pair that bench files hold, by the options of ``cargo mixer identify``.

    ``identify("few.csv", prior="single.csv", spacing_ratio=0.25)`` is ``cargo mixer identify few.csv --prior
    single.csv --spacing-ratio 0.25``. ``True`` gives an option without a value, a tuple values with commas between, a
    list an option several times. Raises :class:`MixerError` with what the command says.
    """
    return _identified(_native.identify(_words(files, options)))


def predict(single: Path, **options: Any) -> Identified:
    """The pair of a run of one rotor or of its data sheet, by the options of ``cargo mixer predict``."""
    return _identified(_native.predict(_words([single], options)))


def _words(files: Sequence[Path], options: dict[str, Any]) -> list[str]:
    """The words of a command line."""
    words = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if option in ("--output", "--force", "--json", "--help"):
            raise MixerError(f"{name}: nothing is written or printed; the result has tables, report and json")
        for one in value if isinstance(value, list) else [value]:
            parts = one if isinstance(one, tuple) else [one]
            if one is True:
                words.append(option)
            elif one is not False and one is not None:
                words.append(f"{option}={','.join(str(part) for part in parts)}")
    try:
        return [*words, "--", *(os.fspath(file) for file in files)]
    except TypeError as error:
        raise MixerError(str(error)) from error


def _identified(texts: tuple[str, str, str, str, list[str]]) -> Identified:
    tables, report, details, numbers, notes = texts
    return Identified(tables, report, details, json.loads(numbers), notes)
