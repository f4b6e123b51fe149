"""The app in a real browser, served by the command: from dropped files to a downloaded FMU, and what happens on the way."""

import re
import shutil
import signal
import subprocess
import sys
from contextlib import contextmanager

import numpy as np
import pytest
from fmpy import read_model_description
from playwright.sync_api import expect

from comprope.rope.model_file import load
from comprope_system.app.workspace import Workspace
from comprope_system.measurements.campaign_file import read_campaign_file

from . import virtual_elevator
from .browser_pages import needs_chromium, opened

pytestmark = needs_chromium
HIDDEN = {"effects.sheave_eccentricity.eccentricity": 2e-3, "effects.sheave_eccentricity.phase": 0.7}
PATIENCE, LONG = 60_000, 400_000  # ms for a short and a long computation on a busy machine
DROP = """async ([area, files]) => {
  const carried = new DataTransfer();
  for (const [name, text] of files) carried.items.add(new File([text], name));
  for (const kind of ["dragenter", "dragover", "drop"]) {
    document.querySelector(area).dispatchEvent(new DragEvent(kind, { dataTransfer: carried, bubbles: true, cancelable: true }));
  }
}"""


@pytest.fixture(scope="module")
def raw(tmp_path_factory):
    folder = virtual_elevator.campaign(tmp_path_factory.mktemp("raw"), HIDDEN)
    (folder / "campaign.toml").unlink()
    return folder


@contextmanager
def served(campaign):
    """The address that the command prints, which is all that it prints; the command ends with Ctrl-C."""
    words = [sys.executable, "-m", "comprope_system.cli", "app", str(campaign), "--no-browser"]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        yield process.stdout.readline().strip()
    finally:
        process.send_signal(signal.SIGINT)
        rest, told = process.communicate(timeout=60)
    assert (rest, told, process.returncode) == ("", "", 0)
    listed = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    assert str(campaign) not in listed  # no process outlives the command


@pytest.fixture
def campaign(tmp_path):
    folder = tmp_path / "campaign"
    yield folder
    shutil.rmtree(Workspace(folder).root)


def step(page, name):
    page.get_by_role("tab", name=name).click()


def dropped(page, raw):
    """Drop the raw files and wait until they are described."""
    files = [[path.name, path.read_text()] for path in sorted(raw.iterdir())]
    page.evaluate(DROP, ["#drop", files])
    expect(page.locator("#preview")).to_be_visible(timeout=PATIENCE)


def test_from_dropped_files_to_a_comparison_and_a_diagnosis_that_outlives_a_reload(campaign, raw):
    with served(campaign) as address, opened(address, refusals=1) as page:
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/\?token=[\w-]{32}", address)
        assert "token" not in page.url
        steps_obey_the_keyboard_and_fit_a_narrow_window(page)
        a_file_that_is_no_run_is_a_sentence(page)
        dropped(page, raw)
        rows = {row.locator("td").first.text_content(): row for row in page.locator("#columns tbody tr").all()}
        assert set(rows) == {"cw_low", "car_low", "axle", "turning"}
        page.get_by_label("mass of the sheave in down_light.csv").fill("70")
        page.get_by_label("mass of the sheave in down_light.csv").press("Tab")
        expect(page.get_by_label("inertia of the sheave in down_light.csv")).to_have_value("5.6", timeout=PATIENCE)
        the_last_correction_is_undone(page)
        expect(page.locator("#save")).to_be_enabled(timeout=PATIENCE)
        page.wait_for_timeout(400)  # a correction is sent a moment after it is made
        expect(page.locator("#save")).to_be_enabled(timeout=PATIENCE)
        page.locator("#save").click()
        expect(page.locator("#step-check")).to_be_visible()
        described = read_campaign_file(campaign / "campaign.toml")
        assert {run.file: run.set for run in described.runs}["down_light.csv"] == {"sheave.mass": 70.0, "sheave.inertia": 5.6}
        assert all(one.sign == 1 for one in described.channels)

        expect(page.locator("[data-run=check]")).to_be_enabled()
        page.locator("[data-run=check]").press("Enter")
        expect(page.frame_locator("[data-report=check]").locator("h1")).to_contain_text("campaign", timeout=PATIENCE)
        step(page, "Compare")
        page.locator("[data-run=compare]").click()
        report = page.frame_locator("[data-report=compare]")
        expect(report.locator("header p")).to_contain_text("It fails most at", timeout=PATIENCE)
        report.locator(".heat a").first.click()
        expect(report.locator(".group").first).to_have_attribute("data-from", re.compile(r"\d"))
        assert page.locator("[data-report=compare]").bounding_box()["height"] > 1000  # as high as what it holds

        step(page, "Diagnose")
        page.locator("[data-job=diagnose]").click()
        expect(page.locator("#job progress")).to_be_visible(timeout=PATIENCE)
        page.reload()
        expect(page.locator("#job")).to_contain_text("The diagnosis", timeout=PATIENCE)
        page.get_by_role("button", name="Cancel").click()
        expect(page.locator("#job")).to_contain_text("cancelled")


