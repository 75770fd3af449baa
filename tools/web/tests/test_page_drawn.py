"""Drawn sequences of what a user does, refusals among them: after each action form, text, verdict, saved files, command line
and fields are of one airframe, or the page says that they are not.

MIXER_PAGE_ACTIONS=100 MIXER_PAGE_SEEDS=7,8,9 draws longer ones.
"""

import json
import os
import random
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
ACTIONS = int(os.environ.get("MIXER_PAGE_ACTIONS", "12"))
SEEDS = [int(seed) for seed in os.environ.get("MIXER_PAGE_SEEDS", "1,2,3").split(",")]

BENCH = ROOT / "examples/bench/sweep.csv"
FILES = [
    BENCH,
    ROOT / "examples/no-bench/rotor.csv",
    ROOT / "airframes/isae-x8.toml",
    ROOT / "airframes/px4-y6.toml",
    ROOT / "mixer-compiler/tests/diagnostics/fold.toml",
    ("empty.csv", b""),
    ("picture.png", b"\x89PNG\r\n\x1a\n\x00\x00"),
    ("odd.csv", b"a,b\n1,2\n"),
]
# What is typed or chosen, what is refused included; in the file the value has this key.
FIELDS = {
    "arm": ["0.45", "0.3", "300 mm", "0", "-1", "long", ""],
    "mass_kg": ["4.5", "3 kg", "0", "-1", "99999", "heavy", ""],
    "yaw_reserve_nm": ["0.1", "-1", "0", ""],
    "power_bias_nm_per_n": ["0.001", "5", ""],
    "airmode": ["disabled", "roll-pitch"],
    "frame": ["x8", "y6", "x12", "bicopter"],
    "stack": ["px4", "ardupilot", "betaflight", "own"],
    "name": ["mine", "Not A Name", ""],
    "cells": ["6", "0", "six", ""],
    "options": ["--basis cubic", "--bassis cubic", "--voltage-exponent 9", "'open", ""],
    "pulses": ["1000,2000", "7", ""],
    "thrust-100": ["2300", "much", ""],
}
KEYS = {
    "arm": ("layout", "arm_m"),
    "mass_kg": ("vehicle", "mass_kg"),
    "yaw_reserve_nm": ("allocation", "yaw_reserve_nm"),
    "power_bias_nm_per_n": ("allocation", "power_bias_nm_per_n"),
    "airmode": ("allocation", "airmode"),
}
SELECTS = ["airmode", "frame", "stack"]


def draw(desk, dice):
    """One action and its name."""
    buttons = {name: desk.see(part) for name, part in {
        "replace": "#replace", "back": "#aside .back", "throw away": "#aside button:not(.back)", "remove": "#dropped button", "mend": "#faults .mend",
    }.items()}
    there = [name for name, button in buttons.items() if button.count() and button.first.is_visible()]
    kind = dice.choices(["type", "drop", "edit", "press", "reload", "forget"], [12, 4, 2, 4 if there else 0, 1, 0.5])[0]
    if kind == "type":
        field = dice.choice(list(FIELDS))
        value = dice.choice(FIELDS[field])
        seen = desk.opened(f"#{field}")
        seen.select_option(value) if field in SELECTS else seen.fill(value)
        if field not in SELECTS:
            desk.settled()
            assert seen.input_value() == value, f"{field} = {value} became {seen.input_value()}"
        return f"{field} = {value!r}"
    if kind == "drop":
        file = dice.choice(FILES)
        desk.drop(file)
        return f"drop {file[0] if isinstance(file, tuple) else file.name}"
    if kind == "edit":
        if desk.see("#tabs button").count():
            desk.see("#tabs button").last.click()
        text = desk.text()
        found = [word for word in ["0.1", "cw", "[pair]", "="] if word in text]
        if found:
            old = dice.choice(found)
            desk.replace(old, {"0.1": "0.2", "cw": "cv"}.get(old, ""))
        return f"edit {found}"
    if kind == "press":
        name = dice.choice(there)
        button = buttons[name].first
        told = button.text_content()
        if told != "Choose a bench file":
            button.click()
        return f"press {told}"
    if kind == "reload":
        desk.page.reload()
    else:
        desk.click("#forget")
    return kind


def cargo(desk, *words):
    return subprocess.run(["cargo-mixer", "mixer", *words], env=desk.shell.environment, cwd=desk.shell.folder, capture_output=True, text=True)


