"""The ROS 2 graph: each part of a trial as a node, and the middleware nowhere else."""
