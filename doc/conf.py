# SPDX-License-Identifier: GPL-2.0-or-later
"""Configuration of the manual; built by scripts/docs, which first writes classes.rst from the running classes."""

project = "Contact Dynamics for YADE"
copyright = "the authors of Contact Dynamics for YADE, GPL-2.0-or-later"
extensions = ["sphinx.ext.mathjax"]
exclude_patterns = ["_build"]
highlight_language = "python"
html_theme = "alabaster"
html_theme_options = {"description": "Signorini and Coulomb in stock YADE", "page_width": "1050px", "fixed_sidebar": True}
# Class names are unique and stand without a module, as users write them.
add_module_names = False
