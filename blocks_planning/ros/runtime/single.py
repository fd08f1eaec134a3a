"""One node per name: a second one would receive the same messages and repeat the same work.

The claim is an abstract socket, which Linux closes when the process ends for any reason. It
applies to the processes of one machine.
"""

from __future__ import annotations

import hashlib
import socket
import sys
import time

from blocks_planning.errors import LimitExceeded

CLAIM_WAIT_S = 3.0
"""Grace period after a stop request [s]."""
_LOOK_S = 0.05


def claim_name(domain: int, name: str, wait_s: float = CLAIM_WAIT_S) -> socket.socket | None:
    """Claim a node's name for as long as the socket is open.

    Args:
        domain: the ROS domain.
        name: fully qualified.
        wait_s: how long to wait for another process that holds it [s].

    Returns:
        the claim; None on systems other than Linux

    Raises:
        LimitExceeded: if another process still has it.
    """
    if sys.platform != 'linux':
        return None
    digest = hashlib.sha256(f'{domain} {name}'.encode()).hexdigest()[:32]
    claim = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    deadline = time.monotonic() + wait_s
    while not _is_bound(claim, f'\0blocks_planning/{digest}'):
        if time.monotonic() >= deadline:
            claim.close()
            raise LimitExceeded(
                f'node {name} is already running in ROS domain {domain} on this machine: end it, or '
                'choose another namespace'
            )
        time.sleep(_LOOK_S)
    return claim


def _is_bound(claim: socket.socket, address: str) -> bool:
    try:
        claim.bind(address)
    except OSError:
        return False
    return True
