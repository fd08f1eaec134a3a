"""Optional dependencies: an error of a failed import names the extra to install.

The planning core and the nodes need few packages. Packages that only experiments, figures, the page
or the robot need are extras of ``setup.py``, and are imported inside :func:`extra`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from blocks_planning.errors import ConfigurationError

EXTRAS = ('experiments', 'figures', 'page', 'robot')
"""As in ``extras_require`` of ``setup.py``; the extra ``all`` contains these except
``robot``, which is large and only needed for the simulated robot."""

_TARGETS = {'robot': 'make robot-setup'}
"""Targets of make that install an extra that ``make setup`` leaves out."""


class MissingExtra(ConfigurationError):
    """A package that an optional part of this one needs is not installed."""


@contextmanager
def extra(name: str) -> Iterator[None]:
    """Import packages of one extra in the body of a ``with`` statement.

    Args:
        name: one of :data:`EXTRAS`.

    Raises:
        MissingExtra: if a module is not found; the message names it, the extra, and the command
            that installs the extra.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        module = str(error.name).partition('.')[0]
        raise MissingExtra(
            f'the module {module} is not installed; it comes with the extra {name!r} of this '
            f"package: pip install 'blocks_planning[{name}]' "
            f'(in a checkout: {_TARGETS.get(name, "make setup")})'
        ) from error
