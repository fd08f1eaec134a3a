"""Installed definitions of messages: text with comments, and hash."""

from __future__ import annotations

import json
import re
from pathlib import Path

from ament_index_python.packages import get_package_share_directory

_PLAIN = re.compile(r'bool|byte|char|w?string|u?int(8|16|32|64)|float(32|64)')
_FIELD = re.compile(r'^[ \t]*(?P<type>[A-Za-z][\w/]*)\S*[ \t]+[A-Za-z]', re.MULTILINE)
_RULER = '=' * 80


def definition_of(ros_type: str) -> str:
    """The definition of a message such as ``std_msgs/msg/Header``, and of all messages in it."""
    texts = {ros_type: _installed(ros_type, 'msg')}
    pending = [ros_type]
    while pending:
        outer = pending.pop(0)
        for inner in _parts(outer, texts[outer]):
            if inner not in texts:
                texts[inner] = _installed(inner, 'msg')
                pending.append(inner)
    own = texts.pop(ros_type)
    inner_texts = (
        f'{_RULER}\nMSG: {name.replace("/msg/", "/")}\n{text}' for name, text in texts.items()
    )
    return '\n'.join([own, *inner_texts])


def type_hash_of(ros_type: str) -> str:
    """The hash that nodes with the same definition announce."""
    entries = json.loads(_installed(ros_type, 'json'))['type_hashes']
    hashes: dict[str, str] = {entry['type_name']: entry['hash_string'] for entry in entries}
    return hashes[ros_type]


def _installed(ros_type: str, suffix: str) -> str:
    package, _, name = ros_type.split('/')
    path = Path(get_package_share_directory(package), 'msg', f'{name}.{suffix}')
    return path.read_text(encoding='utf-8')


def _parts(ros_type: str, text: str) -> list[str]:
    """The types of the fields of a message."""
    package = ros_type.split('/', maxsplit=1)[0]
    names = [found['type'] for found in _FIELD.finditer(text)]
    return [
        name.replace('/', '/msg/') if '/' in name else f'{package}/msg/{name}'
        for name in names
        if not _PLAIN.fullmatch(name)
    ]
