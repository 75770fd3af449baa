"""Files in, texts out: what the command line writes and says, to the byte."""

import json
import os
import pathlib
import subprocess
import sys

import coaxial_mixer
import numpy as np
import pytest
from coaxial_mixer import MixerError

ROOT = pathlib.Path(__file__).resolve().parents[3]
X8 = "airframes/isae-x8.toml"
SWEEP = "examples/bench/sweep.csv"
ROTOR = "examples/no-bench/rotor.csv"
FILES = "tools/cargo-mixer/tests/cases/files"
# Their texts are held in whole where they are; that they come through is seen by a part.
FAULTS = sorted(ROOT.glob("mixer-compiler/tests/diagnostics/*.toml"))[::5]
BENCH_DATA = os.environ.get("MIXER_BENCH_DATA")
BENCHES = sorted(pathlib.Path(BENCH_DATA).glob("newdexterity/*.csv")) if BENCH_DATA else []


def test_an_airframe_says_what_check_says(airframe, mixer, command):
    out, said, status = command("check", airframe)
    assert status == 0 and out.startswith(mixer.verdict) and mixer.verdict.startswith("airframe")
    numbers = json.loads(command("check", airframe, "--json")[0])
    del numbers["compile_ms"]
    assert mixer.json == numbers
    assert len(mixer.warnings) == len(numbers["warnings"]) == said.count("warning[")
    assert mixer.rust == command("expand", airframe)[0]


@pytest.mark.parametrize("path", FAULTS, ids=lambda path: path.stem)
def test_faults_are_the_text_of_the_command(path, command):
    path = path.relative_to(ROOT)
    with pytest.raises(MixerError) as told:
        coaxial_mixer.compile(path)
    _, said, status = command("check", path)
    assert status == 1 and said.rstrip("\n") == str(told.value).rstrip("\n")


def same(command, pair, function, files, **options):
    """Whether the function makes what the command does; else both refuse it in the same words."""
    name = function.__name__
    try:
        made = function(*files, **options)
    except MixerError as error:
        made = error
    words = [f"--{option.replace('_', '-')}={value}" for option, value in options.items()]
    numbers, said, status = command(name, *files, *words, "--json", "-o", pair)
    if status != 0:
        assert f"error: {made}\n" == said
        return False
    assert made.tables == pair.read_text() and made.json == json.loads(numbers)
    assert made.report.rstrip() == command(name, *files, *words)[0].rstrip()
    return True


@pytest.mark.parametrize("files, options", [
    ([SWEEP], {}),
    ([SWEEP], {"frame": "x8", "arm": 0.45, "name": "my-x8"}),
    ([SWEEP], {"basis": "quartic", "voltage_exponent": 1.8}),
    ([f"{FILES}/map.csv"], {"temperature": 20.0, "pressure": 1000.0}),
    ([f"{FILES}/sweep-1.csv", f"{FILES}/sweep-2.csv"], {}),
], ids=["plain", "frame", "basis", "air", "two"])
def test_identify_makes_what_the_command_makes(files, options, command, tmp_path):
    assert same(command, tmp_path / "pair.toml", coaxial_mixer.identify, files, **options)


def few_rows(folder):
    """Rows of a pair near what is predicted."""
    made = coaxial_mixer.predict(ROTOR, diameter=0.305, frame="x8", arm=0.4, name="my-x8")
    throttles = [(0.6, 0.6), (0.95, 0.4), (0.4, 0.95), (0.9, 0.9), (0.4, 0.4)]
    rows = coaxial_mixer.compile(made.tables).efforts([4 * [upper] + 4 * [lower] for upper, lower in throttles])[:, 0]
    lines = [",".join(map(str, [*pair, *row])) for pair, row in zip(throttles, rows * [1.03, 0.97])]
    few = folder / "few.csv"
    few.write_text("\n".join(["upper,lower,thrust_n,torque_nm", *lines]))
    return few


def test_few_rows_correct_a_prediction(command, tmp_path):
    options = {"prior": ROTOR, "diameter": 0.305, "spacing_ratio": np.float64(0.3)}
    assert same(command, tmp_path / "pair.toml", coaxial_mixer.identify, [few_rows(tmp_path)], **options)


