"""By keyboard, touch and screen reader, at 390 px, in light and dark, on paper."""

from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import expect

ROOT = Path(__file__).parents[3]
BENCH = ROOT / "examples/bench/sweep.csv"

# What a finger or a pointer hits, with the label that passes the hit on. Links within a sentence are as high as
# its line (WCAG 2.5.8, exception "inline").
SMALL = """() => [...document.querySelectorAll("button, a, input, select, textarea, summary")]
    .filter((element) => element.checkVisibility() && !element.closest("p, td, li:not(nav li)") || element.matches("button, input"))
    .map((element) => [element, (element.closest("label") ?? element).getBoundingClientRect()])
    .filter(([, box]) => box.width > 0 && (box.width < 24 || box.height < 24))
    .map(([element, box]) => `${element.outerHTML.slice(0, 80)}: ${box.width.toFixed(0)} x ${box.height.toFixed(0)}`)"""


def full(desk):
    """The page with all that it can show: files, a warning, the mixer, the report."""
    desk.page.fill("#arm", "0.45")
    desk.drop(BENCH).compiles().shows("#report", "sweep.csv").still()
    desk.page.evaluate("() => document.querySelectorAll('.screen details').forEach((details) => { details.open = true; })")
    return desk.settled()


@pytest.mark.parametrize("width, scheme", [(390, "light"), (390, "dark"), (320, "light")])
def test_a_phone_scrolls_one_way_and_a_finger_hits(visit, width, scheme):
    phone = visit(viewport={"width": width, "height": 844}, has_touch=True, is_mobile=True, color_scheme=scheme).ready()
    wide = """() => [document.documentElement.scrollWidth, [...document.querySelectorAll("body *")]
        .filter((element) => element.getBoundingClientRect().right > innerWidth + 1 && !element.closest("pre, #editor, .scroll, svg, table"))
        .map((element) => element.outerHTML.slice(0, 80)).slice(0, 5)]"""
    assert phone.page.evaluate(wide)[0] <= width
    full(phone)
    wide_px, elements = phone.page.evaluate(wide)
    assert wide_px <= width, elements
    small = phone.page.evaluate(SMALL)
    assert not small, "\n".join(small)


@pytest.mark.parametrize("width, scheme", [(390, "dark"), (1400, "light")])
def test_axe_finds_nothing_serious(visit, width, scheme):
    desk = full(visit(viewport={"width": width, "height": 900}, color_scheme=scheme).ready())
    found = Axe().run(desk.page).response["violations"]
    serious = [(rule["id"], [node["target"] for node in rule["nodes"]][:5]) for rule in found if rule["impact"] in ("serious", "critical")]
    assert serious == []


def test_the_keyboard_reaches_everything_in_order(desk):
    full(desk)
    desk.page.focus("nav a")
    reached = []
    at = """() => { const { id, className, tagName, parentElement, dataset } = document.activeElement;
        return id || dataset.output || className || `${parentElement.id} ${tagName}`; }"""
    while ("TEXTAREA" not in reached[-1] if reached else True) and len(reached) < 160:
        desk.page.keyboard.press("Tab")
        reached.append(desk.page.evaluate(at))
    order = ["choose", "thrust-50", "diameter", "options", "frame", "arm", "mass_kg", "stack", "px4-own", "airframe", "pulses", "rs", "share", "forget", "roll",
             "thrust", "hover", "0", "tabs BUTTON", " TEXTAREA"]
    places = [next((k for k, name in enumerate(reached) if want == name), None) for want in order]
    assert None not in places and places == sorted(places), f"{list(zip(order, places))} of {reached}"


def test_a_way_by_keys_alone(desk):
    """From the frame's form to a throttle and a saved file without a pointer."""
    desk.page.focus("#arm")
    desk.page.keyboard.type("0.45")
    desk.compiles().still()
    before = desk.see("#throttles").text_content()
    desk.page.focus("#roll")
    desk.page.keyboard.press("ArrowRight")
    desk.still()
    assert desk.see("#throttles").text_content() != before
    desk.page.focus("[data-output='px4-own']")
    with desk.page.expect_download():
        desk.page.keyboard.press("Enter")


def test_paper_has_the_report_alone(desk):
    full(desk)
    desk.page.emulate_media(media="print")
    for part in desk.see(".screen").all():
        expect(part).to_be_hidden()
    expect(desk.see("#report h1")).to_be_visible()
    assert desk.page.pdf().startswith(b"%PDF")


@pytest.mark.parametrize("width", [390, 1280])
def test_a_walk_from_a_bench_file_to_parameters(visit, width, capsys):
    """A builder's own vehicle: nothing is folded out, no option is typed."""
    desk = visit(viewport={"width": width, "height": 844}).ready()
    walk = [
        lambda: desk.page.set_input_files("#choose", BENCH),
        lambda: desk.page.fill("#arm", "0.45"),
        lambda: desk.page.fill("#mass_kg", "4.2"),
        lambda: desk.page.fill("#cells", "4"),
        lambda: desk.page.select_option("#stack", "px4"),
    ]
    for act in walk:
        act()
    desk.compiles("my-x8")
    numbers = desk.see("#numbers b").all_text_contents()
    link = desk.see("#files [data-output='px4-own']")
    expect(link).to_be_visible()
    with desk.page.expect_download() as download:
        link.click()
    with capsys.disabled():
        print(f"\n{width} px: {len(walk) + 1} actions to {download.value.suggested_filename}; {'; '.join(numbers)}")
    (desk.shell.folder / "sweep.csv").write_bytes(BENCH.read_bytes())
    desk.run_shown()
    text = (desk.shell.folder / "my-x8.toml").read_text() + "\n[vehicle]\nmass_kg = 4.2\n"
    (desk.shell.folder / "my-x8.toml").write_text(text)
    expected = desk.shell("cargo mixer params my-x8.toml --stack px4 --own")
    assert Path(download.value.path()).read_text() == expected
    # Without the power of a pair the time in hover is not known.
    assert numbers[-1] == "not known" and all(number[0].isdigit() for number in numbers[:-1])
    # What is said of every number, and where every file goes, is in sight without a fold.
    for part in desk.see("#numbers small, #files li > span").all():
        expect(part).to_be_visible()
