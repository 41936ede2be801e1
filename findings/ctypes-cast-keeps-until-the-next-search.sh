#!/usr/bin/env bash
# Cast a ctypes array to a pointer, look once, let go of both: the memory stays until the next search for garbage.
#
# Expected: a cast pointer keeps what it points to alive, and both go with the last name for the pointer, as those of
#   ctypes.pointer do; CPython counts references.
# Happens: cast notes what it was given in a dictionary that both objects share, and there stands the array among what the
#   array itself keeps: a circle. Only the cyclic collector ends it, which counts objects and not bytes: 100 arrays of 4 MB,
#   one at a time, hold 400 MB. A callback that is cast to its address keeps all that it closes over in the same way.
#   ctypes.pointer, addressof and c_void_p.from_buffer leave no circle.
# Seen with: CPython 3.11 and its ctypes; numpy's own data_as is not caught in it.
# Means: a worker that hands MuJoCo a callback a run grows by a simulation a run. Take the address by addressof or
#   c_void_p.from_buffer, or call gc.collect.
set -euo pipefail
python3 - <<'PY'
import ctypes
import gc
import sys
import weakref

gc.disable()
DOUBLES = 500_000  # 4 MB


class Held:
    """Something that an array or a callback drags along."""


def cast_array(held):
    array = (ctypes.c_double * DOUBLES)()
    array.held = held
    return ctypes.cast(array, ctypes.POINTER(ctypes.c_double))[0]


def cast_callback(held):
    callback = ctypes.CFUNCTYPE(None)(lambda: held)
    return ctypes.cast(callback, ctypes.c_void_p).value


def pointer(held):
    array = (ctypes.c_double * DOUBLES)()
    array.held = held
    return ctypes.pointer(array)[0][0]


def address_of_array(held):
    array = (ctypes.c_double * DOUBLES)()
    array.held = held
    return ctypes.addressof(array)


def address_of_callback(held):
    callback = ctypes.CFUNCTYPE(None)(lambda: held)
    return ctypes.c_void_p.from_buffer(callback).value


def stays(make):
    held = Held()
    there = weakref.ref(held)
    make(held)
    del held
    before = there() is not None
    gc.collect()
    return before, there() is not None


print("Python", sys.version.split()[0], "- stays when nobody has a name for it, and after gc.collect()")
found = {make.__name__: stays(make) for make in (cast_array, cast_callback, pointer, address_of_array, address_of_callback)}
for name, (before, after) in found.items():
    print(f"{name:20} {before!s:5} {after}")
arrays = []
for _ in range(100):
    held = Held()
    arrays.append(weakref.ref(held))
    cast_array(held)
    del held
alive = sum(each() is not None for each in arrays)
print("of 100 arrays of 4 MB, cast one after the other,", alive, "are still there")
circles = {name for name, (before, after) in found.items() if before and not after}
if circles != {"cast_array", "cast_callback"} or alive != 100:
    raise SystemExit("CHANGED: a cast lets go of what it was given")
PY
