"""The notebook runs from its first cell to its last, and shows what everybody gets."""

import cells as notebook
import pytest
from test_readme import LIBM

from rotctl.log.provenance import libm
from rotctl.native import library


@pytest.mark.exact
def test_its_cells_run_and_print_what_is_stored(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    space, cells = {}, notebook.code(notebook.stored())
    for cell in cells:
        said, shown = notebook.run(cell, space)
        assert said or shown is not None
        if library() is not None and libm() == LIBM:
            assert said == notebook.printed(cell), "the notebook is old; make readme"
    calls = "".join("".join(cell["source"]) for cell in cells)
    for call in ("load", "simulate", "read", "sweep", "report"):
        assert f"api.{call}(" in calls


def test_it_is_a_notebook():
    stored = notebook.stored()
    assert (stored["nbformat"], stored["nbformat_minor"]) == (4, 5)
    ids = [cell["id"] for cell in stored["cells"]]
    assert len(set(ids)) == len(ids)
    for cell in stored["cells"]:
        wanted = {"cell_type", "id", "metadata", "source"}
        more = {"outputs", "execution_count"} if cell["cell_type"] == "code" else set()
        assert set(cell) == wanted | more
