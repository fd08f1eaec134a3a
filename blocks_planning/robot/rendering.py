"""Pictures of the scene, rendered without a screen by EGL or OSMesa."""

from __future__ import annotations

import atexit
import os
from importlib import import_module
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from blocks_planning.errors import ConfigurationError
from blocks_planning.extras import extra
from blocks_planning.robot.scene import FILM_CAMERA, FILM_LIGHT
from blocks_planning.robot.simulation import Simulation

with extra('robot'):
    import mujoco

Pixels: TypeAlias = NDArray[np.uint8]
"""Height x width x 3, top row first."""
BACKENDS = ('egl', 'osmesa')
MAX_GEOMS = 400


def _new_context(width: int, height: int) -> Any:
    """A rendering context; MUJOCO_GL restricts the choice to one backend.

    Raises:
        ConfigurationError: with the reason for each backend that was tried.
    """
    wanted = os.environ.get('MUJOCO_GL', '').lower()
    reasons = []
    for name in (wanted,) if wanted in BACKENDS else BACKENDS:
        context, reason = _try(name, width, height)
        if context is not None:
            return context
        reasons.append(f'{name}: {reason}')
    raise ConfigurationError(
        'this machine cannot render pictures; use perception poses, or install libegl1 and '
        f'libegl-mesa0 ({"; ".join(reasons)})'
    )


def _try(name: str, width: int, height: int) -> tuple[Any, str]:
    """A context of a backend, or None and the reason."""
    try:
        context = import_module(f'mujoco.{name}').GLContext(width, height)
        context.make_current()
    except Exception as error:  # noqa: BLE001  a missing library can raise any exception
        return None, f'{type(error).__name__}: {" ".join(str(error).split())}'
    return context, ''


class Painter:
    """Renders a simulation; usable only by the thread that created it.

    Raises:
        ConfigurationError: if this machine cannot render.
    """

    def __init__(self, simulation: Simulation) -> None:
        """Create the rendering context."""
        self._simulation = simulation
        visual = simulation.model.vis.global_
        self._gl: Any = _new_context(visual.offwidth, visual.offheight)
        self._context: Any = mujoco.MjrContext(
            simulation.model, mujoco.mjtFontScale.mjFONTSCALE_100.value
        )
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._options = mujoco.MjvOption()
        self._model: Any = None
        self._scene: Any = None
        # Close at exit, before Python removes what the context needs.
        atexit.register(self.close)

    def paint(self, camera: str, width: int, height: int) -> Pixels:
        """A picture by a camera of the scene, ``width`` x ``height`` [pixels].

        The film camera switches on its light; the others show plain colours.
        """
        model, data = self._simulation.model, self._simulation.data
        is_film = camera == FILM_CAMERA
        model.light_active[model.light(FILM_LIGHT).id] = is_film
        model.vis.headlight.ambient[:] = 0.55 if is_film else 1.0
        self._simulation.refresh()
        self._gl.make_current()
        if self._model is not model:
            self._model, self._scene = model, mujoco.MjvScene(model, maxgeom=MAX_GEOMS)
        view = mujoco.MjvCamera()
        view.type = mujoco.mjtCamera.mjCAMERA_FIXED
        view.fixedcamid = model.camera(camera).id
        mujoco.mjv_updateScene(
            model,
            data,
            self._options,
            None,
            view,
            mujoco.mjtCatBit.mjCAT_ALL.value,
            self._scene,
        )
        frame = mujoco.MjrRect(0, 0, width, height)
        pixels = np.empty((height, width, 3), np.uint8)
        mujoco.mjr_render(frame, self._scene, self._context)
        mujoco.mjr_readPixels(pixels, None, frame, self._context)
        return pixels[::-1]

    def close(self) -> None:
        """Release the context; the painter cannot be used afterwards."""
        if self._gl is not None:
            self._gl.make_current()
            self._context.free()
            self._gl.free()
            self._gl = self._context = self._scene = None
            atexit.unregister(self.close)


def why_blind(simulation: Simulation) -> str:
    """The reason why this machine cannot render; '' if it can."""
    try:
        Painter(simulation).close()
    except ConfigurationError as error:
        return str(error)
    return ''
