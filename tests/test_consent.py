"""Consent to run a user's code: given by one value of the environment variable only, and for as long as it was given."""

import subprocess
import sys

import pytest

from comprope import consent


@pytest.mark.parametrize(
    ("value", "expected"),
    [("1", True), ("", False), ("0", False), ("no", False), ("true", False), ("yes", False), ("11", False), (" 1", False)],
)
def test_only_1_is_consent(monkeypatch: pytest.MonkeyPatch, value: str, expected: bool) -> None:
    monkeypatch.setenv(consent.VARIABLE, value)
    assert consent.given() is expected


def test_without_the_variable_there_is_no_consent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(consent.VARIABLE, raising=False)
    assert not consent.given()


def test_consent_ends_with_its_context_even_after_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(consent.VARIABLE, "")
    with pytest.raises(KeyError), consent.giving():
        assert consent.given()
        raise KeyError
    assert not consent.given()


@pytest.mark.parametrize("before", ["1", "0"])
def test_a_context_that_does_not_allow_changes_nothing(monkeypatch: pytest.MonkeyPatch, before: str) -> None:
    monkeypatch.setenv(consent.VARIABLE, before)
    with consent.giving(False):
        assert consent.given() is (before == "1")
    with consent.giving(True):
        assert consent.given()
    assert consent.given() is (before == "1")


def test_a_process_started_meanwhile_has_the_consent_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(consent.VARIABLE, "")
    ask = [sys.executable, "-c", f"import os; print(os.environ.get({consent.VARIABLE!r}))"]
    with consent.giving():
        assert subprocess.run(ask, capture_output=True, text=True, check=True).stdout.strip() == "1"
