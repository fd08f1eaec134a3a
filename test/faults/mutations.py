"""Files that somebody has spoilt, from a seeded generator."""

from __future__ import annotations

import random
from collections.abc import Callable

_TOKENS = [
    b'\x00',
    b'\xff\xfe',
    b'\xc3',
    b'\xef\xbb\xbf',
    b'\r',
    b'\n\n',
    b'\t',
    b'#',
    b'.',
    b'{',
    b'}',
    b'[',
    b']',
    b'- ',
    b': ',
    b'"',
    b"'",
    b'0',
    b'-1',
    b'1e999',
    b'.nan',
    b'NaN',
    b'Infinity',
    b'9' * 30,
    b'9' * 5000,
    b'0x' + b'f' * 5000,
    b'18446744073709551616',
    b'null',
    b'true',
    b'y',
    b'2020-13-45',
    b'!!python/object/apply:os.system [x]',
    b'!!bool x',
    b'!!int ""',
    b'!!timestamp x',
    b'!!binary x',
    b'&a [*a]',
    b'*b',
    b'"\\uD800"',
    b'"\\0"',
    b'../../../etc/passwd',
    b'? [a, b]\n: c\n',
    b'<<: {a: b}\n',
    b'%YAML 9.9\n---\n',
    b'---\n',
    b'\xe2\x80\xa8',
    b'tower a\n',
]
_SLOW = [
    b'[' * 5000,
    b'{"a":' * 5000,
    b'x' * (1 << 20),
    b'- ' * 3000,
    b'\n'.join(
        [
            b'a0: &a0 [1, 1]',
            *(
                b'a%d: &a%d [%s]' % (n, n, b', '.join([b'*a%d' % (n - 1)] * 9))
                for n in range(1, 9)
            ),
        ]
    ),
]


def spoilt(chance: random.Random, data: bytes) -> bytes:
    """A file of which something is missing, changed, doubled or put in."""
    for _ in range(chance.choice((1, 1, 1, 2, 5))):
        data = chance.choice(_WAYS)(chance, data)
    return data


def _flipped(chance: random.Random, data: bytes) -> bytes:
    changed = bytearray(data)
    for _ in range(chance.choice((1, 3, 20)) if data else 0):
        changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _cut(chance: random.Random, data: bytes) -> bytes:
    start = chance.randrange(len(data) + 1)
    return data[:start] if chance.random() < 0.5 else data[:start] + data[start + 7 :]


def _lines(chance: random.Random, data: bytes) -> bytes:
    lines = data.split(b'\n')
    at, other = chance.randrange(len(lines)), chance.randrange(len(lines))
    kind = chance.randrange(4)
    if kind == 0:
        lines.insert(other, lines[at])
    elif kind == 1:
        del lines[at]
    elif kind == 2:
        lines[at], lines[other] = lines[other], lines[at]
    else:
        lines[at] = b'  ' * chance.randrange(4) + lines[at].strip()
    return b'\n'.join(lines)


def _put_in(chance: random.Random, data: bytes) -> bytes:
    token = chance.choice(_TOKENS if chance.random() < 0.98 else _SLOW)
    at = chance.randrange(len(data) + 1)
    return data[:at] + token + data[at + chance.choice((0, 1, len(token))) :]


def _value_put_in(chance: random.Random, data: bytes) -> bytes:
    """In the place of what stands behind a colon."""
    parts = data.split(b': ')
    if len(parts) < 2:
        return _put_in(chance, data)
    at = chance.randrange(1, len(parts))
    rest = parts[at].lstrip(b'0123456789abcdefghijklmnopqrstuvwxyz."\'')
    parts[at] = chance.choice(_TOKENS if chance.random() < 0.98 else _SLOW) + rest
    return b': '.join(parts)


def _random(chance: random.Random, data: bytes) -> bytes:
    return chance.randbytes(chance.randrange(300)) if chance.random() < 0.1 else data[::-1]


_WAYS: tuple[Callable[[random.Random, bytes], bytes], ...] = (
    _flipped,
    _cut,
    _lines,
    _put_in,
    _value_put_in,
    _value_put_in,
    _random,
)
