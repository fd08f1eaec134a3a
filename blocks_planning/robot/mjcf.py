"""What every part of the MJCF model is written with."""

from __future__ import annotations

from xml.etree import ElementTree as Xml

NO_CONTACT = {'contype': '0', 'conaffinity': '0'}
"""Attributes of a geom that collides with nothing."""


def add(parent: Xml.Element, tag: str, **attributes: str) -> Xml.Element:
    """Append an element to `parent`; return it."""
    return Xml.SubElement(parent, tag, attributes)


def numbers(*values: float) -> str:
    """The text of a vector, with every digit."""
    return ' '.join(map(repr, values))