def the_last_correction_is_undone(page):
    undo = page.get_by_role("button", name="Undo")
    expect(page.locator("#zero-0")).to_have_value("rest")
    page.locator("#sign-0").select_option("-1")
    page.get_by_label("mass of the sheave in down_light.csv").fill("60")
    page.get_by_label("mass of the sheave in down_light.csv").press("Tab")
    expect(page.get_by_label("inertia of the sheave in down_light.csv")).to_have_value("4.8", timeout=PATIENCE)
    undo.click()
    expect(page.get_by_label("inertia of the sheave in down_light.csv")).to_have_value("5.6", timeout=PATIENCE)
    expect(page.locator("#sign-0")).to_have_value("-1")
    undo.click()
    expect(page.locator("#sign-0")).to_have_value("1", timeout=PATIENCE)
    expect(page.get_by_label("mass of the sheave in down_light.csv")).to_have_value("70")
    expect(undo).to_be_enabled()  # the first correction, of the mass, can be undone as well


def steps_obey_the_keyboard_and_fit_a_narrow_window(page):
    page.set_viewport_size({"width": 700, "height": 1000})
    page.get_by_role("tab", name="Data").focus()
    for name in ("Check", "Compare", "Diagnose", "Add", "Take", "Data"):
        page.keyboard.press("ArrowRight")
        expect(page.get_by_role("tab", name=name)).to_have_attribute("aria-selected", "true")
        assert page.evaluate("document.documentElement.scrollWidth") <= 700
    page.set_viewport_size({"width": 1400, "height": 1000})


def a_file_that_is_no_run_is_a_sentence(page):
    page.locator("#files").set_input_files([{"name": "odd.csv", "mimeType": "text/csv", "buffer": b"a,b\n1,2\n"}])
    expect(page.locator("#error")).to_contain_text("odd.csv", timeout=PATIENCE)
    page.get_by_role("button", name="remove odd.csv").click()
    expect(page.locator("#uploads li")).to_have_count(0)


@pytest.mark.slow
def test_a_diagnosis_is_resumed_by_a_later_server_and_shown_in_every_tab(campaign, raw):
    shutil.copytree(raw, campaign)
    (campaign / "campaign.toml").write_text(virtual_elevator.description())
    with served(campaign) as address, opened(f"{address}#diagnose") as page:
        page.locator("[data-job=diagnose]").click()
        with page.context.expect_page() as second:
            page.evaluate("window.open('/#diagnose')")
        expect(second.value.locator("#job")).to_contain_text("The diagnosis", timeout=PATIENCE)
        expect(second.value.locator("[data-job=diagnose]")).to_be_disabled()
        second.value.close()
        expect(page.locator("#job")).to_contain_text(re.compile(r"\d\d+ of about"), timeout=PATIENCE)
    with served(campaign) as address, opened(address) as page:
        expect(page.locator("#job")).to_contain_text("was interrupted", timeout=PATIENCE)
        page.get_by_role("button", name="Resume").click()
        # What the first server replayed is there at once: the count begins where it ended.
        expect(page.locator("#job")).to_contain_text(re.compile(r"\d\d+ of about"), timeout=PATIENCE)
        page.get_by_role("button", name="Cancel").click()
        page.get_by_role("button", name="Dismiss").click()
        expect(page.locator("#job")).to_be_hidden()


