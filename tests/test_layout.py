"""Python reads layout.h as a C compiler does."""

import ctypes
import shutil
import subprocess
from pathlib import Path

import mujoco
import pytest

from rotctl.control.task import TASK
from rotctl.native.layout import HEADER, constant, structure

COMPILER = next(filter(shutil.which, ("cc", "gcc", "clang")), None)
NAMES = ("Task", "Constants", "Reading", "Command", "Answer", "Sums")


@pytest.mark.skipif(COMPILER is None, reason="there is no C compiler here")
def test_sizes_and_places_are_the_compiler_s(tmp_path):
    places = [f"{name}.{field[0]}" for name in NAMES for field in structure(name)._fields_]
    lines = [
        *(f'printf("%zu ", sizeof({name}));' for name in NAMES),
        *('printf("%zu ", offsetof({}, {}));'.format(*place.split(".")) for place in places),
    ]
    source = tmp_path / "sizes.c"
    source.write_text(
        f'#include <stddef.h>\n#include <stdio.h>\n#include "{HEADER}"\n'
        f"int main(void) {{ {' '.join(lines)} return 0; }}\n"
    )
    include = Path(mujoco.__file__).parent / "include"
    program = tmp_path / "sizes"
    subprocess.run([COMPILER, f"-I{include}", str(source), "-o", str(program)], check=True)
    said = subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout
    ours = [ctypes.sizeof(structure(name)) for name in NAMES]
    ours += [getattr(structure(p.split(".")[0]), p.split(".")[1]).offset for p in places]
    assert said.split() == [str(number) for number in ours]


def test_a_task_is_the_same_to_numpy():
    task = structure("Task")
    assert ctypes.sizeof(task) == TASK.itemsize
    assert [(n, getattr(task, n).offset) for n, *_ in task._fields_] == [
        (name, TASK.fields[name][1]) for name in TASK.names
    ]


def test_negative_numbers_are_read():
    assert constant("FAILED") == -1


def test_a_misspelt_member_is_an_error():
    with pytest.raises(AttributeError):
        structure("Command")().blendd = 1.0
