"""What the tests share: the project's folder and its command line, which is the judge."""

import os
import pathlib
import subprocess

import coaxial_mixer
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
AIRFRAMES = sorted(ROOT.glob("airframes/*.toml")) + sorted(ROOT.glob("examples/simulator/*.toml"))


@pytest.fixture(autouse=True)
def in_the_project(monkeypatch):
    """Every test runs in the project's folder."""
    monkeypatch.chdir(ROOT)


@pytest.fixture(scope="session")
def command():
    """Runs ``cargo mixer``: what it prints, says on stderr, and its status."""
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    program = os.environ.get("MIXER_COMMAND", target / "debug" / "cargo-mixer")

    def run(*words, stdin=""):
        done = subprocess.run([program, *map(str, words)], input=stdin, capture_output=True, text=True)
        return done.stdout, done.stderr, done.returncode

    return run


@pytest.fixture
def printed(command):
    """What a command prints that succeeds."""

    def run(*words, stdin=""):
        out, said, status = command(*words, stdin=stdin)
        assert status == 0, said
        return out

    return run


@pytest.fixture(scope="session", params=AIRFRAMES, ids=lambda path: path.stem)
def airframe(request):
    """Every airframe that is shipped."""
    return request.param


@pytest.fixture(scope="session")
def mixer(airframe):
    """Its mixer."""
    return coaxial_mixer.compile(airframe)
