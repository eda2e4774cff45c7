# SPDX-License-Identifier: GPL-2.0-or-later
"""Write the class reference from the docstrings of the running classes: ``yade -n -x doc/class_reference.py doc/classes.rst``.

The docstrings live once, beside the C++ attributes and the Python functions; this script only turns YADE's roles into Sphinx's.
"""

import importlib
import inspect
import pkgutil
import re
import sys
import textwrap

import contactdynamics
import yade.wrapper

READ_ONLY = 2  # bit of YADE's attribute flags
HIDDEN = 8
OWN = sorted(name for name in dir(contactdynamics) if inspect.isclass(getattr(contactdynamics, name)) and hasattr(yade.wrapper, name))
YADE_PAGE = "https://yade-dem.org/doc/yade.wrapper.html#yade.wrapper."


def link(match):
    """YADE's role yref: to an entry of this page for our classes, to YADE's manual for its own."""
    text, target = re.fullmatch(r"(?:(.*?)<)?([^<>]*)>?", match.group(1), re.DOTALL).groups()
    target = target.strip().replace("::", ".")
    text = (text or target).strip()
    return f":py:obj:`{text} <{target}>`" if target.split(".")[0] in OWN else f"`{text} <{YADE_PAGE}{target}>`__"


def toSphinx(docstring):
    """Docstring with YADE's roles resolved, and what YADE appended to it: default, type and flags (empty where absent)."""
    facts = {}
    for role in ("ydefault", "yattrtype", "yattrflags"):
        found = re.search(rf":{role}:`(.*?)`", docstring, re.DOTALL)
        facts[role] = found.group(1).strip() if found else ""
        docstring = re.sub(rf":{role}:`.*?`", "", docstring, flags=re.DOTALL)
    docstring = docstring.replace("|", r"\|")  # the norm of a vector, not a substitution of Sphinx
    return re.sub(r":yref:`(.*?)`", link, inspect.cleandoc(docstring), flags=re.DOTALL).strip(), facts


def entry(directive, text, options=()):
    """One reST directive with an indented body."""
    head = "\n".join([f".. {directive}", *[f"   {option}" for option in options]])
    return f"{head}\n\n{textwrap.indent(text, '   ')}\n"


def ofClass(name):
    """A YADE class of ours with its own attributes and methods; inherited ones are in YADE's manual."""
    cls = getattr(contactdynamics, name)
    base = cls.__mro__[1].__name__
    parts = [toSphinx(cls.__doc__ or "")[0], f"*Derived from* {link(re.match('(.*)', base))}."]
    for attribute, member in cls.__dict__.items():
        if attribute.startswith("_"):
            continue
        text, facts = toSphinx(member.__doc__ or "")
        flags = int(facts["yattrflags"] or 0)
        if flags & HIDDEN:
            continue
        if isinstance(member, property):
            options = [f":type: {facts['yattrtype']}", f":value: {facts['ydefault']}"] if facts["yattrtype"] else []
            parts.append(entry(f"py:attribute:: {name}.{attribute}", text + (" *(read-only)*" if flags & READ_ONLY else ""), options))
        else:
            # boost::python puts its own signature on the first line of a method's docstring.
            parts.append(entry(f"py:method:: {name}.{attribute}()", inspect.cleandoc(text.split(":\n", 1)[-1])))
    return entry(f"py:class:: {name}", "\n\n".join(parts))


def ofPython(module, member):
    """A Python function or class with its signature and docstring."""
    kind = "class" if inspect.isclass(member) else "function"
    return entry(f"py:{kind}:: {module}.{member.__name__}{inspect.signature(member, eval_str=True)}", inspect.cleandoc(member.__doc__))


def publicMembers(module):
    """Functions and classes that the module itself defines, in the order of the file."""
    found = [member for name, member in inspect.getmembers(module, lambda member: inspect.isfunction(member) or inspect.isclass(member))
             if member.__module__ == module.__name__ and not name.startswith("_")]
    return sorted(found, key=lambda member: inspect.getsourcelines(member)[1])


def publicModules():
    """Modules of the package that a user imports, in the order of their names."""
    names = [module.name for module in pkgutil.iter_modules(contactdynamics.__path__) if not module.name.startswith("_")]
    return [importlib.import_module(f"contactdynamics.{name}") for name in sorted(names)]


def groupOf(name):
    """Heading under which a YADE class of ours stands."""
    if name.endswith(("Engine", "Controller", "Stepper")):
        return "Engines"
    return "Bounds and geometry of contacts" if name.startswith(("Bo1", "Ig2")) or name.endswith("Geom") else "Physics and law of a contact"


def title(text, line):
    return f"{text}\n{line * len(text)}\n"


def main(path):
    if not OWN:
        sys.exit("the package contactdynamics shows no class of yade.wrapper, so there is nothing to document")
    groups = {"Engines": [], "Physics and law of a contact": [], "Bounds and geometry of contacts": []}
    for name in OWN:
        groups[groupOf(name)].append(ofClass(name))
    parts = [title("Class reference", "="), "Written by ``scripts/docs`` from the docstrings of the running classes.\n"]
    parts += [title("Presets", "-"), ofPython("contactdynamics", contactdynamics.engines)]
    for heading, entries in groups.items():
        parts += [title(heading, "-"), *entries]
    for module in publicModules():
        parts += [title(module.__name__, "-"), inspect.cleandoc(module.__doc__) + "\n", *[ofPython(module.__name__, member) for member in publicMembers(module)]]
    with open(path, "w") as file:
        file.write("\n".join(parts))
    print(f"{len(OWN)} classes written to {path}")


main(sys.argv[1])
