"""`make fuzz`: give many inputs, and say what they found; exit 1 if that is anything."""

import argparse
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))  # the tests' own modules

from tqdm import tqdm

from fuzz import kinds, samples
from fuzz.giving import given, import_all


def main():
    """Parse the command line and do it."""
    parser = argparse.ArgumentParser(prog="fuzz", description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--first", type=int, default=0, help="number to begin with")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", metavar="SEED:NUMBER", help="one input; its folder is kept")
    arguments = parser.parse_args()
    os.environ["CANARY"] = "canary"
    os.environ.setdefault("MUJOCO_GL", "osmesa")
    base = Path(tempfile.mkdtemp(prefix="fuzz-"))
    for name in ("TMPDIR", "MPLCONFIGDIR", "HOME"):
        os.environ[name] = str(base / name)
        (base / name).mkdir()
    tempfile.tempdir = None  # which has been asked for already
    made = samples.make(base)
    import_all()
    if arguments.only:
        seed, number = map(int, arguments.only.split(":"))
        found, case = given(made, seed, number, base / "only", kinds.KINDS)
        print(case, found.code, f"{found.cpu:.1f} s, {found.memory / 1e6:.0f} MB")
        print(found.fault, found.details, base / "only", sep="\n")
        return bool(found.fault)
    try:
        return _many(arguments, made, base / "case")
    finally:
        shutil.rmtree(base, ignore_errors=True)


def _many(arguments, made, folder):
    begin, faults, codes, most_cpu, most_memory = time.monotonic(), 0, {}, 0.0, 0
    tqdm.monitor_interval = 0  # no thread beside those who fork
    numbers = range(arguments.first, arguments.first + arguments.count)
    for number in tqdm(numbers, unit="input", disable=None):
        found, case = given(made, arguments.seed, number, folder, kinds.KINDS)
        shutil.rmtree(folder, ignore_errors=True)
        most_cpu, most_memory = max(most_cpu, found.cpu), max(most_memory, found.memory)
        codes[found.code] = codes.get(found.code, 0) + 1
        if found.fault:
            faults += 1
            words = [word if len(word) < 120 else f"{word[:117]}..." for word in case.argv]
            said = [" ".join(words), *found.details.strip().splitlines()[-6:]]
            tqdm.write("\n  ".join([f"{arguments.seed}:{number}: {found.fault}", *said]))
    print(
        f"{arguments.count} inputs, seed {arguments.seed}: {faults} faults; exit codes "
        f"{dict(sorted(codes.items(), key=str))}; at most {most_cpu:.1f} s of CPU and "
        f"{most_memory / 1e6:.0f} MB; {time.monotonic() - begin:.0f} s"
    )
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
