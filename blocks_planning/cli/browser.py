"""Opens a page of this machine in a browser."""

from __future__ import annotations

import socket
import threading
import time
import webbrowser

_SERVED_WITHIN_S = 60.0
_LOOK_PERIOD_S = 0.2


def open_when_served(url: str, place: tuple[str, int]) -> None:
    """Open a page in a browser as soon as its server accepts connections."""

    def wait() -> None:
        end = time.monotonic() + _SERVED_WITHIN_S
        while time.monotonic() < end:
            if _is_served(place):
                webbrowser.open(url)
                return
            time.sleep(_LOOK_PERIOD_S)

    threading.Thread(target=wait, name='browser', daemon=True).start()


def _is_served(place: tuple[str, int]) -> bool:
    try:
        socket.create_connection(place, timeout=1.0).close()
    except OSError:
        return False
    return True
