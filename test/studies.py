"""A study that is served in this process."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from blocks_planning.study.desk import Desk
from blocks_planning.study.spec import read_study
from blocks_planning.view.study.server import StudyServer
from blocks_planning.view.web.guards import Address

TOKEN = 'an-experimenters-token'
STUDY = """\
title: Small towers
consent: |
  ## May we?
  <b onclick="harmed=1">Everything</b> is *kept*.
instructions: [Look at the towers.]
conditions:
  - {{name: parts, mode: scoping, instructions: [Draw.]}}
  - {{name: hands, mode: building, time_limit_s: 3600}}
towers: ['{towers}']
library: 1x2,2x1,2x2,4x2
order: fixed
debrief: Thank you.
"""
ARCH = '####\n####\n#..#\n#..#\n'


class Served:
    """A server, and the desk behind it.

    Attributes:
        folder: where the study is kept.
    """

    def __init__(self, folder: Path, port: int = 0, limit_s: int = 3600, token: str = '') -> None:
        towers, path = folder / 'arch.txt', folder / 'study.yaml'
        towers.write_text(ARCH)
        path.write_text(STUDY.format(towers=towers).replace('3600', str(limit_s)))
        self.folder = folder / 'out'
        self.desk = Desk(read_study(path), self.folder)
        host = '0.0.0.0' if token else '127.0.0.1'
        self.server = StudyServer(Address(host, port, token), self.desk, TOKEN)
        self.server.start()
        self.base = f'http://127.0.0.1:{self.server.address.port}'

    @property
    def participant(self) -> str:
        """Address of the participant's page."""
        return self.server.address.url

    @property
    def experimenter(self) -> str:
        """Address of the experimenter's page, with its token."""
        return self.server.experimenter.url

    def crash(self) -> None:
        """End without a word, as a process does that is killed."""
        if self.desk.session is not None:
            self.desk.session.release()
            self.desk.session = None
        self.desk.folder.close()
        self.server.stop()


@contextmanager
def served(folder: Path, **options: Any) -> Iterator[Served]:
    """A server that ends with the block."""
    made = Served(folder, **options)
    yield made
    made.server.stop()