@pytest.mark.parametrize("options", [
    {},
    {"spacing": 0.08, "diameter": 0.305, "frame": "x8", "arm": 0.4, "name": "my-x8"},
    {"run_voltage": 15, "reference_voltage": 14.8},
], ids=["plain", "frame", "voltage"])
def test_predict_makes_what_the_command_makes(options, command, tmp_path):
    assert same(command, tmp_path / "pair.toml", coaxial_mixer.predict, [ROTOR], **options)


@pytest.mark.parametrize("file", ["nowhere.csv", X8])
def test_what_cannot_serve_is_refused_in_the_same_words(file, command, tmp_path):
    assert not same(command, tmp_path / "pair.toml", coaxial_mixer.identify, [file])


@pytest.mark.skipif(not BENCHES, reason="MIXER_BENCH_DATA, the folder of real bench files, is not set")
def test_identify_makes_what_the_command_makes_of_real_benches(command, tmp_path):
    def rotor(stem):
        # The command names a `[[rotor]]` after its file, the function `rotor`.
        (tmp_path / stem).mkdir()
        return tmp_path / stem / "rotor.toml"

    made = [same(command, rotor(path.stem), coaxial_mixer.identify, [path]) for path in BENCHES]
    assert sum(made) >= 10


def test_values_of_options():
    plain = coaxial_mixer.identify(SWEEP)
    columns = [f"{role}={name}" for role, name in zip(["upper", "lower"], open(SWEEP).readline().split(","))]
    by_hand = coaxial_mixer.identify(SWEEP, column=columns, robust=False, basis=None, throttle=(0.2, 0.9), swap=True)
    assert "min = 0.2" in by_hand.tables and "min = 0.2" not in plain.tables
    assert all(f'"{column}"' in by_hand.tables for column in columns) and "--swap" in by_hand.tables


def test_a_text_is_compiled_as_its_file():
    text = (ROOT / X8).read_text()
    assert coaxial_mixer.compile(text).verdict == coaxial_mixer.compile(X8).verdict
    made = coaxial_mixer.predict(ROTOR, diameter=0.305, frame="x8", arm=0.4, name="my-x8")
    mixer = coaxial_mixer.compile(made.tables)
    assert (mixer.name, mixer.rotors, repr(mixer)) == ("my-x8", 8, "<Mixer my-x8, 8 rotors>")


