"""The page in its user's words, beside a picture: motors as the stack counts them, mends that name fields, work that is seen."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import expect

ROOT = Path(__file__).parents[3]
BENCH = ROOT / "examples/bench/sweep.csv"
X8 = ROOT / "airframes/isae-x8.toml"
WITH_POWER = ROOT / "airframes/x8-11in-least-power.toml"


def in_its_own_words(desk):
    """No option, no code, no determinant in what is seen."""
    text = desk.settled().page.evaluate("() => document.body.innerText")
    found = [line for line in text.splitlines() if re.search(r"--|MIX|det J", line)]
    assert not found, "\n".join(found)


def test_six_actions_from_a_bench_to_parameters(desk):
    in_its_own_words(desk)
    desk.drop(BENCH).says("the vehicle needs its frame and arm")
    in_its_own_words(desk)
    for field, value in [("#arm", "45 cm"), ("#mass_kg", "3"), ("#cells", "4")]:
        desk.page.fill(field, value)
        in_its_own_words(desk)
    desk.page.select_option("#stack", "px4")
    desk.compiles("my-x8")
    in_its_own_words(desk)
    name, content = desk.save("px4-own")
    assert name == "my-x8-own.params" and b"CA_ROTOR_COUNT\t8" in content


SHEET = b"Throttle (%),Thrust (gf)\n50,610\n65,900\n75,1120\n85,1350\n100,1700\n"
FOLDS = b"upper,lower,thrust_n,torque_nm\n" + b"".join(
    b"%.2f,%.2f,%.3f,%.4f\n" % (u, l, 12 * u * u + 10 * l * l, -0.4 * (u - 0.25) ** 2 + 0.4 * (l - 0.25) ** 2)
    for u in (0.1, 0.3, 0.5, 0.7, 0.9, 1) for l in (0.1, 0.3, 0.5, 0.7, 0.9, 1)
)


@pytest.mark.parametrize(
    "files, fields",
    [
        ([], {"#arm": "0.45"}),
        ([], {"#arm": "45", "#mass_kg": "3"}),
        ([("sheet.csv", SHEET)], {"#arm": "0.45"}),
        ([("sheet.csv", SHEET)], {"#arm": "0.45", "#diameter": "305", "#spacing": "80"}),
        ([("sheet.csv", SHEET)], {"#arm": "0.45", "#diameter": "0.305", "#cells": "6"}),
        ([BENCH], {"#arm": "0.45", "#cells": "4", "#diameter": "0.3"}),
        ([("folds.csv", FOLDS)], {"#arm": "0.45"}),
        ([("swapped.csv", BENCH.read_bytes().replace(b"upper", b"l0wer").replace(b"lower", b"upper").replace(b"l0wer", b"lower"))], {"#arm": "0.45"}),
        ([("odd.csv", b"a,b\n1,2\n")], {"#arm": "0.45"}),
        ([("units.csv", b"upper,lower,thrust,torque\n.6,.6,14,-0.02\n.95,.4,17.5,-0.27\n.4,.95,21,0.22\n.95,.95,30,-0.03\n")], {}),
        ([X8], {"#yaw_reserve_nm": "9"}),
    ],
    ids=["no bench", "centimetres", "no diameter", "millimetres", "cells", "unused", "folds", "exchanged", "odd", "units", "reserve"],
)
def test_what_is_told_names_fields(desk, files, fields):
    if files:
        desk.drop(*files)
    for field, value in fields.items():
        desk.opened(field).fill(value)
        desk.settled()
    desk.page.evaluate("() => { for (const box of document.querySelectorAll('#noted, #reading, #rare')) box.open = true; }")
    in_its_own_words(desk)


def test_a_mend_opens_and_fills_its_field_once(desk):
    desk.page.fill("#arm", "0.45")
    desk.drop(("sheet.csv", SHEET))
    desk.shows("#diameter-refused", "Diameter")
    desk.page.fill("#diameter", "305")
    buttons = desk.settled().see("#diameter-refused button")
    expect(buttons).to_have_text(["Set Diameter to 0.305"])
    buttons.click()
    desk.compiles("my-x8")
    assert desk.see("#diameter").input_value() == "0.305"


FIELDS = [
    ("arm", "450", "Set Arm to 0.45"),
    ("arm", "long", None),
    ("name", "!!!", None),
    ("name", "type", None),
    ("mass_kg", "0", None),
    ("cells", "six", None),
    ("capacity", "much", None),
    ("diameter", "12", None),
    ("voltage-exponent", "9", None),
    ("pwm-range", "7", None),
    ("pulses", "2000,1000", None),
    ("temperature", "hot", None),
    ("reference-voltage", "-3", None),
    ("yaw_reserve_nm", "-1", None),
    ("power_bias_nm_per_n", "5", None),
    ("options", "--bassis cubic", None),
]


@pytest.mark.parametrize("field, value, mend", FIELDS, ids=[f"{field}={value}" for field, value, _ in FIELDS])
def test_what_is_refused_changes_nothing(desk, field, value, mend):
    """In every field alike: the sentence stands beside it; picture, sliders, report and files stay."""
    for name, text in [("arm", "0.45"), ("mass_kg", "3")]:
        desk.page.fill(f"#{name}", text)
    desk.drop(ROOT / "examples/no-bench/rotor.csv")
    desk.page.fill("#diameter", "0.305")
    desk.compiles("my-x8")
    before = desk.save("airframe"), desk.save("px4-own")
    desk.opened(f"#{field}").fill(value)
    for _ in range(2):
        desk.settled().shows("#status.error", "is refused")
        expect(desk.see(f"#{field}-refused")).to_be_visible()
        assert len(desk.see(f"#{field}-refused").text_content()) > 10 and desk.see(f"#{field}").input_value() == value
        for part in ["#hovering .ring", "#hand", "#report svg"]:
            expect(desk.see(part).first).to_be_visible()
        assert (desk.save("airframe"), desk.save("px4-own")) == before
        desk.page.reload()
    if mend:
        desk.settled().page.get_by_role("button", name=mend).click()
        desk.compiles("my-x8")
        assert desk.save("airframe") == before[0]


@pytest.mark.parametrize("typed, made", [("My X8", "my-x8"), ("Müller 2", "muller-2"), ("450", "x-450"), ("a__b", None)])
def test_a_name_is_made_of_what_is_typed(desk, typed, made):
    desk.page.fill("#arm", "0.45")
    desk.compiles("my-x8")
    desk.opened("#name").fill(typed)
    if made is None:
        desk.settled().says("Name is refused")
        return
    desk.compiles(made).shows("#name-made", made)
    assert desk.save("airframe")[0] == f"{made}.toml"


def test_motors_are_those_of_the_stack(desk):
    desk.drop(X8).compiles("isae-x8").still()
    assert desk.see("#rotors button").all_text_contents()[:2] == ["motor 1 \u2191 front right", "motor 2 \u2191 front left"]
    for picture in ["#hovering", "#top"]:
        numbers = sorted(int(re.match(r"\d+", text)[0]) for text in desk.see(f"{picture} text").all_text_contents())
        assert numbers == list(range(1, 9))
    desk.shows(".counted", "Motors as PX4 counts them: motor 1 is output 0").shows("#report #layout", "Motor 1 is output 0")
    assert desk.see("#bench-check .outputs th[scope=row]").all_text_contents() == [str(k) for k in range(1, 9)]
    desk.page.select_option("#stack", "own")
    desk.still().shows(".counted", "from 0")
    assert desk.see("#rotors button").first.text_content() == "output 0 \u2191 front right"


def test_the_picture_is_there_from_the_first_second(visit):
    """Beside the fields on the first screen, with motors and spins, before the compiler has answered anything; and it is the example's."""
    silent = "const Of = Worker; globalThis.Worker = class extends Of { postMessage() {} };"
    early = visit(init=silent)
    box = early.see("#hovering").bounding_box()
    assert box["y"] + box["height"] < 900 and box["x"] > 900, box
    turned = lambda desk: [re.match(r"\d+[\u21ba\u21bb]", text)[0] for text in desk.see("#hovering text").all_text_contents()]
    ready = visit().ready().settled()
    assert turned(early) == turned(ready)