def agree(desk, folder):
    """Everything that is seen, and everything that is saved, is of one airframe."""
    desk.settled()
    for part in ["#arm", "#mass_kg", "#frame", "#cells", "#forget", "#choose"]:
        assert desk.see(part).is_visible(), f"{part} is gone"
    status, error = desk.see("#status").text_content(), "error" in (desk.see("#status").get_attribute("class") or "")
    refused = {item.get_attribute("id").removesuffix("-refused"): item.text_content() for item in desk.see("small.refused:not(:empty)").all()}
    for field in refused:
        assert desk.see(f"#{field}").get_attribute("aria-invalid") == "true" and error, f"{field} is refused, and the status is {status}"
    if desk.see("#faults .error").count():
        assert error, f"there are errors, and the status is {status}"
    differs = desk.see("#differs")
    told = differs.text_content() if differs.is_visible() else ""
    is_apart, is_example = "not the one of files and form" in told or "do not change it" in told, "an example" in told
    shown = "" if desk.see("#made-by").get_attribute("hidden") is not None else desk.see("#command").text_content()
    if not desk.see("[data-output=airframe]").count():
        assert "compiles" not in status and not desk.see("#hand").is_visible()
        return
    desk.see("#tabs button").last.click()
    text = desk.text()
    name, content = desk.save("airframe")
    assert content.decode() == text, "the saved airframe is not the text"
    assert ("the airframe is not the one of files and form" in status) == is_apart, (status, told)
    assert bool(shown) != is_apart, f"a command line beside {told!r}: {shown}"

    path = folder / name
    path.write_bytes(content)
    checked = cargo(desk, "check", path)
    verdict = desk.see("#verdict").evaluate("(table) => [...table.querySelectorAll('th, td')].map((cell) => cell.textContent).join(' ')")
    assert ("compiles" in status) == (checked.returncode == 0) == bool(verdict), f"{status}\n{checked.stderr}"
    if checked.returncode == 0:
        assert "".join(verdict.split()) == "".join(checked.stdout.split("\nnext ")[0].split())
        pulses = desk.see("#pulses").input_value()
        expected = cargo(desk, "params", path, "--stack", "px4", *(["--pwm-range", pulses] if pulses else []))
        if expected.returncode == 0:
            file, content = desk.save("px4")
            assert content.decode() == expected.stdout and file.startswith(tomllib.loads(text)["name"])
        else:
            assert desk.link("px4").get_attribute("href") is None
    else:
        assert desk.see("a.save[href]").all_text_contents() in ([["Airframe file"], ["Airframe file", "Pair's tables"], ["Airframe file", "Data sheet", "Pair's tables"], ["Airframe file", "Data sheet"]]), "a file of what does not compile"
        return

    parsed = tomllib.loads(text)
    if shown:
        if desk.see("[data-output=sheet]").count():
            file, content = desk.save("sheet")
            (desk.shell.folder / file).write_bytes(content)
        line, _, keys = shown.partition("  # then ")
        done = subprocess.run(["sh", "-ec", line.replace(" -o ", " --force -o ")], cwd=desk.shell.folder, capture_output=True, text=True, env=desk.shell.environment)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
        by_line = desk.file(name).decode()
        for key, value, table in re.findall(r"(\w+) = (\S+?) in \[(\w+)\]", keys):
            by_line_parsed = tomllib.loads(by_line) if isinstance(by_line, str) else by_line
            by_line_parsed.setdefault(table, {})[key] = tomllib.loads(f"x = {value}")["x"] if value[0] in '"-0123456789' else value
            by_line = by_line_parsed
        assert (by_line == text) if isinstance(by_line, str) else (by_line == parsed), f"{shown} gives another airframe"
        if not is_example:
            for field, (table, key) in KEYS.items():
                typed = desk.see(f"#{field}").input_value()
                value = parsed.get(table, {}).get(key)
                number = float(typed.split()[0]) / (1000 if typed.endswith("mm") else 1) if typed and field != "airmode" else typed
                if value is not None or field in ("arm", "mass_kg") and table in parsed and field != "arm":
                    assert value == number, f"{field} is {typed!r}, the file has {value}"


@pytest.mark.parametrize("seed", SEEDS)
def test_whatever_is_done_nothing_parts(desk, seed, capsys):
    dice, done = random.Random(seed), []
    folder = desk.shell.folder / "saved"
    folder.mkdir()
    agree(desk, folder)
    for _ in range(ACTIONS):
        done.append(draw(desk, dice))
        try:
            agree(desk, folder)
        except AssertionError as error:
            raise AssertionError(f"after {json.dumps(done, indent=1)}\n{error}") from error
    refusals = sum(any(word in action for word in ["'0'", "'-1'", "long", "99999", "heavy", "'5'", "Not A", "six", "bassis", "exponent 9", "open", "'7'", "much", "fold", "empty", "picture", "odd"]) for action in done)
    with capsys.disabled():
        print(f"\nseed {seed}: {len(done)} actions, {refusals} of what is refused, 0 disagreements")
