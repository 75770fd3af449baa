"""Arrays in, arrays out: the bits of the command line on every shipped airframe."""

import pickle
import sys
import threading
import time
import tomllib

import coaxial_mixer
import numpy as np
import pytest

AXES = ["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"]
CONDITIONS = ["voltage_v", "density_kg_m3"]


def csv(columns, rows):
    # The shortest text of a number reads back to the same bits.
    lines = (",".join(str(value) for value in row) for row in rows)
    return "\n".join([",".join(columns), *lines])


def table(text, dtype):
    return np.array([line.split(",") for line in text.splitlines()[1:]]).astype(dtype)


def size(mixer):
    """The largest wrench on each axis, of rotors at either end of their range."""
    ends = np.random.default_rng(2).choice([0.2, 1.0], (500, mixer.rotors))
    return np.abs(mixer.wrench(ends)).max(axis=0)


def setpoints(mixer):
    """Wrenches from attainable to far beyond, voltages and densities in and around their ranges."""
    draw = np.random.default_rng(1)
    wrenches = draw.uniform([-1, -1, -1, 0], 1, (300, 4)) * size(mixer) * draw.choice([0.05, 0.3, 1.0], (300, 1))
    conditions = draw.uniform([10, 0.7], [18, 1.5], (300, 2))
    return wrenches.astype(np.float32), conditions.astype(np.float32)


def bits(array):
    return np.ascontiguousarray(array).view(f"u{array.itemsize}")


@pytest.mark.parametrize("failed", [[], [1]], ids=["all", "out"])
def test_mix_gives_the_bits_of_the_command(airframe, mixer, printed, failed):
    wrenches, conditions = setpoints(mixer)
    rows = csv(AXES + CONDITIONS, np.column_stack([wrenches, conditions]))
    option = [f"--failed={channel}" for channel in failed]
    expected = table(printed("mix", airframe, *option, stdin=rows), np.float32)
    mixed = mixer.mix(wrenches, conditions[:, 0], failed, conditions[:, 1])
    n = mixer.rotors
    assert np.array_equal(bits(mixed.throttles), bits(expected[:, :n]))
    assert np.array_equal(bits(mixed.achieved), bits(expected[:, n : n + 4]))
    assert np.array_equal(mixed.saturation, expected[:, n + 4])
    assert (mixed.saturation != 0).sum() > 5 and len(np.unique(mixed.throttles)) > 50


@pytest.mark.parametrize("failed", [[], [1]], ids=["all", "out"])
def test_wrench_gives_the_bits_of_the_command(airframe, mixer, printed, failed):
    throttles = np.random.default_rng(2).uniform(0, 1, (200, mixer.rotors))
    rows = csv([f"throttle_{k}" for k in range(mixer.rotors)], throttles)
    option = [f"--failed={channel}" for channel in failed]
    expected = table(printed("wrench", airframe, *option, stdin=rows), np.float64)
    given = mixer.wrench(throttles, failed=failed)
    assert np.array_equal(bits(given), bits(expected))
    # The axes of the shipped airframes are vertical.
    assert np.allclose(mixer.efforts(throttles, failed=failed)[..., 0].sum(axis=1), given[:, 3], rtol=1e-12)


def test_throttles_of_mix_give_its_wrench(airframe, mixer):
    wrenches, _ = setpoints(mixer)
    voltage = tomllib.loads(airframe.read_text()).get("voltage", {"range_v": [1, 2]})
    volts = np.linspace(*voltage["range_v"], 302)[1:-1]
    mixed = mixer.mix(wrenches, volts)
    missed = np.abs(mixer.wrench(mixed.throttles, volts) - mixed.achieved)
    assert (missed <= 2e-5 * size(mixer)).all(), missed.max(axis=0)


def test_the_conventional_mixer_is_that_of_the_report(printed):
    airframe = "airframes/isae-x8.toml"
    rows = [line.split(",") for line in printed("sweep", airframe, "--figure", "yaw").splitlines()]
    rows = [dict(zip(rows[0], row)) for row in rows[1:] if row[0] == "conventional"]
    mixer = coaxial_mixer.conventional(airframe)
    mixed = mixer.mix([[0, 0, float(row["yaw_asked_nm"]), 40] for row in rows])
    given = mixer.wrench(mixed.throttles)
    for k, row in enumerate(rows):
        assert mixed.within[k] == (row["throttle_limited"] == "0")
        assert given[k, 2:] == pytest.approx([float(row["yaw_given_nm"]), float(row["thrust_given_n"])], abs=1e-5)
        for unit, channels in enumerate(mixer.channels):
            expected = [float(row[f"unit_{unit}_{rotor}_throttle"]) for rotor in ["upper", "lower"]]
            assert mixed.throttles[k, channels] == pytest.approx(expected, rel=1e-6)
    assert len(rows) == 25 and 0 < mixed.within.sum() < 25


