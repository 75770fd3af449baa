"""The mixer under the sliders: throttles are those of `cargo mixer mix` to the bit."""

import csv
import io
import re
import struct
from pathlib import Path

import pytest
from playwright.sync_api import expect

ROOT = Path(__file__).parents[3]
AIRFRAMES = ROOT / "airframes"


@pytest.fixture
def hand(desk):
    def of(name):
        desk.drop(AIRFRAMES / f"{name}.toml").compiles().still()
        return desk

    return of


def bits(text):
    return struct.pack("<f", float(text))


def column(desk, table, k):
    """All the digits; what is read has few."""
    cells = desk.see(f"#{table} tbody tr td:nth-of-type({k})")
    assert all(re.fullmatch(r"-?\d+(\.\d{1,3})?|-?\d+\.0*\d{1,4}|-?\d(\.\d+)?e-\d+", text) for text in cells.all_text_contents()), cells.all_text_contents()
    return cells.evaluate_all("(cells) => cells.map((cell) => cell.dataset.exact)")


def same_as_mix(desk, name, failed=()):
    """Holds the tables against `cargo mixer mix` of the setpoint and the conditions that are shown."""
    desk.still()
    row = dict(zip(["roll_nm", "pitch_nm", "yaw_nm", "thrust_n"], column(desk, "wrench", 1)))
    for key, id in [("voltage_v", "volts"), ("density_kg_m3", "density")]:
        if desk.see(f"#{id}").count():
            row[key] = desk.see(f"#{id}-number").input_value()
    out = "".join(f" --failed {channel}" for channel in failed)
    answer = desk.shell(f"cargo mixer mix {name}{out}", f"{','.join(row)}\n{','.join(row.values())}\n")
    [mixed] = csv.DictReader(io.StringIO(answer))
    values = list(mixed.values())
    shown = column(desk, "throttles", 1) + column(desk, "wrench", 2)
    assert [bits(text) for text in shown] == [bits(text) for text in values[:-1]]
    assert desk.see("#flags").get_attribute("data-bits") == values[-1]
    return row, column(desk, "throttles", 1)


def drag(desk, slider, share):
    """Drags a slider's thumb to a share of its length."""
    box = desk.see(slider).bounding_box()
    at = float(desk.see(slider).evaluate("(slider) => (slider.value - slider.min) / (slider.max - slider.min)"))
    mouse, y = desk.page.mouse, box["y"] + box["height"] / 2
    x = lambda share: box["x"] + 8 + share * (box["width"] - 16)
    desk.see(slider).scroll_into_view_if_needed()
    box = desk.see(slider).bounding_box()
    y = box["y"] + box["height"] / 2
    mouse.move(x(at), y)
    mouse.down()
    mouse.move(x(share), y, steps=5)
    mouse.up()


@pytest.mark.parametrize("name", ["isae-x8", "px4-x12", "px4-y6", "x8-11in-least-power", "x8-22-16in", "y4", "coaxial-bicopter", "single-pair"])
def test_throttles_are_those_of_mix(hand, name):
    desk = hand(name)
    row, before = same_as_mix(desk, f"{name}.toml")
    for slider in desk.see("#sliders input[type=range]").all():
        slider.focus()
        desk.page.keyboard.press("PageUp")
        desk.page.keyboard.press("ArrowLeft")
    after_keys, throttles = same_as_mix(desk, f"{name}.toml")
    assert after_keys != row and throttles != before
    for k, slider in enumerate(desk.see("#sliders input[type=range]").all()):
        drag(desk, f"#{slider.get_attribute('id')}", 0.3 + 0.07 * k)
    after_pointer, _ = same_as_mix(desk, f"{name}.toml")
    assert all(after_pointer[key] != after_keys[key] for key in row if float(after_keys[key]) != 0)


def test_ends_of_the_sliders_saturate(hand):
    desk = hand("isae-x8")
    for slider, key in [("#thrust", "End"), ("#roll", "End"), ("#yaw", "Home"), ("#volts", "Home")]:
        desk.see(slider).focus()
        desk.page.keyboard.press(key)
    same_as_mix(desk, "isae-x8.toml")
    desk.shows("#flags", "than asked")
    assert desk.see("#flags").get_attribute("data-bits") != "0"


