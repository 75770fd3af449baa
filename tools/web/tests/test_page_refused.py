"""What is refused locks nobody out: it stays where it was typed, with the sentence beside it, and what was good before stays."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import expect

ROOT = Path(__file__).parents[3]
BENCH = ROOT / "examples/bench/sweep.csv"
X8 = ROOT / "airframes/isae-x8.toml"
PARTS = ["#choose", "#frame", "#arm", "#mass_kg", "#stack", "#forget"]


def my_x8(desk):
    desk.drop(BENCH)
    desk.page.fill("#arm", "0.45")
    desk.page.fill("#mass_kg", "3")
    desk.compiles("my-x8")
    return desk.text()


@pytest.mark.parametrize("field, value", [("mass_kg", "0"), ("mass_kg", "-1"), ("mass_kg", "99999"), ("yaw_reserve_nm", "-1"), ("power_bias_nm_per_n", "5"), ("arm", "0"), ("arm", "-1")])
def test_a_refused_value_stays_in_its_field(desk, field, value):
    before = my_x8(desk)
    desk.opened(f"#{field}").fill(value)
    for _ in range(2):
        desk.settled().shows("#status.error", "is refused").says("the airframe is not the one of files and form")
        desk.opened(f"#{field}")
        assert desk.see(f"#{field}").input_value() == value
        expect(desk.see(f"#{field}-refused")).to_contain_text("not")
        for part in PARTS:
            expect(desk.see(part)).to_be_visible()
        desk.see("#tabs button").last.click()
        assert desk.text() == before and desk.see("#made-by").get_attribute("hidden") is not None
        desk.page.reload()
    desk.opened(f"#{field}").fill({"mass_kg": "3", "arm": "0.45"}.get(field, ""))
    desk.compiles("my-x8")
    assert desk.text() == before and desk.see("#differs").is_hidden()


def test_a_refused_value_of_a_dropped_airframe_does_not_touch_it(desk):
    desk.drop(X8).compiles("isae-x8")
    desk.page.fill("#mass_kg", "0")
    desk.settled().shows("#mass_kg-refused", "0 is not above 0").says("isae-x8 compiles")
    assert desk.save("airframe")[1] == X8.read_bytes()
    desk.page.fill("#mass_kg", "3")
    desk.compiles("isae-x8")
    assert "mass_kg = 3" in desk.text()


def test_form_and_text_do_not_part_where_options_are_refused(desk):
    before = my_x8(desk)
    desk.opened("#options").fill("--basis octic")
    desk.settled()
    desk.page.fill("#arm", "0.3")
    desk.settled().says("the airframe is not the one of files and form")
    expect(desk.see("#differs")).to_contain_text("refused")
    assert desk.text() == before and desk.see("#made-by").get_attribute("hidden") is not None
    desk.see("#options").fill("")
    desk.compiles("my-x8")
    assert "arm_m = 0.3" in desk.text()


def test_edited_work_is_kept_until_it_is_thrown_away(desk):
    desk.drop(X8).compiles("isae-x8").replace("isae-x8", "edited")
    edited = desk.compiles("edited").text()
    desk.drop(("a.toml", X8.read_bytes())).compiles("isae-x8")
    desk.drop(ROOT / "airframes/px4-y6.toml").compiles("px4-y6")
    desk.page.reload()
    desk.compiles("px4-y6")
    desk.page.get_by_role("button", name="Work on isae-x8.toml").click()
    desk.compiles("edited")
    assert desk.text() == edited
    for _ in range(2):
        desk.see("#aside button:not(.back)").first.click()
        desk.settled()
    expect(desk.see("#aside li")).to_have_count(0)


def test_an_edited_bench_file_is_kept_beside_a_newer_one(desk):
    desk.page.fill("#arm", "0.45")
    desk.drop(BENCH).compiles("my-x8").see("#tabs button").first.click()
    desk.replace("0.1", "0.2").settled()
    edited = desk.text()
    desk.drop(BENCH).compiles("my-x8")
    desk.click("#aside .back")
    desk.settled().see("#tabs button").first.click()
    assert desk.text() == edited


def test_two_airframes_at_once_are_asked_about(desk):
    desk.drop(X8, ROOT / "airframes/px4-y6.toml").settled().says("choose one")
    assert desk.see("#aside li").count() == 2 and "example-x8" in desk.see("#status").text_content()
    desk.page.get_by_role("button", name="Work on px4-y6.toml").click()
    desk.compiles("px4-y6")


def test_the_pair_that_stands_in_is_told_everywhere(desk):
    desk.page.fill("#arm", "0.45")
    desk.page.fill("#mass_kg", "3")
    desk.compiles("my-x8").tells("MIX309").says("1 warning")
    desk.shows("#verdict", "not yours")
    for output in desk.opened("#more").locator("xpath=..").locator("a.save").all():
        what = output.get_attribute("data-output")
        if not what.endswith(".csv"):  # bits alone
            text = re.sub(r"\s*\n#\s*", " ", desk.save(what)[1].decode())
            assert "Chebbi" in text and ("not of this vehicle" in text or "borrowed_from" in text), what


def test_parameters_alone_ask_for_the_pair(desk):
    desk.shell(f"cargo mixer params {X8} --stack px4 --own -o x8.params")
    desk.drop(("x8.params", desk.file("x8.params"))).settled()
    desk.tells("MIX003").shows("#faults .error", "drop the bench file or the data sheet of the pair")
    desk.drop(BENCH).compiles("imported-x8")


def test_a_refused_picture_is_no_error_of_what_comes_next(desk):
    desk.drop(("picture.png", b"\x89PNG\r\n\x1a\n\x00")).shows("#dropped .error", "picture.png").settled().shows("#status.error", "picture.png")
    desk.page.fill("#arm", "0.45")
    desk.compiles("my-x8")
    expect(desk.see("#dropped .error")).to_have_count(0)
    assert desk.see("#status.error").count() == 0


def test_a_warning_has_a_button_that_applies_its_mend(desk):
    desk.drop(BENCH)
    desk.page.fill("#arm", "45")
    desk.settled().tells("MIX310")
    desk.page.get_by_role("button", name="Set Arm to 0.45").click()
    desk.compiles("my-x8")
    assert desk.see("#arm").input_value() == "0.45" and "arm_m = 0.45" in desk.text()
    desk.drop(ROOT / "mixer-compiler/tests/diagnostics/fold.toml").settled().tells("MIX201")
    desk.page.get_by_role("button", name="Write min = 0.08875").click()
    desk.compiles("isae-x8")


def test_a_browser_that_keeps_nothing_says_so_beside_forget(visit):
    deny = "Object.defineProperty(globalThis, 'localStorage', { get() { throw new DOMException('denied', 'SecurityError'); } });"
    desk = visit(init=deny).ready()
    desk.drop(X8).compiles("isae-x8").shows("#kept", "keep nothing")
    desk.page.fill("#mass_kg", "3")
    desk.compiles("isae-x8")


@pytest.mark.parametrize("gone", ["Worker", "DecompressionStream", "WebAssembly"])
def test_what_a_browser_lacks_is_said_in_the_status(browser, server, gone):
    page = browser.new_page()
    page.add_init_script(f"delete globalThis.{gone};")
    if gone != "Worker":  # the worker has its own globals
        page.add_init_script(f"const Of = Worker; globalThis.Worker = class extends Of {{ constructor(url) {{ super(URL.createObjectURL(new Blob(['delete globalThis.{gone};'].concat([document.getElementById('worker').textContent]), {{ type: 'text/javascript' }}))); }} }};")
    page.goto(server.address)
    expect(page.locator("#status.error")).to_contain_text("The page does not start here")
    expect(page.locator("#status")).to_contain_text("Chrome")
    page.close()