def test_one_setpoint_none_and_slices(mixer):
    one = mixer.mix([0, 0, 0, 10.0])
    assert one.throttles.shape == (1, mixer.rotors) and one.throttles.dtype == np.float32
    none = mixer.mix(np.empty((0, 4)))
    assert [len(part) for part in none] == [0, 0, 0] and none.throttles.shape == (0, mixer.rotors)
    rows = np.arange(80.0).reshape(10, 8)[::2, ::2] % 7
    assert np.array_equal(mixer.mix(rows).throttles, mixer.mix(rows.copy()).throttles)


def test_rotors_out_are_channels_or_a_mask(mixer):
    at = [0, 0, 0, 0.3 * size(mixer)[3]]
    mask = [channel == 1 for channel in range(mixer.rotors)]
    by_channel = mixer.mix(at, failed=[1])
    for failed in (mask, np.array(mask), (1,), np.array([1])):
        assert np.array_equal(mixer.mix(at, failed=failed).throttles, by_channel.throttles)
    none_out = mixer.mix(at, failed=[False] * mixer.rotors)
    assert np.array_equal(none_out.throttles, mixer.mix(at).throttles)


def test_tables_with_names_are_read_by_them(mixer):
    class Frame:
        """As a DataFrame: columns by name, values by position."""

        def __init__(self, columns):
            self._columns = columns

        @property
        def columns(self):
            return list(self._columns)

        def __getitem__(self, name):
            return self._columns[name]

        def __array__(self, dtype=None, copy=None):
            return np.column_stack(list(self._columns.values())).astype(dtype)

    wrenches, conditions = setpoints(mixer)
    columns = dict(zip(AXES, wrenches.T))
    shuffled = {"note": np.zeros(len(wrenches)), **{name: columns[name] for name in reversed(AXES)}}
    expected = mixer.mix(wrenches, volts=15.0)
    structured = np.zeros(len(wrenches), [(name, np.float64) for name in shuffled])
    for name, values in shuffled.items():
        structured[name] = values
    for table in (Frame(shuffled), shuffled, structured):
        assert np.array_equal(mixer.mix(table, volts=15.0).throttles, expected.throttles)
    with_volts = Frame({"voltage_v": conditions[:, 0], **shuffled})
    expected = mixer.mix(wrenches, volts=conditions[:, 0]).throttles
    assert np.array_equal(mixer.mix(with_volts).throttles, expected)
    with pytest.raises(coaxial_mixer.MixerError, match="volts is given, and the table has voltage_v"):
        mixer.mix(with_volts, volts=15.0)
    with pytest.raises(coaxial_mixer.MixerError, match="columns of different lengths: roll_nm 3, pitch_nm 2"):
        mixer.mix({**shuffled, "roll_nm": [0.0] * 3, "pitch_nm": [0.0] * 2, "yaw_nm": [0.0] * 3, "thrust_n": [9.0] * 3})
    names = [f"throttle_{k}" for k in range(mixer.rotors)]
    backwards = Frame({name: expected[:, k] for k, name in reversed(list(enumerate(names)))})
    assert np.array_equal(mixer.wrench(backwards), mixer.wrench(expected))
    # Numbers as names are positions.
    assert np.array_equal(mixer.mix(Frame(dict(enumerate(wrenches.T)))).throttles, mixer.mix(wrenches).throttles)


def test_other_threads_go_on_while_rows_are_mixed():
    mixer = coaxial_mixer.compile("airframes/isae-x8.toml")
    rows = np.tile([[0.5, 0.0, 0.1, 40.0]], (5_000, 1))
    ticks = []
    done = threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(None)
            time.sleep(0)

    other = threading.Thread(target=tick)
    # A thread that wants the interpreter gets it at the end of a call at the earliest.
    before = sys.getswitchinterval()
    sys.setswitchinterval(1000.0)
    try:
        other.start()
        began = len(ticks)
        mixer.mix(rows)
        during = len(ticks) - began
    finally:
        done.set()
        sys.setswitchinterval(before)
        other.join()
    assert during > 10


def test_a_mixer_is_kept_by_pickle_and_made_of_bytes(airframe):
    mixer = coaxial_mixer.compile(airframe)
    with open(airframe, "rb") as file:
        of_bytes = coaxial_mixer.compile(file.read())
    for made in (pickle.loads(pickle.dumps(mixer)), of_bytes):
        assert made.rust.splitlines()[4:] == mixer.rust.splitlines()[4:]
        assert np.array_equal(made.mix([0.1, 0, 0, 20]).throttles, mixer.mix([0.1, 0, 0, 20]).throttles)
    kept = pickle.loads(pickle.dumps(coaxial_mixer.conventional(airframe)))
    assert kept.name == mixer.name


def test_the_package_names_what_it_has():
    assert all(hasattr(coaxial_mixer, name) for name in coaxial_mixer.__all__)
    assert coaxial_mixer.__version__.count(".") == 2
