"""The cells of docs/notebook.ipynb, run in order; as a program it writes what they give into it."""

import ast
import base64
import contextlib
import io
import json
import os
import sys
import tempfile
from pathlib import Path

NOTEBOOK = Path(__file__).parent.parent / "docs" / "notebook.ipynb"


def stored():
    """The notebook as plain data."""
    return json.loads(NOTEBOOK.read_text(encoding="utf-8"))


def code(notebook):
    """Its cells of code."""
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


def printed(cell):
    """What is stored of a cell's words."""
    return "".join("".join(o["text"]) for o in cell["outputs"] if o["output_type"] == "stream")


def run(cell, space):
    """Run a cell; what it prints, and the value of its last line if that is an expression."""
    tree = ast.parse("".join(cell["source"]))
    *_, last = tree.body
    value = ast.Expression(tree.body.pop().value) if isinstance(last, ast.Expr) else None
    with contextlib.redirect_stdout(io.StringIO()) as said:
        exec(compile(tree, "notebook", "exec"), space)
        shown = eval(compile(value, "notebook", "eval"), space) if value else None
    return said.getvalue(), shown


def _outputs(said, shown):
    found = []
    if said:
        found.append({"name": "stdout", "output_type": "stream", "text": said.splitlines(True)})
    if hasattr(shown, "savefig"):
        picture = io.BytesIO()
        shown.savefig(picture, format="png", dpi=80, metadata={"Software": None})
        data = {"image/png": base64.b64encode(picture.getvalue()).decode()}
        found.append({"data": data, "metadata": {}, "output_type": "display_data"})
    return found


def renew():
    """Write what the cells give into the notebook."""
    notebook, space = stored(), {}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for number, cell in enumerate(code(notebook), start=1):
            cell["outputs"], cell["execution_count"] = _outputs(*run(cell, space)), number
    NOTEBOOK.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(renew())
