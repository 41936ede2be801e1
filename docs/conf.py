"""How Sphinx makes the site of these pages, `make docs`."""

from rotctl import __version__

project = "rotctl"
author = "rotctl contributors"
release = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build"]
default_role = "code"  # of what docstrings have in single backticks
myst_heading_anchors = 4  # as on GitHub, so that links to headings work in both
suppress_warnings = ["myst.xref_missing"]  # links to code lead out of the site; a test checks them
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_default_options = {"members": True}
napoleon_use_ivar = True
html_theme = "alabaster"
html_theme_options = {
    "description": "Physics-based rotational character control",
    "page_width": "1100px",
    "font_family": "sans-serif",
}
html_copy_source = False
html_show_sphinx = False


def as_restructured(app, what, name, item, options, lines):
    """Docstrings as this project writes them: bars are magnitudes, a fence is an example."""
    inside = False
    for i, line in enumerate(lines):
        if line.strip() == "```python":
            lines[i], inside = ".. code-block:: python\n", True
        elif line.strip() == "```":
            lines[i], inside = "", False
        else:
            lines[i] = f"   {line}" if inside else line.replace("|", r"\|")
    lines[:] = "\n".join(lines).split("\n")


def without_aliases(app, what, name, item, skip, options):
    """The members of a named tuple stand in its own description."""
    alias = str(getattr(item, "__doc__", "")).startswith("Alias for field number")
    return True if alias else None


def setup(app):
    """Called by Sphinx."""
    app.connect("autodoc-process-docstring", as_restructured)
    app.connect("autodoc-skip-member", without_aliases)
