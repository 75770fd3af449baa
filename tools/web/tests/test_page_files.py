"""Files dropped on the page: the airframe is the command line's to the byte, or the file is refused by name."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import expect

ROOT = Path(__file__).parents[3]
BENCH = ROOT / "examples/bench/sweep.csv"
ROTOR = ROOT / "examples/no-bench/rotor.csv"
X8 = ROOT / "airframes/isae-x8.toml"
DIAGNOSTICS = ROOT / "mixer-compiler/tests/diagnostics"
WARNINGS = ROOT / "mixer-compiler/tests/warnings"


# Four points of a pair of the rotors of CASES/rotor.csv.
FEW = ("few.csv", b"upper,lower,thrust_n,torque_nm\n.6,.6,14,-0.02\n.95,.4,17.5,-0.27\n.4,.95,21,0.22\n.95,.95,30,-0.03\n")
CASES = ROOT / "tools/cargo-mixer/tests/cases/files"

# A quadcopter of the single rotors of y4.
_, ROTOR_OF_Y4 = (ROOT / "airframes/y4.toml").read_text().split("\n[[rotor]]\n")
QUAD = 'name = "quad"\n[throttle]\nmin = 0.2\nmax = 0.95\n[[rotor]]\n' + ROTOR_OF_Y4.split("[[unit]]")[0] + "".join(
    f'[[unit]]\nposition_m = [{x}, {y}, 0.0]\nupper_spin = "{spin}"\nrotor = "front"\nchannels = [{channel}]\n'
    for channel, (x, y, spin) in enumerate([(0.3, 0.3, "ccw"), (-0.3, -0.3, "ccw"), (0.3, -0.3, "cw"), (-0.3, 0.3, "cw")])
) + "[vehicle]\nmass_kg = 4.2\n"


def parameters(desk):
    desk.shell(f"cargo mixer params {X8} --stack px4 --own -o x8.params")
    return "x8.params", desk.file("x8.params")


def words(text):
    """A table of the page or of the terminal."""
    return text.split()


def pair(desk):
    desk.shell(f"cargo mixer identify {BENCH} -o tables.toml")
    return "tables.toml", desk.file("tables.toml")


@pytest.mark.parametrize(
    "files, command, outputs",
    [
        (lambda _: [BENCH], "cargo mixer identify sweep.csv", ["pair", "airframe"]),
        (lambda _: [ROTOR], "cargo mixer predict rotor.csv", ["pair", "airframe"]),
        (lambda _: [FEW, CASES / "rotor.csv"], "cargo mixer identify few.csv --prior rotor.csv", ["pair", "airframe"]),
        (lambda desk: [parameters(desk), BENCH], "--pair pair.toml", ["pair", "airframe"]),
        (lambda desk: [pair(desk)], "cargo mixer new --frame x8 --pair tables.toml", ["airframe"]),
    ],
    ids=["bench", "run", "bench-and-run", "parameters", "pair"],
)
def test_files_become_the_airframe_of_the_command_line(desk, files, command, outputs):
    desk.page.fill("#arm", "0.45")
    desk.drop(*files(desk)).shows("#command", command).compiles()
    printed = desk.run_shown()
    for output in outputs:
        name, content = desk.save(output)
        assert content == desk.file(name)
    if "pair" in outputs:
        assert words(desk.opened("#pair-report").inner_text()) == words(printed)
    expect(desk.see("details:has(> #pair-report)")).to_be_visible(visible="pair" in outputs)
    expect(desk.opened("#verdict")).to_be_visible()


def test_an_airframe_file_stays_as_it_is(desk):
    desk.drop(X8).compiles("isae-x8")
    assert desk.save("airframe") == ("isae-x8.toml", X8.read_bytes())
    assert words(desk.opened("#verdict").inner_text()) == words(desk.shell("cargo mixer check isae-x8.toml").split("\nnext ")[0])


@pytest.mark.parametrize("name, rotors", [("y4", "4 in 1 coaxial unit and 2 single ones"), ("hexa-stacked", "8 in 2 coaxial units and 4 single ones"), ("quad", "4, all single")])
def test_single_rotors_are_shown_kept_and_saved(desk, name, rotors):
    path = ROOT / f"airframes/{name}.toml"
    content = (QUAD if name == "quad" else path.read_text()).encode()
    desk.drop((path.name, content))
    for _ in range(2):
        desk.compiles(name)
        assert desk.see("#frame option:checked").text_content() == f"of the file: {rotors}"
        expect(desk.see("#rings")).to_be_visible(visible=name != "quad")
        expect(desk.see("#report #rotors svg").first).to_be_visible()
        assert desk.see("#report #forward").count() == (name != "quad")
        throttle = desk.see("#numbers dd b").first.text_content()
        assert ("single" in throttle) == (name != "quad") and "%" in throttle
        desk.page.reload()
    assert desk.compiles(name).save("airframe") == (path.name, content)
    desk.page.select_option("#frame", "y6")
    desk.page.fill("#arm", "0.4")
    desk.settled()
    assert desk.see("#frame").input_value() == "y6"
    expect(desk.see("#replace")).to_be_visible()


def test_two_pairs_make_one_frame(desk):
    desk.page.fill("#arm", "0.45")
    desk.drop(BENCH, ("other.csv", BENCH.read_bytes())).shows("#read", "are read as benches of one pair")
    desk.page.get_by_label("Remove sweep.csv").click()
    desk.page.get_by_label("Remove other.csv").click()
    desk.shell(f"cargo mixer identify {BENCH} -o front.toml && cargo mixer identify {BENCH} --basis cubic -o rear.toml")
    for name in ["front.toml", "rear.toml"]:
        desk.drop((name, desk.file(name)))
    desk.shows("#command", "--pair front=front.toml --pair rear=rear.toml").compiles("my-x8")
    desk.run_shown()
    name, content = desk.save("airframe")
    assert content == desk.file(name)
    assert content.count(b"[[pair]]") == 2


def test_options_are_those_of_the_command_line(desk):
    desk.drop(BENCH)
    desk.opened("#help")
    desk.page.fill("#options", "--basis 'cubic' --temperature 18 --pressure 950")
    desk.shows("#help", "--temperature").shows("#command", "--pressure 950")
    desk.page.fill("#arm", "0.3")
    desk.page.select_option("#frame", "y6")
    desk.page.select_option("#stack", "ardupilot")
    desk.opened("#name").fill("mine")
    desk.shows("#command", "--name mine --outputs ardupilot").compiles("mine")
    desk.run_shown()
    for output in ["pair", "airframe"]:
        name, content = desk.save(output)
        assert content == desk.file(name)
    desk.see("#options").fill("--bassis cubic")
    desk.shows("#options-refused", "unexpected argument").shows("#options-refused", "bassis")


def test_what_a_file_is_can_be_told(desk):
    desk.drop(BENCH).shows("#dropped", "sweep.csv")
    desk.page.get_by_label("What sweep.csv is").select_option("parameters")
    desk.shows("#faults .error", "sweep.csv")
    desk.page.get_by_label("Remove sweep.csv").click()
    desk.settled().says("An example is shown")


def test_bad_cells_are_mended_in_the_editor(desk):
    """Two rows of 36 are too many: an error. One is passed over with a warning, none is a good file."""
    text = BENCH.read_text()
    cells = [text.splitlines()[line - 1].split(",")[2] for line in (7, 9)]
    desk.page.fill("#arm", "0.45")
    bad = text.replace(f",{cells[0]},", ",1o.5,").replace(f",{cells[1]},", ",17..2,")
    desk.drop(("bench.csv", bad.encode())).shows("#faults .error", "bench.csv:7").shows("#editor .marks .error", "1o.5")
    desk.page.get_by_role("button", name="bench.csv:7").click()
    line = "() => document.activeElement.value.slice(0, document.activeElement.selectionStart).split('\\n').length"
    assert desk.page.evaluate(line) == 7
    desk.replace("1o.5", cells[0]).shows("#faults .warning", "17..2").shows("#editor .marks .warning", "17..2")
    expect(desk.see("#faults .error")).to_have_count(0)
    desk.page.get_by_role("button", name="bench.csv:9").click()
    desk.replace("17..2", cells[1])
    expect(desk.see("#faults .place")).to_have_count(0)
    (desk.shell.folder / "bench.csv").write_text(text)
    desk.compiles().run_shown()
    name, content = desk.save("airframe")
    assert content == desk.file(name)


def test_faults_of_an_airframe_stand_at_their_lines(desk):
    for name in ["fold", "unknown-key", "rank-no-pitch", "many-faults", "crlf", "multibyte-before-the-caret"]:
        path = DIAGNOSTICS / f"{name}.toml"
        told = path.with_suffix(".txt").read_text()
        codes, places = re.findall(r"^(\w+)\[(MIX\d+)\]: ", told, re.M), re.findall(r"^ *--> (.*):\d+$", told, re.M)
        desk.drop(path).says(f"in {path.name}")
        seen = desk.see("#faults li").evaluate_all("(items) => items.map((item) => [item.className, item.dataset.code])")
        assert seen == [[severity, code] for severity, code in codes]
        assert desk.see("#faults .place").all_text_contents() == places
        assert desk.see("#editor .marks span").count() == len(set(places))
        expect(desk.see("#hand")).to_be_hidden()


def test_a_fold_is_typed_away(desk):
    desk.drop(DIAGNOSTICS / "fold.toml").tells("MIX201")
    desk.replace("0.05", "0.1").compiles("isae-x8")
    assert desk.faults() == []
    expect(desk.see("#hand")).to_be_visible()
    desk.replace("0.1", "").says("error").shows("#faults", "fold.toml:5")
    expect(desk.see("#hand")).to_be_hidden()


def test_warnings_stand_at_their_lines(desk):
    path = WARNINGS / "arm-in-decimetres.toml"
    desk.drop(path).says("warning").shows("#faults .warning", "arm-in-decimetres.toml:")
    told = path.with_suffix(".txt").read_text()
    assert all(code in told for code in desk.see("#faults li").evaluate_all("(items) => items.map((item) => item.dataset.code)"))
    expect(desk.see("#editor .marks span.warning").first).to_be_visible()
    expect(desk.see("#hand")).to_be_visible()


ODD = {
    "empty.csv": b"",
    "letter.txt": b"Dear all,\nthe rotors arrived.\n",
    "log_0.ulg": b"ULog\x01\x12\x35\x01" + bytes(range(256)) * 40,
    "two words.csv": b"a,b\n1,2\n",
    "it's \"mine\".csv": b"a,b\n1,2\n",
    "<img src=x onerror=alert(1)>.csv": b"<img src=x onerror=alert(1)>,upper\n<script>alert(1)</script>,1\n",
    "empty.toml": b"",
    "long.csv": b"upper,lower,thrust_n,torque_nm\n" + b"0.5,0.5,x,0.1\n" * 5_000,
    "one-line.csv": b"upper,lower,thrust_n" * 1_000,
}


def test_what_is_no_airframe_and_no_bench_is_refused_by_name(desk):
    for name, content in ODD.items():
        desk.drop((name, content)).settled().shows(":is(#faults, #dropped) .error", name)
        assert desk.see("img").count() == 0
        buttons = desk.see("#dropped button, #aside button:not(.back)")
        while buttons.count():
            buttons.first.click()
            desk.settled()
        desk.drop(X8).compiles("isae-x8")
        expect(desk.see("#faults li, #dropped li")).to_have_count(0)


def test_a_file_that_is_too_large_is_refused_by_name(desk):
    path = desk.shell.folder / "log.csv"
    path.write_bytes(b"upper,lower,thrust_n,torque_nm\n" + b"0.5,0.5,9,0.1\n" * 400_000)
    desk.page.set_input_files("#choose", [path, X8])
    desk.shows("#dropped .error", "log.csv").shows("#dropped .error", "4 MB").compiles("isae-x8")


def test_a_name_with_quotes_is_a_word_of_the_shown_command(desk):
    desk.page.fill("#arm", "0.45")
    desk.drop(("it's \"my\" $bench.csv", BENCH.read_bytes())).compiles()
    desk.run_shown()
    name, content = desk.save("airframe")
    assert content == desk.file(name)


def test_the_newest_of_two_files_with_one_name_counts(desk):
    desk.page.fill("#arm", "0.45")
    desk.drop(("bench.csv", b"a,b\n1,2\n")).shows("#faults .error", "bench.csv")
    desk.drop(("bench.csv", BENCH.read_bytes())).compiles()
    assert desk.see("#dropped li").count() == 1


def test_an_airframe_can_be_typed(desk):
    """Every seventh beginning of a file is answered, and the last line key by key."""
    text = X8.read_text()
    answers = desk.page.evaluate(
        "async (text) => { const of = []; for (let n = 0; n <= text.length; n += 7) of.push(await ask('check', 'x.toml', text.slice(0, n))); return of; }", text
    )
    assert all(answer["errors"] or answer["verdict"] for answer in answers)
    head, last = text.rstrip("\n").rsplit("\n", 1)
    desk.page.fill("#editor textarea", head + "\n")
    desk.see("#editor textarea").press_sequentially(last)
    desk.compiles("isae-x8")
    assert desk.text() == head + "\n" + last


def test_fields_without_effect_are_left_out_and_said(desk):
    """An arm beside places, and cells beside rows of one voltage, whose mend is a button."""
    desk.page.fill("#arm", "0.45")
    desk.page.fill("#cells", "4")
    desk.drop(parameters(desk), BENCH).compiles()
    desk.shows("#notes", "\u201cPack\u201d has nothing to work on").shows("#notes", "\u201cArm\u201d has nothing to work on")
    command = desk.see("#command").inner_text()
    assert "--arm" not in command and "--cells" not in command
    desk.run_shown()
    desk.opened("#notes").get_by_role("button", name="Set Exponent of the voltage to 1.75").click()
    desk.shows("#command", "--cells 4").compiles()


def test_a_data_sheet_has_its_fields(desk):
    desk.click("#example-sheet")
    desk.compiles("my-x8").shows("#command", "cargo mixer predict rotor.csv -o pair.toml --diameter 0.305 --spacing 0.08")
    desk.page.fill("#cells", "6")
    desk.opened("#options").fill("--reference-voltage 22.2 --run-voltage 22.2")
    desk.shows("#command", "--cells 6").compiles("my-x8")
    sheet = ROOT / "examples/no-bench/rotor.csv"
    (desk.shell.folder / "rotor.csv").write_bytes(sheet.read_bytes())
    desk.run_shown()
    for output in ["pair", "airframe"]:
        name, content = desk.save(output)
        assert content == desk.file(name)