def test_numbers_are_typed(hand):
    desk = hand("isae-x8")
    for id, value in [("roll", "-0.25"), ("thrust", "55.5"), ("volts", "13.3")]:
        desk.page.fill(f"#{id}-number", value)
        desk.page.keyboard.press("Enter")
    row, _ = same_as_mix(desk, "isae-x8.toml")
    assert [row["roll_nm"], row["thrust_n"], row["voltage_v"]] == ["-0.25", "55.5", "13.3"]
    desk.click("#hover")
    row, _ = same_as_mix(desk, "isae-x8.toml")
    assert row["roll_nm"] == "0"


def test_rotors_are_taken_out(hand):
    desk = hand("isae-x8")
    desk.page.fill("#thrust-number", "40")
    desk.page.keyboard.press("Enter")
    buttons = desk.see("#rotors button")
    buttons.nth(4).click()
    _, throttles = same_as_mix(desk, "isae-x8.toml", [4])
    assert float(throttles[4]) == 0
    expect(buttons.nth(4)).to_have_attribute("aria-pressed", "true")
    buttons.nth(1).focus()
    desk.page.keyboard.press("Space")
    same_as_mix(desk, "isae-x8.toml", [4, 1])
    buttons.nth(4).click()
    same_as_mix(desk, "isae-x8.toml", [1])


@pytest.mark.parametrize(
    "key, value, line, wrench",
    [
        ("airmode", "roll-pitch-yaw", 'airmode = "roll-pitch-yaw"', {"roll": 3, "yaw": 0.5, "thrust": 6}),
        ("airmode", "roll-pitch", 'airmode = "roll-pitch"', {"roll": 3, "yaw": 0.5, "thrust": 6}),
        ("yaw_reserve_nm", "0.2", "yaw_reserve_nm = 0.2", {"yaw": 0.4, "thrust": 95}),
        ("power_bias_nm_per_n", "0.002", "power_bias_nm_per_n = 0.002", {"thrust": 40}),
    ],
)
def test_allocation_is_edited_in_the_file(hand, key, value, line, wrench):
    """What is set beside the sliders stands in the file, changes the answer, and the command line answers alike."""
    desk = hand("isae-x8")
    for axis, x in wrench.items():
        desk.page.fill(f"#{axis}-number", str(x))
        desk.page.keyboard.press("Enter")
    _, before = same_as_mix(desk, saved(desk))
    field = desk.opened(f"#{key}")
    field.select_option(value) if key == "airmode" else (field.fill(value), field.press("Enter"))
    desk.until(lambda: line in desk.text())
    desk.compiles()
    _, after = same_as_mix(desk, saved(desk))
    assert after != before and line in desk.file("edited.toml").decode()


def saved(desk):
    (desk.shell.folder / "edited.toml").write_bytes(desk.save("airframe")[1])
    return "edited.toml"


def test_a_value_that_is_none_is_said(hand):
    desk = hand("isae-x8")
    desk.opened("#yaw_reserve_nm").fill("much")
    desk.shows("#status.error", "Yaw reserve is refused").shows("#yaw_reserve_nm-refused", "much is no number")
    desk.page.fill("#roll-number", "little")
    desk.page.keyboard.press("Enter")
    desk.shows("#flags.error", "little is no number")


@pytest.mark.parametrize("name", ["x8-16in-biquadratic", "px4-x12"])
def test_drawings_follow_a_moving_slider(hand, name, capsys):
    """What is drawn goes on while the slider moves, and what stands at the end is its last value, at any speed of the machine."""
    desk = hand(name)
    moved = """async (drawings) => {
        const slider = document.getElementById("roll"), began = performance.now(), before = hand.frames;
        for (let ticks = 0; hand.frames < before + drawings; ticks += 1) {
            await new Promise(requestAnimationFrame);
            slider.value = Math.sin(ticks / 20) * slider.max;
            slider.dispatchEvent(new Event("input"));
        }
        return (1000 * drawings) / (performance.now() - began);
    }"""
    rate = desk.page.evaluate(moved, 20)
    with capsys.disabled():
        print(f"\n{name}: {rate:.0f} drawings a second while a slider moves")
    row, _ = same_as_mix(desk, f"{name}.toml")
    assert float(row["roll_nm"]) == pytest.approx(float(desk.see("#roll").input_value()), rel=1e-6)
