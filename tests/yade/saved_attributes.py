# SPDX-License-Identifier: GPL-2.0-or-later
"""What a saved scene holds of the plugin's objects, those attributes included that Python does not show."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from yade import wrapper

from test_classes import CLASSES

Attributes = dict[str, str]


def of_file(path: Path) -> list[Attributes]:
    """Of every object of the plugin in a scene saved as .xml, in the order of the file: its attributes, as "Class.attribute" with the class that has it."""
    names: dict[str, str] = {}
    found = []
    for element in ElementTree.parse(path).iter():
        number = element.get("class_id", element.get("class_id_reference", ""))
        # The name of a class is written with its first object; of one first met inside of a derived class, the element is called by it.
        if full_name := element.get("class_name"):
            names[number] = full_name.removeprefix("yade::")
        elif element.tag in CLASSES:
            names[number] = element.tag
        if element.tag == "px" and names.get(number) in CLASSES and "object_id" in element.attrib:
            found.append(_attributes(names[number], element))
    return found


def _attributes(name: str, element: ElementTree.Element) -> Attributes:
    """Those of the classes it is derived from stand in elements of their names, before its own."""
    attributes: Attributes = {}
    for child in element:
        if isinstance(getattr(wrapper, child.tag, None), type):
            attributes |= _attributes(child.tag, child)
        else:
            attributes[f"{name}.{child.tag}"] = " ".join(" ".join(child.itertext()).split())
    return attributes
