"""A simulated robot that builds the tower: scene, arm, behaviour and perception, without ROS.

::

    Robot          orders, time steps, cancelling, perception, saving: the only class a caller needs
      ├── behaviour    the sequence of phases, with time limits and reasons of failure
      ├── arm          set points of the axes and the gripper, with bounded speed
      ├── simulation   MuJoCo: blocks, time, glue
      │     └── scene  the model as MJCF
      └── perception   cells from poses or from a picture of the camera, noise, repair

Lengths are in metres, in the frame of the board: x along the columns to the right, z upwards, y
away from the viewer; the lower left front corner of cell (0, 0) is the origin. docs/robot.md lists
what is simulated and what is not.
"""