@pytest.mark.slow
def test_the_whole_way_from_dropped_files_to_a_downloaded_fmu(campaign, raw, tmp_path):
    with served(campaign) as address, opened(address) as page:
        dropped(page, raw)
        page.get_by_label("mass of the sheave in down_light.csv").fill("70")
        page.get_by_label("mass of the sheave in up_short.csv").fill("95")
        page.locator("#role-0").focus()
        page.wait_for_timeout(400)
        expect(page.locator("#save")).to_be_enabled(timeout=PATIENCE)
        page.locator("#save").click()
        step(page, "Diagnose")
        page.locator("[data-job=diagnose]").click()
        expect(page.locator("#job")).to_contain_text(re.compile(r"\d\d+ of about"), timeout=PATIENCE)
        page.get_by_role("button", name="Cancel").click()
        expect(page.locator("#job")).to_contain_text("cancelled")
        page.get_by_role("button", name="Try again").click()
        report = page.frame_locator("[data-report=diagnose]")
        expect(report.locator(".card .title")).to_have_text("Sheave eccentricity", timeout=LONG)

        slider = report.get_by_label("eccentricity [mm]")
        for _ in range(20):
            slider.press("ArrowLeft")
        expect(report.locator(".badge")).to_have_text("preview")
        page.wait_for_timeout(100)
        shown = float(report.locator("output[data-role=fit]").text_content().removesuffix(" %"))
        expect(page.locator("#replayed")).to_contain_text("are simulated with", timeout=PATIENCE)
        expect(report.locator(".badge")).to_have_text("replayed")
        simulated = float(report.locator("output[data-role=fit]").text_content().removesuffix(" %"))
        assert shown == pytest.approx(simulated, abs=0.5)  # points of NRMSE

        report.get_by_role("button", name="Pin").click()
        expect(report.locator(".pins tbody tr")).to_contain_text("replayed")
        report.get_by_role("button", name="Fit from here").click()
        expect(page.locator("#step-add")).to_be_visible()
        expect(page.locator("#variants")).to_contain_text("sheave eccentricity from eccentricity", timeout=LONG)
        expect(page.locator("#effect")).to_have_value("sheave_eccentricity")
        page.locator("[data-job=add]").click()
        expect(page.locator("#variants input[type=checkbox]")).to_have_count(2, timeout=LONG)
        for tick in page.locator("#variants input").all():
            tick.check()
        page.get_by_role("button", name="Draw the ticked models together").click()
        together = page.frame_locator("#variant").locator("#models")
        expect(together).to_contain_text("sheave_eccentricity from eccentricity", timeout=PATIENCE)
        step(page, "Take")
        expect(page.locator("#commands")).to_contain_text(f"comprope add {campaign} sheave_eccentricity --out model2.toml")
        page.get_by_role("button", name="Build the FMUs").first.click()
        expect(page.get_by_role("link", name="CompensationRope.fmu")).to_be_visible(timeout=PATIENCE)
        for name in ("CompensationRope.fmu", "model.toml"):
            with page.expect_download() as download:
                page.get_by_role("link", name=name).first.click()
            download.value.save_as(tmp_path / name)
    fitted = load(tmp_path / "model.toml").effects.sheave_eccentricity.eccentricity
    assert fitted == pytest.approx(HIDDEN["effects.sheave_eccentricity.eccentricity"], rel=0.1)
    variables = {one.name: one.start for one in read_model_description(str(tmp_path / "CompensationRope.fmu")).modelVariables}
    assert np.isclose(float(variables["effects.sheave_eccentricity.eccentricity"]), fitted)
