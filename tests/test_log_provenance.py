"""Provenance tells the code and the machine, never the user's own repository or name."""

import json
import os
import platform
import re
import subprocess
import sys

import pytest

import rotctl
from rotctl.log import collect, provenance

KERNELS = ("Haswell", "Nehalem")  # any processor with AVX2 can take them


def git(folder, *arguments):
    identity = ["-c", "user.name=t", "-c", "user.email=t@example.org"]
    subprocess.run(["git", "-C", folder, *identity, *arguments], check=True, capture_output=True)


@pytest.fixture
def package(tmp_path):
    """A committed package inside a repository."""
    folder = tmp_path / "rotctl"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    git(tmp_path, "init", "-q")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-q", "-m", "first")
    return folder


def test_collect_fits_the_log_s_attributes():
    found = collect()
    assert set(found) == {"versions", "git_commit", "git_dirty", "machine"}
    assert list(found["versions"]) == ["rotctl", "python", "mujoco", "numpy", "osqp", "h5py"]
    assert found["versions"]["rotctl"] == rotctl.__version__
    assert found["versions"]["python"] == platform.python_version()
    machine = found["machine"]
    assert list(machine) == ["platform", "cpu", "features", "cores", "libc", "libm", "blas"]
    assert machine["cores"] == os.cpu_count()
    assert re.fullmatch("[0-9a-f]{8}", machine["libm"])


def test_the_host_is_not_told():
    assert platform.node() not in collect()["machine"].values()
    assert f"-{platform.node()}-" not in collect()["machine"]["platform"]


def test_a_package_that_is_not_installed_is_said(monkeypatch):
    monkeypatch.setattr(provenance, "_PACKAGES", ("no-such-package",))
    assert collect()["versions"]["no-such-package"] == "not installed"


def test_a_clean_and_a_changed_tree(package):
    commit, dirty = provenance._source(package)
    assert len(commit) == 40
    assert not dirty
    (package.parent / "results.csv").write_text("not the package's business")
    assert provenance._source(package) == (commit, False)
    (package / "__init__.py").write_text("changed = True\n")
    assert provenance._source(package) == (commit, True)


def test_a_new_module_makes_the_tree_dirty(package):
    (package / "new.py").write_text("")
    assert provenance._source(package)[1] is True


def test_a_package_that_merely_lies_in_somebody_s_repository(package):
    inner = package.parent / "venv" / "rotctl"
    inner.mkdir(parents=True)
    (inner / "__init__.py").write_text("")
    assert provenance._source(inner) == ("unknown", False)


def test_the_working_directory_and_git_dir_do_not_matter(package, tmp_path_factory, monkeypatch):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / "__init__.py").write_text("")
    monkeypatch.chdir(package)
    monkeypatch.setenv("GIT_DIR", str(package.parent / ".git"))
    monkeypatch.setenv("GIT_WORK_TREE", str(elsewhere))
    assert provenance._source(elsewhere) == ("unknown", False)


def test_no_git(package, monkeypatch):
    monkeypatch.setenv("PATH", "")
    assert provenance._source(package) == ("unknown", False)


def test_the_cpu_has_a_name_even_without_proc(tmp_path):
    (tmp_path / "cpuinfo").write_text("processor\t: 0\nmodel name\t: Fast: 3000\n")
    assert provenance._cpu_model(tmp_path / "cpuinfo") == "Fast: 3000"
    assert provenance._cpu_model(tmp_path / "missing")


def test_the_features_that_arithmetic_hangs_on(tmp_path):
    (tmp_path / "x86").write_text("flags\t\t: fpu avx fma sse4_2 avx2 avx512f\nflags\t: fpu\n")
    (tmp_path / "arm").write_text("Features\t: fp asimd crc32\n")
    assert provenance._cpu_features(tmp_path / "x86") == "avx avx2 fma avx512f"
    assert provenance._cpu_features(tmp_path / "arm") == "asimd"
    assert provenance._cpu_features(tmp_path / "missing") == "unknown"


def other_process(**variables):
    """The machine as another process sees it that is started with these variables."""
    done = subprocess.run(
        [sys.executable, "-c", "import json, rotctl.log; print(json.dumps(rotctl.log.collect()))"],
        env={**os.environ, **variables},
        capture_output=True,
        check=True,
    )
    return json.loads(done.stdout)["machine"]


def test_a_c_library_that_rounds_another_way_has_another_name():
    here = collect()["machine"]
    if not here["libc"].startswith("glibc") or "fma" not in here["features"].split():
        pytest.skip(
            f"needs glibc on a processor with FMA, here: {here['libc']}, {here['features']}"
        )
    without = other_process(GLIBC_TUNABLES="glibc.cpu.hwcaps=-FMA,-AVX2_Usable,-FMA_Usable")
    assert without["libc"] == here["libc"]
    assert without["libm"] != here["libm"]
    assert other_process(GLIBC_TUNABLES="glibc.cpu.hwcaps=-AVX512F")["libm"] == here["libm"]


def test_the_blas_kernel_is_told():
    if "openblas" not in collect()["machine"]["blas"]:
        pytest.skip(f"numpy's BLAS is no OpenBLAS here: {collect()['machine']['blas']}")
    told = {kernel: other_process(OPENBLAS_CORETYPE=kernel)["blas"] for kernel in KERNELS}
    for kernel, blas in told.items():
        assert re.fullmatch(rf"scipy-openblas \d[\d.]+ {kernel}", blas)
