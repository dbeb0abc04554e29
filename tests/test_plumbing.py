"""What surrounds the code: toolchain messages, one version, README code that runs, no registry hosts."""

import importlib.metadata
import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
SH = shutil.which("sh") or "/bin/sh"
RUST = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
PYTHON_NEEDED = PROJECT["requires-python"].removeprefix(">=")


def program(folder: Path, name: str, body: str) -> None:
    """Put a shell script that plays the program `name` into folder."""
    path = folder / name
    path.write_text(f"#!{SH}\n{body}\n")
    path.chmod(0o755)


def toolchain(folder: Path, *parts: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the toolchain check where nothing but the programs in folder can be found."""
    return subprocess.run(
        [SH, str(ROOT / "scripts/check_toolchain.sh"), *parts],
        env={"PATH": str(folder), "HOME": str(folder), **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def complaint(done: subprocess.CompletedProcess[str]) -> str:
    """The one sentence on stderr of a check that failed."""
    assert done.returncode != 0
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert done.stderr.rstrip().endswith(".")
    return done.stderr


@pytest.fixture
def tools(tmp_path: Path) -> Path:
    """A folder with just enough: the oldest Rust and the oldest Python that are allowed."""
    program(tmp_path, "cargo", "echo cargo")
    program(tmp_path, "rustc", f"echo 'rustc {RUST['rust-version']}.0 (0123456789 2026-01-01)'")
    program(tmp_path, "python3", f"echo {PYTHON_NEEDED}.0")
    return tmp_path


def test_toolchain_accepts_the_oldest_allowed_versions(tools: Path) -> None:
    done = toolchain(tools)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == f"{tools / 'python3'}\n"


@pytest.mark.parametrize("version", ["1.94.1", "1.9.0", "0.99.0", "unknown"])
def test_old_rust_is_named_with_what_is_needed(tools: Path, version: str) -> None:
    program(tools, "rustc", f"echo 'rustc {version} (0123456789 2025-01-01)'")
    sentence = complaint(toolchain(tools))
    assert f"rustc is version {version}" in sentence
    assert f"Rust {RUST['rust-version']} or newer" in sentence
    assert "rustup update" in sentence


def test_newer_rust_of_another_channel_is_accepted(tools: Path) -> None:
    program(tools, "rustc", "echo 'rustc 2.0.0-nightly (0123456789 2030-01-01)'")
    assert toolchain(tools, "rust").returncode == 0


def test_missing_cargo_is_named(tools: Path) -> None:
    (tools / "cargo").unlink()
    sentence = complaint(toolchain(tools))
    assert "cargo was not found" in sentence
    assert f"Rust {RUST['rust-version']}" in sentence


def test_cargo_that_is_only_missing_from_the_path_is_named(tools: Path) -> None:
    (tools / ".cargo/bin").mkdir(parents=True)
    (tools / "cargo").rename(tools / ".cargo/bin/cargo")
    assert "not on PATH" in complaint(toolchain(tools))


def test_rustc_that_does_not_run_is_named(tools: Path) -> None:
    program(tools, "rustc", "exit 1")
    assert "'rustc --version' fails" in complaint(toolchain(tools))


@pytest.mark.parametrize("version", ["3.10.14", "3.9.2", "2.7.18"])
def test_old_python_is_named_with_what_is_needed(tools: Path, version: str) -> None:
    program(tools, "python3", f"echo {version}")
    sentence = complaint(toolchain(tools))
    assert f"python3 is version {version}" in sentence
    assert f"Python {PYTHON_NEEDED} or newer" in sentence
    assert "make PYTHON=" in sentence


def test_newer_python_beside_an_old_python3_is_found(tools: Path) -> None:
    program(tools, "python3", "echo 3.9.2")
    program(tools, "python3.12", "echo 3.12.1")
    done = toolchain(tools)
    assert (done.returncode, done.stdout) == (0, f"{tools / 'python3.12'}\n")


def test_missing_python_is_named(tools: Path) -> None:
    (tools / "python3").unlink()
    sentence = complaint(toolchain(tools))
    assert "python3 was not found" in sentence
    assert f"Python {PYTHON_NEEDED}" in sentence


def test_python_without_venv_is_named(tools: Path) -> None:
    program(tools, "python3", f'case $2 in *venv*) exit 1 ;; esac; echo "{PYTHON_NEEDED}.0"')
    sentence = complaint(toolchain(tools))
    assert "no venv or no pip" in sentence
    assert "python3-venv" in sentence


def test_the_python_that_is_asked_for_is_the_only_one_tried(tools: Path) -> None:
    program(tools, "mypython", "echo 3.8.0")
    assert "mypython is version 3.8.0" in complaint(toolchain(tools, "python", PYTHON="mypython"))
    assert "nopython was not found" in complaint(toolchain(tools, "python", PYTHON="nopython"))


def test_citation_is_complete_and_has_the_version_of_the_package() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["cff-version"] == "1.2.0"
    assert citation["title"] == PROJECT["name"]
    assert citation["license"] == PROJECT["license"] == RUST["license"]
    assert {"message", "authors", "type"} <= citation.keys()
    assert all({"type", "title", "authors"} <= reference.keys() for reference in citation["references"])
    assert citation["version"] == RUST["version"]


def test_version_of_the_installed_package_is_that_of_the_workspace() -> None:
    assert "version" in PROJECT["dynamic"]  # so pyproject.toml cannot disagree with Cargo.toml
    assert importlib.metadata.version(PROJECT["name"]) == RUST["version"]
    assert f"## [{RUST['version']}]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["README.md", "docs/sweeps.md"])
def test_code_of_a_page_runs(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All ```python blocks in their order, in one namespace, as a reader would type them."""
    readme = ROOT / name
    import matplotlib.pyplot as plt

    text = readme.read_text(encoding="utf-8")
    blocks = list(re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL))
    assert blocks, f"{name} has no ```python block"
    plt.switch_backend("Agg")
    monkeypatch.chdir(tmp_path)
    namespace: dict[str, object] = {"__name__": "readme"}
    try:
        for block in blocks:
            above = "\n" * text.count("\n", 0, block.start(1))  # so that a traceback gives the page's line
            exec(compile(above + block[1], str(readme), "exec"), namespace)
    finally:
        plt.close("all")


def repository_files() -> list[Path]:
    """Every file of the source tree, without what was built, installed or written by runs."""
    skipped = {".git", ".venv", "target", "out", "dist", "__pycache__"}
    found = []
    for folder, below, names in os.walk(ROOT):
        below[:] = [name for name in below if name not in skipped and not name.endswith("_cache")]
        found += [Path(folder, name) for name in names]
    return found


def test_no_file_names_a_package_registry_host() -> None:
    """Lock and build must work behind any mirror; only Cargo.lock names its source, as Cargo writes it."""
    hosts = [".".join(parts) for parts in [("pypi", "org"), ("pythonhosted", "org"), ("crates", "io")]]
    named = []
    for path in repository_files():
        if path.name == "Cargo.lock":
            continue
        content = path.read_bytes()
        if b"\0" not in content:
            named += [f"{path.relative_to(ROOT)}: {host}" for host in hosts if host.encode() in content]
    assert named == []
