"""A simulated robot that builds the tower: scene, arm, behaviour and perception, without ROS.

::

    Robot          orders, ticks, cancelling, what is seen, saving: the only name a caller needs
      ├── behaviour    what the arm does next: phases with bounds, and the reasons of failure
      ├── arm          set points of the axes and the gripper, with bounded speed
      ├── simulation   MuJoCo: blocks, time, glue
      │     └── scene  the model as MJCF
      └── perception   cells from poses or from a picture of the camera, noise, repair

Lengths are in metres, in the frame of the board: x along the columns to the right, z upwards, y
away from the viewer; the lower left front corner of cell (0, 0) is the origin. docs/robot.md says
what is simulated and what is not.
"""
