"""Every file that the page saves is the command line's to the byte."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import expect

ROOT = Path(__file__).parents[3]
GOLDEN = ["rs", "vectors.csv", "rotors-out.csv", "report.txt"]
PARAMETERS = {
    "px4": "--stack px4",
    "ardupilot": "--stack ardupilot",
    "px4-own": "--stack px4 --own",
    "ardupilot-own": "--stack ardupilot --own",
    "betaflight": "--stack betaflight",
    "betaflight-own": "--stack betaflight --own",
}
AIRFRAMES = sorted((ROOT / "airframes").glob("*.toml")) + sorted((ROOT / "examples/simulator").glob("*.toml"))


@pytest.mark.parametrize("path", AIRFRAMES, ids=lambda path: path.stem)
def test_saved_files_are_those_of_the_command_line(desk, path):
    desk.drop(path).compiles()
    of_cargo = desk.shell(f"cargo mixer golden {path.name} -o golden; cargo mixer report {path.name} -o report.html; ls golden")
    name = of_cargo.split()[0].split(".")[0]
    for output in GOLDEN:
        assert desk.save(output) == (f"{name}.{output}", desk.file(f"golden/{name}.{output}"))
    assert desk.save("report") == (f"{name}.html", desk.file("report.html"))
    for output, options in PARAMETERS.items():
        same_parameters(desk, output, f"{path.name} {options}")


def same_parameters(desk, output, words):
    """The file and its notes, or the refusal."""
    line = f"cargo mixer params {words} 2>told || true"
    expected = desk.shell(line)
    told = [line.split(": ", 1) for line in desk.file("told").decode().splitlines()]
    if expected:
        name, content = desk.save(output)
        assert content == expected.encode()
        assert name.endswith({"px4": ".params", "ardupilot": ".parm", "betaflight": ".txt"}[output.removesuffix("-own")])
        notes = [message for _, message in told]
    else:
        expect(desk.link(output)).not_to_have_attribute("href", re.compile("."))
        notes = [message for _, message in told]
    # The page has its own words for options; what has none is told as it is.
    words = [re.split("`|--", note)[0] for note in notes]
    words = [note if note == begin else re.compile(f"^{re.escape(begin.strip())}") for note, begin in zip(notes, words)]
    expect(desk.see(f"li:has(> [data-output='{output}']) li")).to_have_text(words)


def test_bench_files_are_in_the_saved_report(desk):
    desk.page.fill("#arm", "0.45")
    desk.drop(ROOT / "examples/bench/sweep.csv").compiles("my-x8").shows("#report", "sweep.csv")
    desk.run_shown()
    desk.shell("cargo mixer report my-x8.toml --bench sweep.csv -o report.html")
    name, content = desk.save("report")
    assert content == desk.file("report.html")


def test_pulse_widths_reach_the_parameters(desk):
    desk.drop(ROOT / "airframes/isae-x8.toml").compiles()
    desk.opened("#pulses").fill("1050,1950")
    same_parameters(desk, "ardupilot", "isae-x8.toml --stack ardupilot --pwm-range 1050,1950")
    desk.page.fill("#pulses", "1950")
    desk.settled()
    expect(desk.see("#pulses-refused")).to_contain_text("1950")


def test_the_report_on_the_page_is_the_saved_one(visit, desk):
    desk.drop(ROOT / "airframes/isae-x8.toml").compiles().shows("#report", "isae")
    _, content = desk.save("report")
    (desk.shell.folder / "saved.html").write_bytes(content)
    saved = visit(f"file://{desk.shell.folder}/saved.html", desk.page.context)
    assert saved.see("main").inner_text() == desk.see("#report").inner_text()


def test_the_check_list_is_ticked_and_kept(desk):
    desk.drop(ROOT / "airframes/isae-x8.toml").compiles()
    box = desk.see("#report input[type=checkbox]").first
    box.check()
    desk.page.reload()
    desk.compiles()
    expect(box).to_be_checked(timeout=20000)
