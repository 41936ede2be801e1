"""The same config gives the same bits under other BLAS kernels, threads, compilers and SIMD.

The C library is the one thing that is the same in all of these; see docs/reproducibility.md.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rotctl.config.loading import composed
from rotctl.log import collect
from rotctl.native import library
from rotctl.results import experiments

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))
import hatch_build  # noqa: E402

pytestmark = [
    pytest.mark.exact,
    pytest.mark.skipif(
        library() is None,
        reason="the compiled library is not built here (no C compiler at installation)",
    ),
    pytest.mark.skipif(
        "avx2" not in collect()["machine"]["features"].split(),
        reason="no AVX2 on this processor: rotctl promises nothing of its bits",
    ),
]
WORKER = Path(__file__).with_name("bits_of_runs.py")
KERNELS = {"Haswell": "avx2", "SkylakeX": "avx512f", "Prescott": ""}  # and what each needs
FEATURES = collect()["machine"]["features"].split()
SIMD = " ".join(np.show_config(mode="dicts")["SIMD Extensions"]["found"])  # beyond numpy's baseline
# Other levels, other instructions; the last one is what must *not* be done.
COMPILERS = {
    "gcc at -O1": ["gcc", *hatch_build.FLAGS, "-O1"],
    "gcc for AVX2": ["gcc", *hatch_build.FLAGS, "-march=x86-64-v3"],
    "gcc for AVX512": ["gcc", *hatch_build.FLAGS, "-march=x86-64-v4"],
    "clang": ["clang", *hatch_build.FLAGS],
    "clang for AVX2": ["clang", *hatch_build.FLAGS, "-march=x86-64-v3"],
    "reordered": ["gcc", *hatch_build.FLAGS, "-fassociative-math", "-fno-signed-zeros"],
}


@pytest.fixture(scope="module")
def configs():
    """The ten rows of Table 1, and the other code paths: lockstep, the numpy reference."""
    rows = [overrides[0] for overrides in experiments.experiment("table1").matrix]
    assert len(rows) == 10
    others = [
        "physics=lockstep behaviour=incline",
        "physics=lockstep behaviour=sideways_roll",
        "controller.backend=reference behaviour=uneven_terrain",
    ]
    return {name: composed(name.split()) for name in [*rows, *others]}


@pytest.fixture(scope="module")
def expected(configs):
    """What this process's own environment gives, by duration."""
    found = {}

    def of(duration):
        if duration not in found:
            found[duration] = runs(configs, duration, "Haswell", 1)
        return found[duration]

    return of


def runs(configs, duration, kernel, threads, native="", simd=""):
    """Name of a config -> digest of its run and the fallbacks it took, in another process."""
    environment = {
        "OPENBLAS_CORETYPE": kernel,
        **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), str(threads)),
        **({"NPY_DISABLE_CPU_FEATURES": simd} if simd else {}),
    }
    order = {"configs": configs, "duration": duration, "library": str(native)}
    done = subprocess.run(
        [sys.executable, "-W", "error", str(WORKER)],
        input=json.dumps(order),
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    told = {"Prescott": "Katmai"}.get(kernel, kernel)  # an older name of the same code
    assert answer["blas"].split()[-1] == told or "openblas" not in answer["blas"]
    return answer["runs"]


def built(folder, name):
    """The C library, by that compiler."""
    compiler, *flags = COMPILERS[name]
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler} here: what it builds was not tried")
    source, library = ROOT / hatch_build.SOURCE, folder / "_native.so"
    given = [
        f'-DROTCTL_SOURCE="{hatch_build._source_hash(source.parent)}"',
        f"-I{hatch_build._mujoco_headers()}",
    ]
    command = [compiler, *flags, *given, source, "-o", library, "-lm"]
    subprocess.run(command, check=True, capture_output=True)
    return library


def can_take(kernel):
    if KERNELS[kernel] not in ["", *FEATURES]:
        pytest.skip(f"no {KERNELS[kernel]} on this processor: BLAS's {kernel} was not tried")
    return kernel


def test_a_moment_of_all_where_everything_is_different(configs, expected, tmp_path):
    kernel = "SkylakeX" if KERNELS["SkylakeX"] in FEATURES else "Prescott"
    found = runs(configs, 1.5, kernel, 2, built(tmp_path, "gcc for AVX2"), SIMD)
    assert found == expected(1.5)


@pytest.mark.parametrize("compiler", ["gcc for AVX512", "clang for AVX2"])
def test_no_compiler_fuses_what_is_rounded_twice(compiler, tmp_path):
    if shutil.which("objdump") is None:
        pytest.skip("no objdump here: what the compiler built was not read")
    library = built(tmp_path, compiler)
    listing = subprocess.run(["objdump", "-d", library], capture_output=True, text=True, check=True)
    assert "mulpd" in listing.stdout
    assert [line for line in listing.stdout.splitlines() if "vfm" in line or "vfnm" in line] == []


def test_a_compiler_that_may_reorder_sums_would_be_seen(configs, tmp_path):
    names = ("behaviour=incline", "physics=lockstep behaviour=incline")
    some = {name: configs[name] for name in names}
    digests = (
        runs(some, 0.5, "Haswell", 1),
        runs(some, 0.5, "Haswell", 1, built(tmp_path, "reordered")),
    )
    assert all(digests[0][name] != digests[1][name] for name in names)


@pytest.mark.slow
@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("compiler", [name for name in COMPILERS if name != "reordered"])
def test_all_for_twelve_seconds(compiler, threads, kernel, configs, expected, tmp_path):
    simd = "" if threads == 1 else SIMD
    found = runs(configs, 12.0, can_take(kernel), threads, built(tmp_path, compiler), simd)
    assert found == expected(12.0)