def test_the_picture_draws_what_is_typed(desk):
    side = lambda: " ".join(desk.see("#side text").all_text_contents())
    for field, value, told in [("arm", "45 cm", "Arm 0.45 m"), ("spacing", "8 cm", "Spacing 0.08 m"), ("diameter", '12"', "Diameter 0.3048 m")]:
        desk.page.fill(f"#{field}", value)
        assert told in side()
        desk.page.fill(f"#{field}", "much")
        assert told in side()


def test_time_in_hover(desk):
    desk.drop(WITH_POWER).compiles()
    time = desk.see("#numbers div", has_text="Time in hover")
    expect(time).to_contain_text("needs the capacity of the pack")
    desk.page.fill("#capacity", "10 Ah")
    desk.settled()
    minutes, mah, volts, watts = map(float, re.search(r"([\d.]+) min80 % of (\d+) mAh at ([\d.]+) V, ([\d.]+) W", time.text_content()).groups())
    assert mah == 10000 and minutes == pytest.approx(60 * 0.8 * 10 * volts / watts, rel=0.03)
    assert 100 < watts < 2000


def test_notes_are_apart_and_counted(desk):
    desk.shell(f"cargo mixer params {X8} --stack px4 --own -o x8.params")
    desk.drop(("x8.params", desk.file("x8.params")), BENCH).compiles("imported-x8")
    status = desk.see("#status").text_content()
    warnings, notes = map(int, re.search(r"(\d+|no) warnings?, (\d+) notes?", status.replace("no warnings", "0 warnings")).groups())
    assert desk.see("#faults li").count() == warnings and desk.see("#notes li").count() == notes > 1
    expect(desk.see("#notes")).to_be_hidden()
    expect(desk.see("#noted summary")).to_have_text(f"{notes} notes")
    assert not desk.see("#notes .warning").count() and not desk.see("#faults .note").count()