@pytest.mark.parametrize("call, message", [
    (lambda x8: coaxial_mixer.compile("none.toml"), "No such file"),
    (lambda x8: coaxial_mixer.compile("airframes"), "Is a directory"),
    (lambda x8: x8.mix([0, 0, 0]), r"shape \(3,\) where \(N, 4\)"),
    (lambda x8: x8.mix(np.zeros((2, 2, 4))), r"shape \(2, 2, 4\)"),
    (lambda x8: x8.mix(np.zeros((3, 4)), volts=[14, 15]), r"volts of shape \(2,\)"),
    (lambda x8: x8.mix([[0, 0, 0, 9], [0, np.nan, 0, 9]]), "row 1: the pitch setpoint is not finite"),
    (lambda x8: x8.mix([0, 0, 0, 9], volts=np.inf), "the voltage is not finite"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=[8]), r"failed = \[8\] has what is no output: outputs, 0 to 7"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=[2**70]), "has what is no output: outputs, 0 to 7"),
    (lambda x8: coaxial_mixer.compile(b"name = \xff"), "UTF-8"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=4), "failed = 4 where a list is needed: outputs, 0 to 7, or 8 booleans"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=[-1]), r"failed = \[-1\] has what is no output"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=[1.5]), r"failed = \[1.5\] has what is no output"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=[True, False]), r"failed = \[True, False\] is no mask"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=[True] + [0] * 7), "is no mask"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=[0, 0, 0, 0, 1, 0, 0, 0]), "names an output twice; a mask has booleans, not 0 and 1"),
    (lambda x8: x8.mix([0, 0, 0, 9], failed=np.eye(8, dtype=int)[4]), "names an output twice; a mask has booleans, not 0 and 1"),
    (lambda x8: x8.mix(np.ma.masked_array([0, 0, 0, 9.0], [0, 0, 1, 0])), "the array has masked values"),
    (lambda x8: x8.mix([0, 0, 0, 9], volts=np.ma.masked_array([15.0], [True])), "volts has masked values"),
    (lambda x8: x8.mix([[0, 0, 0, 9], [0, 0, 0]]), "the array is no array of numbers"),
    (lambda x8: x8.mix(["0", "0", "0", "9"]), "values of type <U1, no real numbers"),
    (lambda x8: x8.mix([0, 0, 0, None]), "the thrust setpoint is not finite"),
    (lambda x8: x8.mix([0, 0, 0, 9j]), "values of type complex128"),
    (lambda x8: x8.mix([0, 0, 0, 10**400]), "the array is no array of numbers"),
    (lambda x8: x8.mix(None), r"shape \(\) where"),
    (lambda x8: x8.mix({"roll_nm": 0, "pitch_nm": 0, "thrust_n": 9}), "a table without yaw_nm: its columns are roll_nm, pitch_nm, thrust_n"),
    (lambda x8: x8.mix([0, 0, 0, 9], volts="15"), "volts has values of type <U2"),
    (lambda x8: coaxial_mixer.compile(5), "expected str, bytes or os.PathLike"),
    (lambda x8: coaxial_mixer.identify(5), "expected str, bytes or os.PathLike"),
    (lambda x8: x8.wrench([0.5] * 7 + [1.1]), "row 0: throttle_7 1.1 is outside 0 to 1"),
    (lambda x8: x8.wrench([0.5] * 8, volts=9), "voltage_v 9.0 is outside the airframe's range"),
    (lambda x8: coaxial_mixer.identify(), "BENCH.csv"),
    (lambda x8: coaxial_mixer.identify("a.csv", kapa=1), "a similar argument exists: '--kappa'"),
    (lambda x8: coaxial_mixer.identify(SWEEP, kappa=0.02), "or to --prior"),
    (lambda x8: coaxial_mixer.identify("a.csv", output="b.toml"), "output: nothing is written"),
    (lambda x8: coaxial_mixer.identify(SWEEP, frame="x8"), "arm"),
    (lambda x8: coaxial_mixer.predict("a.csv", spacing=0.08), "--diameter"),
])
def test_bad_input_says_what_is_wrong(call, message):
    with pytest.raises(MixerError, match=message):
        call(coaxial_mixer.compile(X8))


def test_the_document_runs(tmp_path, monkeypatch):
    block = (ROOT / "docs/python.md").read_text().split("```python\n")[1].split("```")[0]
    (tmp_path / "airframes").symlink_to(ROOT / "airframes")
    for name, file in [("map.csv", SWEEP), ("single.csv", ROTOR), ("rotor.csv", ROTOR)]:
        (tmp_path / name).symlink_to(ROOT / file)
    few_rows(tmp_path)
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(block, names)
    assert names["x8"].rotors == 8 and names["given"].shape == (2, 4)


def test_the_example_gives_the_figure_of_the_report(printed, tmp_path):
    out = tmp_path / "yaw.csv"
    subprocess.run([sys.executable, "tools/python/examples/yaw_sweep.py", X8, "40", out], check=True)
    made = {}
    for line in out.read_text().splitlines()[1:]:
        mixer, unit, *numbers = line.split(",")
        made.setdefault((mixer, int(unit)), []).append([float(x) for x in numbers])
    rows = [line.split(",") for line in printed("sweep", X8, "--figure", "yaw", "--thrust", 40).splitlines()]
    assert len(made) == 2 * 4
    for (mixer, unit), points in made.items():
        names = ["yaw_asked_nm", f"unit_{unit}_thrust_n", f"unit_{unit}_torque_nm"]
        columns = [rows[0].index(name) for name in names]
        expected = np.array([[row[k] for k in columns] for row in rows if row[0] == mixer], dtype=float)
        assert np.allclose(points, expected, atol=[1e-3, 2e-2, 5e-4], rtol=0)