def long_file():
    """200,000 rows of a hundred commands, as a logger writes them."""
    rows = (f"{0.1 + 0.1 * (k // 2000 // 10):.1f},{0.1 + 0.1 * (k // 2000 % 10):.1f},{k % 7 / 100}" for k in range(200_000))
    def row(text):
        u, l, noise = map(float, text.split(","))
        return f"{u:.1f},{l:.1f},{12 * u * u + 10 * l * l * (1 - 0.2 * u) + noise:.2f},{0.19 * l * l - 0.18 * u * u:.3f}"
    return ("long.csv", ("upper,lower,thrust_n,torque_nm\n" + "\n".join(map(row, rows))).encode())


def test_long_work_is_seen_and_can_be_stopped(desk, capsys):
    desk.page.fill("#arm", "0.45")
    before = desk.compiles("my-x8").save("airframe")
    name, content = long_file()
    assert len(content) < 4 << 20
    path = desk.shell.folder / name
    path.write_bytes(content)
    desk.page.set_input_files("#choose", path)
    expect(desk.see("#work")).to_be_visible()
    desk.shows("#work", "long.csv")
    desk.click("#stop")
    desk.compiles("my-x8")
    expect(desk.see("#work")).to_be_hidden()
    expect(desk.see("#dropped li")).to_have_count(0)
    assert desk.save("airframe") == before
    took = desk.page.evaluate("() => { globalThis.began = performance.now(); }")
    desk.page.set_input_files("#choose", path)
    desk.shows("#read", "long.csv").compiles("my-x8")
    took = desk.page.evaluate("() => (performance.now() - began) / 1000")
    with capsys.disabled():
        print(f"\n200,000 rows, all that comes of them: {took:.1f} s")
    assert took < 30


def test_what_was_forgotten_can_be_brought_back(desk):
    desk.drop(BENCH)
    desk.page.fill("#arm", "0.4")
    before = desk.compiles("my-x8").save("airframe")
    box = desk.see("#report input[type=checkbox]").first
    box.check()
    desk.click("#forget")
    desk.ready().click("#unforget")
    desk.compiles("my-x8")
    assert desk.save("airframe") == before
    expect(box).to_be_checked()
    expect(desk.see("#unforget")).to_be_hidden()


def test_a_row_of_a_table_is_pasted_into_the_data_sheet(desk):
    paste = """(text) => {
        const clipboardData = new DataTransfer();
        clipboardData.setData("text", text);
        document.getElementById("thrust-50").dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
    }"""
    desk.page.evaluate(paste, "610\t2 lb\t1 120\t1,35 kg\t60 oz\r\n")
    desk.settled()
    assert [desk.see(f"#thrust-{k}").input_value() for k in (50, 65, 75, 85, 100)] == ["610", "2 lb", "1 120", "1,35 kg", "60 oz"]
    desk.page.fill("#diameter", '12"')
    _, content = desk.save("sheet")
    assert [round(float(line.split(",")[1]), 1) for line in content.decode().splitlines()[1:]] == [610, 907.2, 1120, 1350, 1701]
